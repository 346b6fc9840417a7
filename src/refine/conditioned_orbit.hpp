#pragma once

#include <string>

#include <Eigen/Dense>

#include "orbweaver/refine/orbit.hpp"
#include "shooting.hpp"

namespace orbweaver::refine {

/// The condition that picks one orbit of a family.
struct Held {
  enum class Kind {
    nothing,  ///< the orbit is isolated
    period,
    energy,
    plane,
  } kind = Kind::plane;
  std::string decimal;  ///< of a period or energy
  // Of a plane: along . (u - origin) = offset, in the scales; u is all nodes, one after the other, and the period.
  Eigen::VectorXd along;
  Points<double> origin;
  numerics::Extended offset = 0;
};

/// Orbits of one family under a condition, in double and beyond.
class ConditionedOrbit {
 public:
  explicit ConditionedOrbit(const ShootingSetup& setup) : _setup(setup), _shooting(setup, double_digits, 0) {}

  /// Newton's method in double. Throws NumericalError.
  [[nodiscard]] Points<double> converge(const Points<double>& guess, const Held& held);
  /// The direction of the family there, of unit length in the scales.
  [[nodiscard]] Eigen::VectorXd direction(const Points<double>& points);
  /// Factors the Jacobian at an orbit: what `polish` iterates with. Throws NumericalError where the condition does not
  /// isolate the orbit.
  void factor(const Points<double>& points, const Held& held);

  /// Newton's method in extended arithmetic with the factored Jacobian, from points that are good to `accuracy` digits
  /// (relative to the scales) to about `digits`. The points keep their digits.
  void polish(Points<numerics::Extended>& points, const Held& held, double accuracy, int digits);

  [[nodiscard]] Shooting<double>& in_double() { return _shooting; }
  [[nodiscard]] const ShootingSetup& setup() const { return _setup; }
  /// Steps of integrations in extended arithmetic.
  [[nodiscard]] long steps() const { return _steps; }
  void count_steps(long steps) { _steps += steps; }
  /// Of the Taylor series of the next integrations.
  int extra_order = 0;

  static constexpr double double_digits = 16.0;
  static constexpr double first_gain = 6.0;  ///< digits an iteration, until it has been seen

 private:
  void require_near(const Points<double>& points, const Points<double>& guess) const;
  template <class Real>
  [[nodiscard]] Vector<Real> rows(const Shooting<Real>& shooting, const Points<Real>& points,
                                  const Passage<Real>& passage, const Held& held) const;
  [[nodiscard]] Eigen::MatrixXd jacobian(const Points<double>& points, const Passage<double>& passage,
                                         const Held& held) const;

  const ShootingSetup& _setup;
  Shooting<double> _shooting;
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> _factor;
  double _gain = first_gain;
  long _steps = 0;
};

/// The points with the digits in force.
[[nodiscard]] Points<numerics::Extended> extended(const Points<double>& points);
[[nodiscard]] Points<numerics::Extended> extended(const Points<numerics::Extended>& points);

}  // namespace orbweaver::refine
