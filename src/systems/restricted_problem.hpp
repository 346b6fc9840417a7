#pragma once

#include <array>
#include <cmath>
#include <vector>

#include "effects/composition.hpp"
#include "effects/oblateness.hpp"
#include "effects/radiation.hpp"

namespace orbweaver::systems {

/// Names, parameters and effects of the problem in the plane (`space` 2) or in space (3); what holds without effects.
[[nodiscard]] ModelInfo ideal_restricted_problem(int space);
[[nodiscard]] Structure structure_of_ideal_restricted_problem(int space, const Bound& bound);

/// The circular restricted three-body problem (Szebehely 1967, Theory of Orbits): a particle without mass in the field
/// of two bodies on circles, in the frame that turns with them. Units: the distance of the bodies, the mass of both,
/// and the time in which the frame turns by 1 rad. State x, y, vx, vy, or x, y, z, vx, vy, vz; bodies of masses
/// 1 - mu at (-mu, 0, 0) and mu at (1 - mu, 0, 0), at distances r1 and r2;
///   H = (vx^2 + vy^2 + vz^2)/2 - (x^2 + y^2)/2 - (1 - mu)/r1 - mu/r2,   momenta vx - y, vy + x and vz.
/// Jacobi's constant is -2 H (some authors add mu (1 - mu)).
///
/// Terms of effects may have
///   void change_attraction(std::array<P, 2>& strengths) const;   // g of the attractions g/r^2
///   void change_turning(P& square) const;                        // n^2 of the frame, which is 1 without
///   void set_quadrupoles(std::array<P, 2>& strengths) const;     // g of g/r^4 in the plane; one effect only
template <int space, class... Effects>
class RestrictedProblem {
 public:
  static constexpr int dimension = 2 * space;
  static constexpr int quantities = 1;
  static std::vector<EffectRules> effects() { return {rules_of<Effects>()...}; }
  static ModelInfo info() { return with_effects(ideal_restricted_problem(space), effects()); }
  static Structure structure(const Bound& bound) {
    return with_effects(structure_of_ideal_restricted_problem(space, bound), effects(), bound);
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
      const S square_1 = square_of_distance(from_1, z);
      const S square_2 = square_of_distance(from_2, z);
      const S pull_1 = pull(square_1, z, 0);
      const S pull_2 = pull(square_2, z, 1);
      const S* v = z + space;
      for (int i = 0; i < space; ++i) f[i] = v[i];
      S* a = f + space;
      if constexpr (turns_otherwise) {
        a[0] = v[1] * _coriolis + z[0] * _turning_square - from_1 * pull_1 - from_2 * pull_2;
        a[1] = z[1] * _turning_square - v[0] * _coriolis - z[1] * (pull_1 + pull_2);
      } else {
        a[0] = v[1] * 2.0 + z[0] - from_1 * pull_1 - from_2 * pull_2;
        a[1] = v[0] * -2.0 + z[1] - z[1] * (pull_1 + pull_2);
      }
      if constexpr (space == 3) {
        a[2] = -(z[2] * (pull_1 + pull_2));
        if constexpr (oblate) a[2] = a[2] - z[2] * (lift(square_1, 0) + lift(square_2, 1));
      }
    }

    template <int, class S>
    S conserved(const S* z) const {
      const S* v = z + space;
      S squares = v[0] * v[0] + v[1] * v[1];
      if constexpr (space == 3) squares = squares + v[2] * v[2];
      const S kinetic = squares * 0.5;
      S centrifugal = (z[0] * z[0] + z[1] * z[1]) * 0.5;
      if constexpr (turns_otherwise) centrifugal = centrifugal * _turning_square;
      return kinetic - centrifugal - depth(z[0] + _mu, z, 0) - depth(z[0] + (_mu - 1.0), z, 1);
    }

    template <class S>
    S action_density(const S* z) const {
      const S* v = z + space;
      S sum = z[0];
      if constexpr (turns_otherwise)
        sum = (v[0] - z[1] * _turning) * v[0] + (v[1] + z[0] * _turning) * v[1];
      else
        sum = (v[0] - z[1]) * v[0] + (v[1] + z[0]) * v[1];
      if constexpr (space == 3) sum = sum + v[2] * v[2];
      return sum;
    }

    [[nodiscard]] double guard(int k, const double* z) const {
      const double x = z[0] + (k == 0 ? _mu : _mu - 1.0);
      return space == 2 ? std::hypot(x, z[1]) : std::hypot(x, z[1], z[2]);
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

    template <class S>
    static S square_of_distance(const S& x, const S* z) {
      S square = x * x + z[1] * z[1];
      if constexpr (space == 3) square = square + z[2] * z[2];
      return square;
    }

    /// Attraction in the plane over the distance from the body.
    template <class S>
    S pull(const S& square, [[maybe_unused]] const S* z, std::size_t body) const {
      using std::sqrt;
      if constexpr (oblate) {
        const S r = sqrt(square);
        const S cube = S(1.0) / (square * r);
        S flattening = cube * r * _quadrupole[body];
        if constexpr (space == 3) flattening = flattening * (1.0 - z[2] * z[2] / square * 5.0);
        return cube * (flattening + _attraction[body]);
      } else {
        return S(1.0) / (square * sqrt(square)) * _attraction[body];
      }
    }

    /// What draws an oblate body's particle to the plane besides, over its height.
    template <class S>
    S lift(const S& square, std::size_t body) const {
      using std::sqrt;
      return S(1.0) / (square * square * sqrt(square)) * (_quadrupole[body] * 2.0);
    }

    /// Minus the potential.
    template <class S>
    S depth(const S& x, const S* z, std::size_t body) const {
      using std::sqrt;
      const S square = square_of_distance(x, z);
      const S inverse = S(1.0) / sqrt(square);
      if constexpr (oblate) {
        S flattening = inverse * inverse * (_quadrupole[body] / 3.0);
        if constexpr (space == 3) flattening = flattening * (1.0 - z[2] * z[2] / square * 3.0);
        return inverse * (flattening + _attraction[body]);
      } else {
        return inverse * _attraction[body];
      }
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
