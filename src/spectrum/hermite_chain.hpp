#pragma once

#include <cstddef>
#include <vector>

#include "floquet_chain.hpp"
#include "floquet_group.hpp"
#include "orbit_correction.hpp"
#include "orbweaver/loop/curve/loop.hpp"
#include "orbweaver/systems/system.hpp"
#include "sampled_loop.hpp"

namespace orbweaver::spectrum {

/// A chain of long segments along a loop that is taken as it is: dY/ds = t'(s) A(z(s)) Y is solved by two-point Hermite
/// steps of order 16 (hermite_rule.hpp), with the Taylor coefficients of t' A from its values at points that are equal
/// in s. Its truncation estimates are those of the error, and its defects what the loop leaves of the flow's equation.
class HermiteChain {
 public:
  /// At least `at_least` segments a period: as many as suit the loop's resolution, the rates of its linearised flow and
  /// its fundamental map. Throws core::NotFiniteError if field or Jacobian is not finite on the loop.
  HermiteChain(const systems::System& system, const loop::Loop& loop, const FundamentalGroup& group, int at_least);

  [[nodiscard]] const Chain& chain() const { return _chain; }
  /// The chain along the loop with `factor` times the correction added, to first order in that.
  [[nodiscard]] Chain corrected(const systems::System& system, const OrbitCorrection& correction, double factor) const;

 private:
  void take_inner(const systems::System& system);
  template <std::size_t D>
  void solve();
  template <std::size_t D>
  void take_node(std::size_t first, double* ends);
  template <std::size_t D>
  void take_segments(std::size_t first, const double* ends);
  template <std::size_t D>
  void take_drifts(std::size_t first);
  template <std::size_t D>
  void move_points(const OrbitCorrection& correction, double factor, double* states) const;
  template <std::size_t D>
  void change_transitions(double stretched, const double* jacobians, Chain& changed) const;
  /// Of `jacobians` an entry has a row of `row` numbers.
  void take_nodes(const systems::System& system, const double* states, const double* fields, const double* jacobians,
                  std::size_t row, Chain& chain) const;

  Chain _chain;
  std::size_t _dimension;
  SampledLoop _loop;
  // At points within segments, for several of them at a time, [segments][point of the segment][...][lane]:
  Numbers _flows;     ///< transition matrices from the segment's begin
  Numbers _inverses;  ///< and their inverses
  Numbers _drifts;    ///< what residuals add up to, carried to the segment's begin
};

}  // namespace orbweaver::spectrum
