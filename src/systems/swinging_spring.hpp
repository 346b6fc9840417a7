#pragma once

#include <cmath>
#include <vector>

#include "effects/composition.hpp"
#include "effects/damping.hpp"
#include "effects/drive.hpp"

namespace orbweaver::systems {

/// Names, parameters and effects; what holds without effects.
[[nodiscard]] ModelInfo ideal_swinging_spring();
[[nodiscard]] Structure structure_of_ideal_swinging_spring();

/// A point mass on a massless spring (elastic pendulum) in a vertical plane. State x, y (m from the suspension, y
/// upwards), vx, vy. With r = |(x, y)|,
///   H = mass (vx^2 + vy^2)/2 + stiffness (r - length)^2/2 + mass gravity y.
/// At rest it hangs at y = -(length + mass gravity/stiffness), where it oscillates up and down with the frequency
/// sqrt(stiffness/mass) and swings with the frequency sqrt(gravity/|y|). These are 2:1 if
///   stiffness length = 3 mass gravity.
///
/// Terms of effects have
///   void add_acceleration(const S* z, S* out) const;   // along x and y
template <class... Effects>
class SwingingSpring {
 public:
  static constexpr bool driven = is_driven<Effects...>;
  static constexpr int dimension = driven ? 5 : 4;
  static constexpr int quantities = is_conservative<Effects...> ? 1 : 0;
  static std::vector<EffectRules> effects() { return {rules_of<Effects>()...}; }
  static ModelInfo info() { return with_effects(ideal_swinging_spring(), effects()); }
  static Structure structure(const Bound& bound) {
    return with_effects(structure_of_ideal_swinging_spring(), effects(), bound);
  }

  template <class P>
  class With {
   public:
    explicit With(const BoundTo<P>& bound)
        : _mass(bound["mass"]),
          _stiffness(bound["stiffness"]),
          _length(bound["length"]),
          _gravity(bound["gravity"]),
          _terms(bound) {
      if constexpr (driven) _frequency = bound["drive_frequency"];
    }

    template <class S>
    void field(const S* z, S* f) const {
      using std::sqrt;
      const S r = sqrt(z[0] * z[0] + z[1] * z[1]);
      const S pull = (S(1.0) - S(1.0) / r * _length) * (_stiffness / _mass);
      f[0] = z[2];
      f[1] = z[3];
      f[2] = -(z[0] * pull);
      f[3] = -(z[1] * pull) - _gravity;
      _terms.for_each([&](const auto& terms) { terms.add_acceleration(z, f + 2); });
      if constexpr (driven) f[4] = S(_frequency);
    }

    template <int, class S>
    S conserved(const S* z) const {
      using std::sqrt;
      const S stretch = sqrt(z[0] * z[0] + z[1] * z[1]) - _length;
      return (action_density(z) + stretch * stretch * _stiffness) * 0.5 + z[1] * (_mass * _gravity);
    }

    template <class S>
    S action_density(const S* z) const {
      return (z[2] * z[2] + z[3] * z[3]) * _mass;
    }

    [[nodiscard]] double guard(int, const double* z) const { return std::hypot(z[0], z[1]); }

   private:
    P _mass;
    P _stiffness;
    P _length;
    P _gravity;
    P _frequency = P(0.0);
    Terms<P, Effects...> _terms;
  };
};

}  // namespace orbweaver::systems
