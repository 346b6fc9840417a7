#pragma once

#include <array>
#include <cmath>
#include <vector>

#include "effects/composition.hpp"
#include "effects/oblateness.hpp"
#include "effects/radiation.hpp"

namespace orbweaver::systems {

/// Names, parameters and effects; what holds without effects.
[[nodiscard]] ModelInfo ideal_pcr3bp();
[[nodiscard]] Structure structure_of_ideal_pcr3bp(const Bound& bound);

/// The planar circular restricted three-body problem (Szebehely 1967, Theory of Orbits): a particle without mass in the
/// field of two bodies on circles, in the frame that turns with them. Units: the distance of the bodies, the mass of
/// both, and the time in which the frame turns by 1 rad. State x, y, vx, vy; bodies of masses 1 - mu at (-mu, 0) and mu
/// at (1 - mu, 0), at distances r1 and r2;
///   H = (vx^2 + vy^2)/2 - (x^2 + y^2)/2 - (1 - mu)/r1 - mu/r2,   momenta vx - y and vy + x.
/// Jacobi's constant is -2 H (some authors add mu (1 - mu)).
///
/// Terms of effects may have
///   void change_attraction(std::array<P, 2>& strengths) const;   // g of the attractions g/r^2
///   void change_turning(P& square) const;                        // n^2 of the frame, which is 1 without
///   void set_quadrupoles(std::array<P, 2>& strengths) const;     // g of attractions g/r^4; one effect only
template <class... Effects>
class Pcr3bp {
 public:
  static constexpr int dimension = 4;
  static constexpr int quantities = 1;
  static std::vector<EffectRules> effects() { return {rules_of<Effects>()...}; }
  static ModelInfo info() { return with_effects(ideal_pcr3bp(), effects()); }
  static Structure structure(const Bound& bound) {
    return with_effects(structure_of_ideal_pcr3bp(bound), effects(), bound);
  }

  template <class P>
  class With {
   public:
    explicit With(const BoundTo<P>& bound) : _mu(bound["mu"]), _attraction{1.0 - bound["mu"], bound["mu"]} {
      using std::sqrt;
      const Terms<P, Effects...> terms(bound);
      P square = P(1.0);
      terms.for_each([&](const auto& term) {
        if constexpr (requires { term.change_attraction(_attraction); }) term.change_attraction(_attraction);
        if constexpr (requires { term.change_turning(square); }) term.change_turning(square);
        if constexpr (requires { term.set_quadrupoles(_quadrupole); }) term.set_quadrupoles(_quadrupole);
      });
      _turning = sqrt(square);
      _turning_square = square;
      _coriolis = _turning * 2.0;
    }

    template <class S>
    void field(const S* z, S* f) const {
      const S from_1 = z[0] + _mu;
      const S from_2 = z[0] + (_mu - 1.0);
      const S square_y = z[1] * z[1];
      const S pull_1 = pull(from_1 * from_1 + square_y, 0);
      const S pull_2 = pull(from_2 * from_2 + square_y, 1);
      f[0] = z[2];
      f[1] = z[3];
      if constexpr (turns_otherwise) {
        f[2] = z[3] * _coriolis + z[0] * _turning_square - from_1 * pull_1 - from_2 * pull_2;
        f[3] = z[1] * _turning_square - z[2] * _coriolis - z[1] * (pull_1 + pull_2);
      } else {
        f[2] = z[3] * 2.0 + z[0] - from_1 * pull_1 - from_2 * pull_2;
        f[3] = z[2] * -2.0 + z[1] - z[1] * (pull_1 + pull_2);
      }
    }

    template <int, class S>
    S conserved(const S* z) const {
      const S kinetic = (z[2] * z[2] + z[3] * z[3]) * 0.5;
      S centrifugal = (z[0] * z[0] + z[1] * z[1]) * 0.5;
      if constexpr (turns_otherwise) centrifugal = centrifugal * _turning_square;
      return kinetic - centrifugal - depth(z[0] + _mu, z[1], 0) - depth(z[0] + (_mu - 1.0), z[1], 1);
    }

    template <class S>
    S action_density(const S* z) const {
      if constexpr (turns_otherwise)
        return (z[2] - z[1] * _turning) * z[2] + (z[3] + z[0] * _turning) * z[3];
      else
        return (z[2] - z[1]) * z[2] + (z[3] + z[0]) * z[3];
    }

    [[nodiscard]] double guard(int k, const double* z) const {
      return std::hypot(z[0] + (k == 0 ? _mu : _mu - 1.0), z[1]);
    }

   private:
    template <class E>
    static constexpr bool turns = requires(const typename E::template With<double>& terms, double& number) {
      terms.change_turning(number);
    };
    template <class E>
    static constexpr bool flattens = requires(const typename E::template With<double>& terms,
                                              std::array<double, 2>& numbers) {
      terms.set_quadrupoles(numbers);
    };
    static constexpr bool turns_otherwise = (turns<Effects> || ...);
    static constexpr bool oblate = (flattens<Effects> || ...);

    /// Attraction over the distance.
    template <class S>
    S pull(const S& square, std::size_t body) const {
      using std::sqrt;
      if constexpr (oblate) {
        const S r = sqrt(square);
        const S cube = S(1.0) / (square * r);
        return cube * (cube * r * _quadrupole[body] + _attraction[body]);
      } else {
        return S(1.0) / (square * sqrt(square)) * _attraction[body];
      }
    }

    /// Minus the potential.
    template <class S>
    S depth(const S& x, const S& y, std::size_t body) const {
      using std::sqrt;
      const S inverse = S(1.0) / sqrt(x * x + y * y);
      if constexpr (oblate)
        return inverse * (inverse * inverse * (_quadrupole[body] / 3.0) + _attraction[body]);
      else
        return inverse * _attraction[body];
    }

    P _mu;
    std::array<P, 2> _attraction;
    std::array<P, 2> _quadrupole{P(0.0), P(0.0)};
    P _turning;
    P _turning_square;
    P _coriolis;
  };
};

}  // namespace orbweaver::systems
