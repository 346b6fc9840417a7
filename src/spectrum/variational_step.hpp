#pragma once

#include <cstddef>
#include <vector>

#include "orbweaver/systems/system.hpp"

namespace orbweaver::spectrum {

/// One Runge-Kutta step of dz/dt = f(z), dY/dt = f_z(z) Y, Y(0) = 1, for `lanes` starting states at a time.
class VariationalStep {
 public:
  /// States done together: the slopes of all stages stay in the first cache.
  static constexpr std::size_t lanes = 16;

  explicit VariationalStep(const systems::System& system);

  /// `starts`: dimension x lanes, component-major; a step of its own length (`lengths`, one a lane) from each. Only the
  /// first `used` lanes are wanted: what the others hold afterwards is of no use.
  void run(const double* starts, const double* lengths, std::size_t used = lanes);

  /// State reached, [i * lanes + lane], and transition matrix, [(i * dimension + l) * lanes + lane].
  [[nodiscard]] const double* states() const { return _values.data(); }
  [[nodiscard]] const double* transitions() const { return _values.data() + _dimension * lanes; }
  /// Estimate of the transition matrix's truncation error, laid out like it: Hairer, Norsett and Wanner's from the
  /// embedded methods of orders 5 and 3 (section II.10), an order too large.
  [[nodiscard]] const double* truncations() const { return _truncations.data(); }

 private:
  void slope(std::size_t stage, std::size_t used);
  void estimate(const double* lengths, std::size_t used);
  const systems::System& _system;
  std::size_t _dimension;
  std::size_t _size;  ///< numbers a stage: (dimension + dimension^2) x lanes
  std::vector<double> _start;
  std::vector<double> _values;
  std::vector<double> _slopes;  ///< stages x _size
  std::vector<double> _jacobian;
  std::vector<double> _truncations;
};

}  // namespace orbweaver::spectrum
