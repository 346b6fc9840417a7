#pragma once

#include <cmath>
#include <utility>
#include <vector>

#include "effects/composition.hpp"
#include "effects/joint_damping.hpp"
#include "effects/joint_torque.hpp"
#include "effects/pivot_drive.hpp"
#include "effects/rod_inertia.hpp"
#include "effects/torsion_springs.hpp"

namespace orbweaver::systems {

/// What moves of the double pendulum: two bobs on massless rods, to which effects add. The Lagrangian is
///   L = inner l1^2 w1^2/2 + outer l2^2 w2^2/2 + coupling l1 l2 w1 w2 cos(th1 - th2)
///       + weight_1 g l1 cos th1 + weight_2 g l2 cos th2.
template <class P>
struct PendulumMasses {
  P bob_1;
  P bob_2;
  P inner = bob_1 + bob_2;
  P outer = bob_2;
  P coupling = bob_2;
  P weight_1 = bob_1 + bob_2;
  P weight_2 = bob_2;
  P determinant = bob_1 * bob_2;  ///< inner outer - coupling^2, which is > 0, without cancellation
};

/// Names, parameters and effects; what holds without effects.
[[nodiscard]] ModelInfo ideal_double_pendulum();
[[nodiscard]] Structure structure_of_ideal_double_pendulum();

/// Two point masses on massless rods, the second hanging from the first. State th1, th2 (rad from the downward
/// vertical), w1, w2 (rad/s). With M = m1 + m2 and d = th1 - th2 the Lagrangian is
///   L = M l1^2 w1^2 / 2 + m2 l2^2 w2^2 / 2 + m2 l1 l2 w1 w2 cos d + M g l1 cos th1 + m2 g l2 cos th2,
/// whose two equations are solved here for the angular accelerations (determinant m1 + m2 sin^2 d > 0).
///
/// Terms of effects may have
///   void add_masses(PendulumMasses<P>&) const;                         // rods
///   void add_torques(const S* z, S& on_1, S& on_2) const;              // dL/dth1, dL/dth2 and what no L gives
///   S potential(const S* z) const;                                     // of those torques, where nothing drives
///   void set_felt(const S& phase, S& side, S& up) const;               // acceleration beside gravity; one effect only
template <class... Effects>
class DoublePendulum {
 public:
  static constexpr bool driven = is_driven<Effects...>;
  static constexpr int dimension = driven ? 5 : 4;
  static constexpr int quantities = is_conservative<Effects...> ? 1 : 0;
  static std::vector<EffectRules> effects() { return {rules_of<Effects>()...}; }
  static ModelInfo info() {
    ModelInfo ideal = ideal_double_pendulum();
    if constexpr (sizeof...(Effects) > 0) ideal.title = "Double pendulum";
    return with_effects(std::move(ideal), effects());
  }
  static Structure structure(const Bound& bound) {
    return with_effects(structure_of_ideal_double_pendulum(), effects(), bound);
  }

  template <class P>
  class With;
};

/// The ideal one.
template <>
template <class P>
class DoublePendulum<>::With {
 public:
  explicit With(const BoundTo<P>& bound)
      : _m1(bound["m1"]), _m2(bound["m2"]), _l1(bound["l1"]), _l2(bound["l2"]), _g(bound["g"]) {}

  template <class S>
  void field(const S* z, S* f) const {
    using std::cos;
    using std::sin;
    const P mass = _m1 + _m2;
    const S d = z[0] - z[1];
    const S sin_d = sin(d);
    const S cos_d = cos(d);
    const S sin_1 = sin(z[0]);
    const S sin_2 = sin(z[1]);
    const S swing_1 = z[2] * z[2] * _l1;
    const S swing_2 = z[3] * z[3] * _l2;
    const S share = S(1.0) / (sin_d * sin_d * _m2 + _m1);
    const S pull_1 = (sin_2 * cos_d * _m2 - sin_1 * mass) * _g - sin_d * (swing_1 * cos_d + swing_2) * _m2;
    const S pull_2 = (sin_1 * cos_d - sin_2) * (mass * _g) + sin_d * (swing_1 * mass + swing_2 * cos_d * _m2);
    f[0] = z[2];
    f[1] = z[3];
    f[2] = pull_1 * share * (1.0 / _l1);
    f[3] = pull_2 * share * (1.0 / _l2);
  }

