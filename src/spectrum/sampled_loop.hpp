#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "hermite_rule.hpp"
#include "orbweaver/ad/lanes.hpp"
#include "orbweaver/loop/curve/loop.hpp"
#include "orbweaver/systems/system.hpp"

namespace orbweaver::spectrum {

/// For so many numbers, which are not set.
using Numbers = std::unique_ptr<double[]>;
[[nodiscard]] Numbers numbers(std::size_t count);

/// A loop and its linearised flow, dY/ds = t'(s) A(z(s)) Y, at points that are equal in s: HermiteRule::parts of them a
/// segment. Those of one place within their segments lie side by side, so that lanes hold several segments.
struct SampledLoop {
  static constexpr std::size_t wide = ad::Lanes::width;
  static constexpr std::size_t parts = HermiteRule::parts;
  static constexpr double part = 1.0 / static_cast<double>(parts);  ///< of a segment
  /// Segments beyond both ends that the first and last nodes reach into.
  static constexpr std::size_t guards = (HermiteRule::reach + parts - 1) / parts;

  SampledLoop() = default;
  /// `around` segments a period, those of one of `order` equal parts of it. Throws core::NotFiniteError if field or
  /// Jacobian is not finite.
  SampledLoop(const systems::System& system, const loop::Loop& loop, int order, int around);

  /// Takes what trapezoidal sums miss out of the residuals, into `fast`.
  void split_residuals();

  std::size_t dimension = 0;
  std::size_t segments = 0;
  std::size_t stride = 0;       ///< segments with guards, filled up to whole lanes
  std::size_t points = 0;       ///< stride times the points of a segment
  double largest_rate = 0.0;    ///< largest h |A| of a segment
  double wanted = 0.0;          ///< segments a period that the rates ask for
  std::vector<char> vanishes;   ///< the entries of A that are 0 all along
  // [...][point of the segment][segment]:
  Numbers states;
  Numbers fields;
  Numbers jacobians;  ///< t' A, in segments
  Numbers node_jacobians;  ///< A itself, of the first points of segments: [...][segment]
  Numbers rates;      ///< dt/ds, in segments
  Numbers residuals;  ///< dz/ds less what the field says, in segments
  Numbers fast;       ///< what trapezoidal sums leave of the orbit's distance to the loop

 private:
  template <std::size_t D>
  void take_rates(int order, int around);
  template <std::size_t D>
  void split();
};

}  // namespace orbweaver::spectrum
