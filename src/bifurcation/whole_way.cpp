#include "whole_way.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

namespace orbweaver::bifurcation {

namespace {

/// The way to an orbit, its modes of unit length, and how long it is.
std::pair<loop::Tangent, double> way_to(const loop::Loop& base, const loop::Loop& orbit) {
  const loop::Loop there = loop::with_cutoff(orbit, base.cutoff);
  loop::Tangent way{there.modes, {orbit.period - base.period}};
  double square = 0.0;
  for (std::size_t n = 0; n < way.modes.size(); ++n) {
    way.modes[n] -= base.modes[n];
    square += way.modes[n] * way.modes[n];
  }
  const double length = std::sqrt(square);
  way *= 1.0 / length;
  return {std::move(way), length};
}

}  // namespace

Direction whole_way(const loop::Loop& base, const loop::Loop& orbit, const std::optional<loop::Loop>& opposite) {
  Direction direction;
  direction.base = loop::with_cutoff(base, std::max(orbit.cutoff, opposite ? opposite->cutoff : 0));
  std::tie(direction.tangent, direction.amplitude) = way_to(direction.base, orbit);
  if (opposite) direction.opposite = way_to(direction.base, *opposite).first;
  return direction;
}

}  // namespace orbweaver::bifurcation