  template <int, class S>
  S conserved(const S* z) const {
    using std::cos;
    const S height = cos(z[0]) * ((_m1 + _m2) * _l1) + cos(z[1]) * (_m2 * _l2);
    return action_density(z) * 0.5 - height * _g;
  }

  template <class S>
  S action_density(const S* z) const {
    using std::cos;
    const S d = z[0] - z[1];
    return z[2] * z[2] * ((_m1 + _m2) * _l1 * _l1) + z[3] * z[3] * (_m2 * _l2 * _l2) +
           z[2] * z[3] * cos(d) * (2.0 * _m2 * _l1 * _l2);
  }

 private:
  P _m1;
  P _m2;
  P _l1;
  P _l2;
  P _g;
};

template <class... Effects>
template <class P>
class DoublePendulum<Effects...>::With {
 public:
  explicit With(const BoundTo<P>& bound) : _terms(bound), _gravity(bound["g"]) {
    PendulumMasses<P> masses{bound["m1"], bound["m2"]};
    _terms.for_each([&](const auto& terms) {
      if constexpr (requires { terms.add_masses(masses); }) terms.add_masses(masses);
    });
    const P l1 = bound["l1"];
    const P l2 = bound["l2"];
    _inner = masses.inner * l1 * l1;
    _outer = masses.outer * l2 * l2;
    _coupling = masses.coupling * l1 * l2;
    _determinant = masses.determinant * (l1 * l1 * l2 * l2);
    _arm_1 = masses.weight_1 * l1;
    _arm_2 = masses.weight_2 * l2;
    _weight_1 = _arm_1 * _gravity;
    _weight_2 = _arm_2 * _gravity;
    if constexpr (driven) _frequency = bound["drive_frequency"];
  }

  template <class S>
  void field(const S* z, S* f) const {
    using std::cos;
    using std::sin;
    const S d = z[0] - z[1];
    const S across = sin(d) * _coupling;
    const S along = cos(d) * _coupling;
    const S swing_1 = z[2] * z[2] * across;
    const S swing_2 = z[3] * z[3] * across;
    S on_1 = S(0.0);
    S on_2 = S(0.0);
    if constexpr (shaken) {
      S side;
      S up;
      _terms.for_each([&](const auto& terms) {
        if constexpr (requires { terms.set_felt(z[4], side, up); }) terms.set_felt(z[4], side, up);
      });
      const S down = _gravity - up;
      on_1 = (cos(z[0]) * side - sin(z[0]) * down) * _arm_1 - swing_2;
      on_2 = (cos(z[1]) * side - sin(z[1]) * down) * _arm_2 + swing_1;
    } else {
      on_1 = -(sin(z[0]) * _weight_1 + swing_2);
      on_2 = swing_1 - sin(z[1]) * _weight_2;
    }
    _terms.for_each([&](const auto& terms) {
      if constexpr (requires { terms.add_torques(z, on_1, on_2); }) terms.add_torques(z, on_1, on_2);
    });
    const S share = S(1.0) / (across * across + _determinant);
    f[0] = z[2];
    f[1] = z[3];
    f[2] = (on_1 * _outer - on_2 * along) * share;
    f[3] = (on_2 * _inner - on_1 * along) * share;
    if constexpr (driven) f[4] = S(_frequency);
  }

  template <int, class S>
  S conserved(const S* z) const {
    using std::cos;
    S energy = action_density(z) * 0.5 - cos(z[0]) * _weight_1 - cos(z[1]) * _weight_2;
    _terms.for_each([&](const auto& terms) {
      if constexpr (requires { terms.potential(z); }) energy += terms.potential(z);
    });
    return energy;
  }

  template <class S>
  S action_density(const S* z) const {
    using std::cos;
    return z[2] * z[2] * _inner + z[3] * z[3] * _outer + z[2] * z[3] * cos(z[0] - z[1]) * (2.0 * _coupling);
  }

 private:
  template <class E>
  static constexpr bool shakes = requires(const typename E::template With<double>& terms, double& number) {
    terms.set_felt(number, number, number);
  };
  static constexpr bool shaken = (shakes<Effects> || ...);

  Terms<P, Effects...> _terms;
  P _gravity;
  P _inner;
  P _outer;
  P _coupling;
  P _determinant;
  P _arm_1;
  P _arm_2;
  P _weight_1;
  P _weight_2;
  P _frequency = P(0.0);
};

}  // namespace orbweaver::systems
