#pragma once

#include <vector>

#include "effects/composition.hpp"
#include "effects/damping.hpp"
#include "effects/drive.hpp"

namespace orbweaver::systems {

/// Names, parameters and effects; what holds without effects.
[[nodiscard]] ModelInfo ideal_duffing();
[[nodiscard]] Structure structure_of_ideal_duffing();

/// Duffing's oscillator, a mass of 1 on a spring with a cubic term, without units (G. Duffing 1918). State x, v;
///   H = v^2/2 + alpha x^2/2 + beta x^4/4.
///
/// Terms of effects have
///   void add_acceleration(const S* z, S* out) const;
template <class... Effects>
class Duffing {
 public:
  static constexpr bool driven = is_driven<Effects...>;
  static constexpr int dimension = driven ? 3 : 2;
  static constexpr int quantities = is_conservative<Effects...> ? 1 : 0;
  static std::vector<EffectRules> effects() { return {rules_of<Effects>()...}; }
  static ModelInfo info() { return with_effects(ideal_duffing(), effects()); }
  static Structure structure(const Bound& bound) {
    return with_effects(structure_of_ideal_duffing(), effects(), bound);
  }

  template <class P>
  class With {
   public:
    explicit With(const BoundTo<P>& bound) : _alpha(bound["alpha"]), _beta(bound["beta"]), _terms(bound) {
      if constexpr (driven) _frequency = bound["drive_frequency"];
    }

    template <class S>
    void field(const S* z, S* f) const {
      f[0] = z[1];
      f[1] = -(z[0] * (z[0] * z[0] * _beta + _alpha));
      _terms.for_each([&](const auto& terms) { terms.add_acceleration(z, f + 1); });
      if constexpr (driven) f[2] = S(_frequency);
    }

    template <int, class S>
    S conserved(const S* z) const {
      const S square = z[0] * z[0];
      return (z[1] * z[1] + square * _alpha + square * square * (_beta * 0.5)) * 0.5;
    }

    template <class S>
    S action_density(const S* z) const {
      return z[1] * z[1];
    }

   private:
    P _alpha;
    P _beta;
    P _frequency = P(0.0);
    Terms<P, Effects...> _terms;
  };
};

}  // namespace orbweaver::systems
