#include "orbweaver/loop/curve/tangent.hpp"

#include <algorithm>
#include <cmath>

#include "orbweaver/core/error.hpp"

namespace orbweaver::loop {

double Tangent::norm() const { return std::sqrt(dot(*this, *this)); }

void Tangent::normalize() {
  const double length = norm();
  core::require(length > 0.0, "a tangent of length 0 has no direction");
  for (double& v : modes) v /= length;
  for (double& v : scalars) v /= length;
}

Tangent& Tangent::operator*=(double factor) {
  for (double& v : modes) v *= factor;
  for (double& v : scalars) v *= factor;
  return *this;
}

double dot(const Tangent& a, const Tangent& b) {
  core::require(a.modes.size() == b.modes.size(), "tangents of different cutoffs have no inner product");
  double sum = 0.0;
  for (std::size_t n = 0; n < std::min(a.scalars.size(), b.scalars.size()); ++n) sum += a.scalars[n] * b.scalars[n];
  for (std::size_t n = 0; n < a.modes.size(); ++n) sum += a.modes[n] * b.modes[n];
  return sum;
}

Tangent with_cutoff(Tangent tangent, int cutoff, int dimension) {
  tangent.modes.resize((2 * static_cast<std::size_t>(cutoff) + 1) * static_cast<std::size_t>(dimension), 0.0);
  return tangent;
}

Tangent with_time_map(const Loop& at, const Tangent& tangent, const TimeMap& map, int cutoff) {
  return {with_time_map(perturbation(at, tangent), map, cutoff).modes, tangent.scalars};
}

Tangent repeated(const Loop& at, const Tangent& tangent, int times) {
  Tangent out{repeated(perturbation(at, tangent), times).modes, tangent.scalars};
  if (!out.scalars.empty()) out.scalars.front() *= times;
  return out;
}

Loop perturbation(const Loop& at, const Tangent& tangent) {
  Loop out = at;
  out.modes = tangent.modes;
  std::fill(out.winding.begin(), out.winding.end(), 0.0);
  return out;
}

Loop moved(Loop base, const Tangent& tangent, double step) {
  core::require(base.modes.size() == tangent.modes.size(), "a loop moves along a tangent of its own cutoff");
  for (std::size_t n = 0; n < base.modes.size(); ++n) base.modes[n] += step * tangent.modes[n];
  base.period += step * tangent.period();
  for (std::size_t n = 0; n < base.parameters.size() && n + 1 < tangent.scalars.size(); ++n)
    base.parameters[n] += step * tangent.scalars[n + 1];
  return base;
}

double change_at_start(const Loop& at, const Tangent& tangent) {
  double square = 0.0;
  for (const double v : state_at(perturbation(at, tangent), 0.0)) square += v * v;
  return std::sqrt(square);
}

}  // namespace orbweaver::loop
