#pragma once

#include <cstddef>
#include <vector>

#include "orbweaver/systems/system.hpp"

namespace orbweaver::spectrum {

/// One Runge-Kutta step of dz/dt = f(z), dY/dt = f_z(z) Y, Y(0) = 1, for `lanes` starting states at a time.
class VariationalStep {
 public:
  /// States done together: what the compiler makes vectors of.
  static constexpr std::size_t lanes = 16;

  explicit VariationalStep(const systems::System& system);

  /// `starts`: dimension x lanes, component-major; a step of length h from each.
  void run(const double* starts, double h);

  /// State reached, [i * lanes + lane], and transition matrix, [(i * dimension + l) * lanes + lane].
  [[nodiscard]] const double* states() const { return _values.data(); }
  [[nodiscard]] const double* transitions() const { return _values.data() + _dimension * lanes; }

 private:
  void slope(std::size_t stage);
  const systems::System& _system;
  std::size_t _dimension;
  std::size_t _size;  ///< numbers a stage: (dimension + dimension^2) x lanes
  std::vector<double> _start;
  std::vector<double> _values;
  std::vector<double> _slopes;  ///< stages x _size
  std::vector<double> _jacobian;
};

}  // namespace orbweaver::spectrum
