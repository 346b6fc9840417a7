#include "orbweaver/equations/collocation.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "index.hpp"
#include "orbweaver/numerics/two_pi.hpp"

namespace orbweaver::equations {

namespace {

using numerics::two_pi;

}  // namespace

Collocation::Quality Collocation::quality(const double* u) const {
  const int m = cells();
  const int d = dimension();
  const int stride = _grid.stride();
  const double rate = two_pi / u[period_at()];
  const systems::System& system = system_at(u);
  midpoint_states(u);
  system.field(at(m), _z.data(), _f.data());
  double loss = 0.0;
  double speed = 0.0;
  for (int j = 0; j < m; ++j) {
    double square = 0.0;
    double moved = 0.0;
    for (int i = 0; i < d; ++i) {
      const double* y = u + i * stride;
      const double f = _f[at(i * m + j)];
      const double r = rate / _density[at(j)] * ((y[j + 1] - y[j]) / _grid.spacing() + _winding[at(i)]) - f;
      square += r * r;
      moved += f * f;
    }
    loss += _density[at(j)] * square / m;
    speed += _density[at(j)] * moved / m;
  }
  double amplitude = 0.0;
  double size = 0.0;
  for (int i = 0; i < d; ++i) {
    double mean = 0.0;
    double square = 0.0;
    for (int j = 0; j < m; ++j) {
      const double z = _z[at(i * m + j)] - _centre[at(i)] - _winding[at(i)] * (j + 0.5) * _grid.spacing();
      mean += _density[at(j)] * z / m;
      square += _density[at(j)] * z * z / m;
    }
    // Over the whole loop the mean survives in coordinates that the symmetries leave alone.
    if (!keeps_mean(i)) mean = 0.0;
    amplitude += std::max(0.0, square - mean * mean);
    size += square + (2.0 * mean + _centre[at(i)]) * _centre[at(i)];
  }
  // The loop between the points where it was solved.
  node_states(u);
  const int count = m + 1;
  std::vector<double>& f = _node_field;
  f.resize(at(d * count));
  system.field(at(count), _nodal.data(), f.data());
  double between = 0.0;
  for (int j = 0; j < count; ++j) {
    double square = 0.0;
    for (int i = 0; i < d; ++i) {
      const double r =
          rate / _node_density[at(j)] * (_slope[at(i * stride + j)] + _winding[at(i)]) - f[at(i * count + j)];
      square += r * r;
    }
    between += _node_density[at(j)] * _node_weights[at(j)] * square;
  }
  return {std::sqrt(0.5 * (loss + between)),
          std::sqrt(loss),
          std::sqrt(between),
          std::sqrt(speed),
          std::sqrt(amplitude),
          std::sqrt(size)};
}

double Collocation::distance(const double* a, const double* b) const {
  const int m = cells();
  std::vector<double>& difference = _difference;
  difference.resize(at(dimension() * _grid.stride()));
  for (std::size_t q = 0; q < difference.size(); ++q) difference[q] = a[q] - b[q];
  _grid.to_midpoints(difference.data(), _z.data());
  double square = 0.0;
  for (int i = 0; i < dimension(); ++i)
    for (int j = 0; j < m; ++j) square += _density[at(j)] * _z[at(i * m + j)] * _z[at(i * m + j)] / m;
  double apart = std::hypot(std::sqrt(square), (a[period_at()] - b[period_at()]) / b[period_at()]);
  for (std::size_t n = 0; n < _system.family_scalars().free.size(); ++n) {
    const int p = period_at() + 1 + static_cast<int>(n);
    apart = std::hypot(apart, a[p] - b[p]);
  }
  return apart;
}

double Collocation::action(const double* u) const {
  const int m = cells();
  const auto d = at(dimension());
  const systems::System& system = system_at(u);
  midpoint_states(u);
  std::vector<double> state(d);
  double sum = 0.0;
  for (int j = 0; j < m; ++j) {
    for (std::size_t i = 0; i < d; ++i) state[i] = _z[i * at(m) + at(j)];
    sum += _density[at(j)] * system.action_density(state);
  }
  return u[period_at()] * sum / m;
}

}  // namespace orbweaver::equations
