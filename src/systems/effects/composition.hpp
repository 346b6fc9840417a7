#pragma once

#include <string>
#include <tuple>
#include <vector>

#include "orbweaver/systems/model/bound.hpp"
#include "orbweaver/systems/model_info.hpp"
#include "orbweaver/systems/structure.hpp"

namespace orbweaver::systems {

/// What a symmetry of the ideal system must do with the drive's phase to keep a term. Under a reversor the phase turns
/// back.
enum class PhaseShift { any, none, half_turn, broken };

/// What an effect is to the structure. An effect is a class with
///   static constexpr bool dissipates;                         // volumes of the space of states are not kept
///   static constexpr bool drives;                             // it needs the drive's phase
///   static Effect info();
///   static PhaseShift shift(const Symmetry& ideal, const Bound& bound);
///   template <class P> class With;                            // its terms, made from a BoundTo<P>
/// and, if coordinates are angles no longer,
///   static void change(Structure& structure);
/// The functions of its terms are those that its models ask for, which say so.
struct EffectRules {
  Effect (*info)() = nullptr;
  bool dissipates = false;
  bool drives = false;
  PhaseShift (*shift)(const Symmetry& ideal, const Bound& bound) = nullptr;
  void (*change)(Structure& structure) = nullptr;
};

template <class E>
EffectRules rules_of() {
  EffectRules rules{&E::info, E::dissipates, E::drives, &E::shift, nullptr};
  if constexpr (requires(Structure & structure) { E::change(structure); }) rules.change = &E::change;
  return rules;
}

template <class... Effects>
inline constexpr bool is_driven = (Effects::drives || ...);
template <class... Effects>
inline constexpr bool is_conservative = !((Effects::dissipates || Effects::drives) || ...);

/// The ideal model's description with the effects: the phase of a drive is a last coordinate.
[[nodiscard]] ModelInfo with_effects(ModelInfo ideal, const std::vector<EffectRules>& effects);

/// What holds of the ideal system's structure with the effects, at any strength: a symmetry that all terms keep,
/// together with its shift of the phase; the conserved quantities if nothing dissipates or drives; no reversors and no
/// pairs of multipliers if something dissipates.
[[nodiscard]] Structure with_effects(Structure ideal, const std::vector<EffectRules>& effects, const Bound& bound);

/// The mass of a point that moves along so many coordinates: that of the system in a plane, 1 on a line.
template <int coordinates, class P>
[[nodiscard]] P mass_of_point(const BoundTo<P>& bound) {
  if constexpr (coordinates == 1)
    return P(1.0);
  else
    return bound["mass"];
}

/// Whether a symmetry of an ideal system changes the sign of its first coordinate: of an angle, or to the side.
[[nodiscard]] bool mirrors(const Symmetry& ideal);

/// The terms of some effects, in the order of their types.
template <class P, class... Effects>
class Terms {
 public:
  explicit Terms([[maybe_unused]] const BoundTo<P>& bound) : _terms(typename Effects::template With<P>(bound)...) {}

  /// visit(terms) for each effect.
  template <class Visit>
  void for_each([[maybe_unused]] const Visit& visit) const {
    std::apply([&](const auto&... terms) { (visit(terms), ...); }, _terms);
  }

 private:
  std::tuple<typename Effects::template With<P>...> _terms;
};

}  // namespace orbweaver::systems
