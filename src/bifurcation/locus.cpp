#include "orbweaver/bifurcation/locus.hpp"
#include "orbweaver/bifurcation/slopes.hpp"

#include <array>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "orbweaver/bifurcation/symmetry_watch.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/spectrum/floquet.hpp"

namespace orbweaver::bifurcation {

namespace {

/// Beyond 1:1 and 1:2, where the two multipliers meet on the real axis, those with the product 1 are real.
template <class StabilityOf>
std::vector<continuation::LocusBoundary> strong_resonances(const systems::System& surface,
                                                           const StabilityOf& stability_of) {
  constexpr double largest_sum = 2.0;
  const auto inside = [&surface, stability_of](double sign) {
    return [&surface, stability_of, sign](const loop::Loop& loop) {
      try {
        return largest_sum + sign * torus_sum(surface.structure(), stability_of(loop));
      } catch (const core::NumericalError&) {
        return std::numeric_limits<double>::quiet_NaN();
      }
    };
  };
  using continuation::EndReason;
  return {{{EndReason::strong_resonance, "1:1, both multipliers are 1"}, inside(-1.0)},
          {{EndReason::strong_resonance, "1:2, both multipliers are -1"}, inside(1.0)}};
}

std::string name_of(const SymmetryGain& gain) {
  if (gain.reversing) return gain.name;
  return fmt::format("{}@{}/{}", gain.name, gain.shift_numerator, gain.shift_denominator);
}

std::vector<continuation::LocusArrival> arrivals_between(const SymmetryWatch& watch, const loop::Loop& from,
                                                         const loop::Loop& to) {
  std::vector<continuation::LocusArrival> found;
  for (const SymmetryGain& gain : watch.all_passed(SymmetryWatch::sampled(from), SymmetryWatch::sampled(to)))
    found.push_back(
        {name_of(gain), [&watch, gain, from](const loop::Loop& there) {
           return std::array<double, 2>{watch.signed_part(gain, from, there), watch.relative_size(gain, from, there)};
         }});
  return found;
}

}  // namespace

continuation::LocusTest locus_test(const systems::System& surface, const loop::Isotropy& isotropy, const Event& event,
                                   core::Team* team) {
  continuation::LocusTest test;
  test.arrivals = [watch = std::make_shared<SymmetryWatch>(surface.structure(), isotropy)](
                      const loop::Loop& from, const loop::Loop& to) { return arrivals_between(*watch, from, to); };
  if (event.kind == Event::Kind::test_function) {
    const auto stability_of = [&surface, isotropy, team](const loop::Loop& loop) {
      spectrum::FloquetOptions options;
      options.team = team;
      return spectrum::floquet(surface, loop, isotropy, options);
    };
    if (event.function.kind == TestFunction::Kind::torus) test.boundaries = strong_resonances(surface, stability_of);
    test.value = [&surface, stability_of, function = event.function](const loop::Loop& loop) {
      const spectrum::Stability stability = stability_of(loop);
      if (function.kind == TestFunction::Kind::sector)
        return index_deviation(surface.structure(), stability, function.sector).value;
      return evaluate(function, surface.structure(), stability).value;
    };
    return test;
  }
  test.projection = [&surface, kind = event.kind](const loop::Loop& loop, const loop::Tangent& along) {
    const continuation::CurvePoint point{0.0, loop, along};
    const double second = along.scalars[surface.family_scalars().free.size()];
    if (kind == Event::Kind::fold_period) return std::array<double, 2>{period_slope(point), second};
    // The second parameter's own part of the energy's change leaves the pair parallel where it is.
    const double first = kind == Event::Kind::fold_energy ? energy_slope(surface, point) : parameter_slope(point);
    return std::array<double, 2>{first, second};
  };
  return test;
}

}  // namespace orbweaver::bifurcation
