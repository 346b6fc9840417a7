#include "orbweaver/equations/collocation.hpp"

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "index.hpp"
#include "orbweaver/core/error.hpp"

namespace orbweaver::equations {

loop::Loop Collocation::to_loop(const double* u) const {
  loop::Loop out;
  out.dimension = dimension();
  out.cutoff = _grid.cutoff();
  out.period = u[period_at()];
  out.winding = _winding;
  out.time_map = _map;
  out.modes.resize((2 * at(out.cutoff) + 1) * at(out.dimension));
  _grid.to_modes(u, out.modes.data());
  for (std::size_t i = 0; i < at(out.dimension); ++i) out.modes[i] += _centre[i];
  for (std::size_t n = 0; n < _system.family_scalars().free.size(); ++n)
    out.parameters.push_back(u[period_at() + 1 + static_cast<int>(n)]);
  return out;
}

void Collocation::from_loop(const loop::Loop& loop, double* u) const {
  core::require(loop.time_map == _map, "the loop has another time map than the collocation points");
  std::vector<double> modes = loop.modes;
  for (std::size_t i = 0; i < at(dimension()); ++i) modes[i] -= _centre[i];
  _grid.from_modes(loop.cutoff, modes.data(), u);
  u[period_at()] = loop.period;
  for (int p = 1; p < borders(); ++p) {
    double& value = u[period_at() + p];
    const std::string& name = _scalars[at(p)].parameter;
    if (_scalars[at(p)].kind != loss::Scalar::Kind::parameter)
      value = 0.0;
    else if (at(p) <= loop.parameters.size())
      value = loop.parameters[at(p - 1)];
    else
      value = _system.parameters().at(name) / _system.parameter_scale(name);
  }
}

std::vector<double> Collocation::resampled(const Collocation& from, const std::vector<double>& u) const {
  std::vector<double> out(at(size()), 0.0);
  const int d = dimension();
  const int count = cells() + 1;
  const auto modes = std::make_unique_for_overwrite<double[]>((2 * at(from._grid.cutoff()) + 1) * at(d));
  from._grid.to_modes(u.data(), modes.get());
  if (from._map == _map) {
    _grid.from_modes(from._grid.cutoff(), modes.get(), out.data());
  } else {
    // z at this grid's nodes, which the other map has elsewhere: harmonics by rotation, node by node.
    std::vector<double> turn_cos(at(count)), turn_sin(at(count)), c(at(count), 1.0), s(at(count), 0.0);
    std::vector<double> z(at(d * _grid.stride()), 0.0);
    std::vector<double> here(at(count));
    for (int j = 0; j < count; ++j) here[at(j)] = j * _grid.spacing();
    const std::vector<double> there = from._map.parameters_at(_map, here);
    for (int j = 0; j < count; ++j) {
      turn_cos[at(j)] = std::cos(there[at(j)]);
      turn_sin[at(j)] = std::sin(there[at(j)]);
    }
    for (int k = 0; k <= from._grid.cutoff(); ++k) {
      for (int i = 0; i < d; ++i) {
        const double a = modes[at((k == 0 ? 0 : 2 * k - 1) * d + i)];
        const double b = k == 0 ? 0.0 : modes[at(2 * k * d + i)];
        if (a == 0.0 && b == 0.0) continue;
        double* to = z.data() + i * _grid.stride();
        for (int j = 0; j < count; ++j) to[j] += a * c[at(j)] + b * s[at(j)];
      }
      for (int j = 0; j < count; ++j) {
        const double next = c[at(j)] * turn_cos[at(j)] - s[at(j)] * turn_sin[at(j)];
        s[at(j)] = c[at(j)] * turn_sin[at(j)] + s[at(j)] * turn_cos[at(j)];
        c[at(j)] = next;
      }
    }
    // Where angles turn over, n s changes with the map as well.
    for (int i = 0; i < d; ++i)
      if (_winding[at(i)] != 0.0)
        for (int j = 0; j < count; ++j) z[at(i * _grid.stride() + j)] += _winding[at(i)] * (there[at(j)] - here[at(j)]);
    _grid.from_nodal(z.data(), out.data());
  }
  for (int q = 0; q < borders(); ++q) out[at(period_at() + q)] = u[at(from.period_at() + q)];
  return out;
}

}  // namespace orbweaver::equations
