#include "orbweaver/refine/guess.hpp"

#include <numeric>
#include <utility>

#include <fmt/format.h>

#include "orbweaver/core/error.hpp"
#include "orbweaver/loop/curve/in_units.hpp"
#include "orbweaver/loop/symmetry/standard_phase.hpp"
#include "orbweaver/loop/symmetry/symmetry_group.hpp"

namespace orbweaver::refine {

loop::Isotropy in_standard_phase(const systems::Structure& structure, loop::Isotropy isotropy) {
  const loop::SymmetryGroup group(structure, isotropy);
  for (const systems::Symmetry& reversor : structure.reversors)
    for (const loop::SymmetryElement& element : group.elements()) {
      if (!element.reversing || element.name != reversor.name) continue;
      for (loop::SymmetryElement& generator : isotropy) {
        if (!generator.reversing) continue;
        const int q = std::lcm(generator.shift_denominator, element.shift_denominator);
        const int shift = generator.shift_numerator * (q / generator.shift_denominator) -
                          element.shift_numerator * (q / element.shift_denominator);
        const int positive = ((shift % q) + q) % q;
        const int common = std::gcd(positive, q);
        generator.shift_numerator = positive / common;
        generator.shift_denominator = q / common;
      }
      return isotropy;
    }
  return isotropy;
}

Guess guess_of(std::shared_ptr<const systems::System> plain, const systems::System& scaled, const loop::Loop& loop,
               const loop::Isotropy& isotropy) {
  const loop::Loop standard = loop::in_standard_phase(scaled.structure(), loop, isotropy);
  return {std::move(plain), scaled.scales(), loop::in_units(standard, scaled.scales()),
          in_standard_phase(scaled.structure(), isotropy)};
}

systems::Formulas refinable_formulas(const systems::System& system) {
  const auto* with_formulas = dynamic_cast<const systems::FormulaSystem*>(&system);
  const systems::Structure& structure = system.structure();
  if (with_formulas == nullptr)
    throw core::InputError(fmt::format("{} cannot be refined: it does not give its formulas", system.info().title));
  if (structure.conserved.size() > 1 || (structure.conservative() && !structure.symplectic))
    throw core::InputError(
        fmt::format("{} cannot be refined: of systems that conserve something only Hamiltonian ones with one conserved "
                    "quantity can",
                    system.info().title));
  if (structure.conservative() && structure.pairs() > 1)
    throw core::InputError(fmt::format("{} cannot be refined: its orbits have {} pairs of multipliers, more than one",
                                       system.info().title, structure.pairs()));
  if (const std::vector<std::string>& free = system.family_scalars().free; !free.empty())
    throw core::InputError(fmt::format(
        "orbits of families in {} cannot be refined, as each has a value of its own; survey the system with one value, "
        "and without `continuation.free`",
        free.front()));
  return with_formulas->formulas();
}

systems::Formulas conservative_formulas(const systems::System& system) {
  systems::Formulas formulas = refinable_formulas(system);
  if (!system.structure().conservative())
    throw core::InputError(fmt::format(
        "{} conserves nothing: of such systems only `orbweaver refine` takes orbits, by a parameter's value",
        system.info().title));
  return formulas;
}

}  // namespace orbweaver::refine
