#pragma once

#include <array>
#include <cstddef>

#include "orbweaver/ad/lanes.hpp"

namespace orbweaver::spectrum {

/// Constants of the two-point Hermite step over an interval of length 1 for dY/dt = A(t) Y (Obreshkov; Hairer, Norsett
/// and Wanner 1993, II.13): the Taylor coefficients C_k of Y at both ends, k <= n, satisfy
///   sum_k (-1)^k k! beta_k C_k(1) Y(1) = sum_k k! beta_k C_k(0) Y(0) + O(h^(2n+1)),
/// exp's Pade approximation of degree n. Those of A come from its values at points that divide the intervals equally.
struct HermiteRule {
  static constexpr std::size_t terms = 8;   ///< n
  static constexpr std::size_t reach = 12;  ///< points to either side from which Taylor coefficients are made
  static constexpr std::size_t parts = 4;   ///< of an interval, between points
  static constexpr std::size_t fast_reach = 8;
  static constexpr double fastest = 2.7;  ///< leaves 2 % of such a wave's integral, and less of slower ones'
  static constexpr std::size_t levels = 3;  ///< n, n - 1 and n - 2: what they differ by tells the error

  /// [j][k]: share of A(k) + A(-k), j even (A(0) alone for k = 0), or of A(k) - A(-k), j odd, in coefficient j of A.
  std::array<std::array<ad::Lanes, reach + 1>, terms> stencil;
  /// [k]: share of A(k) + A(-k), and of A(k) - A(-k), in what Y(1) would change by without the farthest points.
  std::array<ad::Lanes, reach + 1> even_change;
  std::array<ad::Lanes, reach + 1> odd_change;
  /// [k - 1]: share of r(k) - r(-k), k points away, in what the trapezoidal sum up to a point leaves of the integral of
  /// r; fitted to waves of up to `fastest` radians a point.
  std::array<ad::Lanes, fast_reach> fast;
  /// [level][k]: k! beta_k.
  std::array<std::array<ad::Lanes, terms + 1>, levels> ends;

  HermiteRule();  // all as registers hold them, the same in every lane
};

/// Made once a process.
[[nodiscard]] const HermiteRule& hermite_rule();

}  // namespace orbweaver::spectrum
