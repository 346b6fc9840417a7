#include "orbweaver/loss/linearization.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "orbweaver/core/error.hpp"
#include "orbweaver/core/log/log_stage.hpp"
#include "orbweaver/loop/curve/measures.hpp"
#include "orbweaver/loop/curve/system_at.hpp"

namespace orbweaver::loss {

namespace {

int valid_nodes_for(const loop::Loop& loop) {
  loop::validate(loop);
  return loop::nodes_for(loop);
}

}  // namespace

Linearization::Linearization(const systems::System& family, const loop::Loop& loop, Order order,
                             std::span<const Scalar> scalars)
    : _nodes(valid_nodes_for(loop)),
      _dimension(loop.dimension),
      _cutoff(loop.cutoff),
      _order(order),
      _period(loop.period),
      _rate(2.0 * std::numbers::pi / loop.period),
      _grid(&loop::FourierGrid::of_size(_nodes)),
      _evenly(loop.time_map.is_identity()),
      _density(loop::densities(loop.time_map, _nodes)),
      _scale(_density.size()) {
  const core::LogEvent event(order == Order::residual ? core::Event::residual : core::Event::jacobian);
  core::require(family.dimension() == loop.dimension, "the loop's dimension is not the system's");
  const std::shared_ptr<const systems::System> here = loop::system_at(family, loop);
  const systems::System& system = *here;
  const auto n = static_cast<std::size_t>(_nodes);
  const auto d = static_cast<std::size_t>(_dimension);
  for (std::size_t j = 0; j < n; ++j) {
    core::require(_density[j] > 0.0, "the loop's time map must run forward everywhere");
    _scale[j] = std::sqrt(_density[j] / _nodes);
  }
  _z.resize(d * n);
  _slope.resize(d * n);
  _grid->synthesize(_cutoff, _dimension, loop.modes.data(), _z.data());
  _grid->synthesize_derivative(_cutoff, _dimension, loop.modes.data(), _slope.data());
  for (std::size_t i = 0; i < d; ++i) {
    if (loop.winding[i] == 0.0) continue;
    for (std::size_t j = 0; j < n; ++j) {
      _z[i * n + j] += loop.winding[i] * 2.0 * std::numbers::pi * static_cast<double>(j) / _nodes;
      _slope[i * n + j] += loop.winding[i];
    }
  }
  if (!_evenly)
    for (std::size_t i = 0; i < d; ++i)
      for (std::size_t j = 0; j < n; ++j) _slope[i * n + j] /= _density[j];
  std::vector<double> f(d * n);
  if (order == Order::residual) {
    const core::LogEvent field(core::Event::field);
    system.field(n, _z.data(), f.data());
  } else {
    _a.resize(d * d * n);
    {
      const core::LogEvent field(core::Event::field);
      system.field_jacobian(n, _z.data(), f.data(), _a.data());
    }
    check_finite(system, loop, _a, "Jacobian");
  }
  check_finite(system, loop, f, "vector field");
  _r.resize(d * n);
  for (std::size_t m = 0; m < d * n; ++m) _r[m] = _rate * _slope[m] - f[m];
  double sum = 0.0;
  for (std::size_t i = 0; i < d; ++i)
    for (std::size_t j = 0; j < n; ++j) sum += _density[j] * _r[i * n + j] * _r[i * n + j];
  _loss = sum / _nodes;
  if (order == Order::second) {
    _s.resize(d * d * n);
    system.second_derivatives(n, _z.data(), _r.data(), _s.data());
    check_finite(system, loop, _s, "second derivative");
  }
  if (order == Order::residual) return;
  for (const Scalar& scalar : scalars) {
    if (scalar.kind == Scalar::Kind::period) continue;
    std::vector<double> column(d * n);
    if (scalar.kind == Scalar::Kind::parameter)
      system.parameter_derivatives(scalar.parameter, n, _z.data(), column.data());
    else
      system.conserved_gradients(scalar.quantity, n, _z.data(), column.data());
    check_finite(system, loop, column, "derivative by a scalar");
    _columns.emplace_back(scalar, std::move(column));
  }
}

const std::vector<double>& Linearization::column(const Scalar& scalar) const {
  const auto found =
      std::find_if(_columns.begin(), _columns.end(), [&](const auto& entry) { return entry.first == scalar; });
  core::require(found != _columns.end(), "this linearization was made without one of the scalars of the unknowns");
  return found->second;
}

template <class Use>
void Linearization::for_each_column(const Unknowns& unknowns, const Use& use) const {
  for (std::size_t n = 0; n < unknowns.scalars.size(); ++n)
    if (unknowns.scalars[n].kind != Scalar::Kind::period)
      use(static_cast<std::size_t>(unknowns.subspace.size()) + n, column(unknowns.scalars[n]));
}

void Linearization::check_finite(const systems::System& system, const loop::Loop& loop, std::span<const double> values,
                                 const char* what) const {
  const auto bad = std::find_if(values.begin(), values.end(), [](double v) { return !std::isfinite(v); });
  if (bad == values.end()) return;
  const auto n = static_cast<std::size_t>(_nodes);
  const std::size_t node = static_cast<std::size_t>(bad - values.begin()) % n;
  std::vector<double> state(static_cast<std::size_t>(_dimension));
  for (std::size_t i = 0; i < state.size(); ++i) state[i] = _z[i * n + node];
  const double turns = loop.time_map.phase(2.0 * std::numbers::pi * static_cast<double>(node) / _nodes);
  throw not_finite(system, what, *bad, _period * turns / (2.0 * std::numbers::pi), _period, state);
}

core::NotFiniteError not_finite(const systems::System& system, std::string_view what, double value, double t,
                                double period, std::span<const double> state) {
  std::vector<double> in_units(state.begin(), state.end());
  for (std::size_t i = 0; i < in_units.size(); ++i) in_units[i] *= system.scales().coordinate(i);
  const double time = system.scales().time;
  return core::NotFiniteError(fmt::format(
      "the {} of {} is not finite ({}) at t = {:.6g} of a loop with T = {:.6g}, state ({:.6g}); the loop left the "
      "region where the system is defined: start from another guess or take smaller steps",
      what, system.info().name, value, t * time, period * time, fmt::join(in_units, ", ")));
}

void Linearization::require_order(Order order) const {
  core::require(static_cast<int>(_order) >= static_cast<int>(order),
                "this linearization was made with too low an order");
}

std::vector<double> Linearization::residual() const {
  std::vector<double> out = _r;
  for (std::size_t m = 0; m < out.size(); ++m) out[m] *= _scale[m % _scale.size()];
  return out;
}

std::vector<double> Linearization::perturbation(const Unknowns& unknowns, std::span<const double> v) const {
  core::require(static_cast<int>(v.size()) == unknowns.size(), "one value an unknown is needed");
  std::vector<double> modes((2 * static_cast<std::size_t>(_cutoff) + 1) * static_cast<std::size_t>(_dimension), 0.0);
  unknowns.subspace.add_to(v.first(static_cast<std::size_t>(unknowns.subspace.size())), modes);
  return modes;
}

std::vector<double> Linearization::apply_jacobian(const Unknowns& unknowns, std::span<const double> v) const {
  require_order(Order::jacobian);
  const std::vector<double> modes = perturbation(unknowns, v);
  const auto n = static_cast<std::size_t>(_nodes);
  const auto d = static_cast<std::size_t>(_dimension);
  std::vector<double> dz(d * n);
  std::vector<double> out(d * n);
  _grid->synthesize(_cutoff, _dimension, modes.data(), dz.data());
  _grid->synthesize_derivative(_cutoff, _dimension, modes.data(), out.data());
  const double dt =
      unknowns.has_period() ? -_rate / _period * v[static_cast<std::size_t>(unknowns.subspace.size())] : 0.0;
  for (std::size_t i = 0; i < d; ++i) {
    double* row = out.data() + i * n;
    const double* slope_i = _slope.data() + i * n;
    for (std::size_t j = 0; j < n; ++j) row[j] = _rate * row[j] / _density[j] + dt * slope_i[j];
    for (std::size_t l = 0; l < d; ++l) {
      const double* a = _a.data() + (i * d + l) * n;
      const double* z = dz.data() + l * n;
      for (std::size_t j = 0; j < n; ++j) row[j] -= a[j] * z[j];
    }
    for_each_column(unknowns, [&](std::size_t at, const std::vector<double>& column) {
      for (std::size_t j = 0; j < n; ++j) row[j] -= v[at] * column[i * n + j];
    });
    for (std::size_t j = 0; j < n; ++j) row[j] *= _scale[j];
  }
  return out;
}

// sum over nodes of with_slope . (d/ds basis) + with_value . basis, for every basis vector of the subspace.
std::vector<double> Linearization::project_adjoint(const Unknowns& unknowns, const std::vector<double>& with_slope,
                                                   const std::vector<double>& with_value) const {
  const auto n = static_cast<std::size_t>(_nodes);
  const auto d = static_cast<std::size_t>(_dimension);
  const auto highest = static_cast<std::size_t>(_cutoff);
  std::vector<double> modes((2 * highest + 1) * d);
  std::vector<double> c(highest + 1);
  std::vector<double> s(highest + 1);
  for (std::size_t i = 0; i < d; ++i) {
    _grid->sums(with_value.data() + i * n, _cutoff, c.data(), s.data());
    modes[i] = c[0];
    for (std::size_t k = 1; k <= highest; ++k) {
      modes[(2 * k - 1) * d + i] = c[k];
      modes[2 * k * d + i] = s[k];
    }
    _grid->sums(with_slope.data() + i * n, _cutoff, c.data(), s.data());
    for (std::size_t k = 1; k <= highest; ++k) {
      modes[(2 * k - 1) * d + i] -= static_cast<double>(k) * s[k];
      modes[2 * k * d + i] += static_cast<double>(k) * c[k];
    }
  }
  std::vector<double> out(static_cast<std::size_t>(unknowns.size()), 0.0);
  unknowns.subspace.project(modes, std::span(out).first(static_cast<std::size_t>(unknowns.subspace.size())));
  return out;
}

std::vector<double> Linearization::apply_jacobian_transposed(const Unknowns& unknowns,
                                                             std::span<const double> y) const {
  require_order(Order::jacobian);
  core::require(static_cast<int>(y.size()) == rows(), "one value a residual is needed");
  const auto n = static_cast<std::size_t>(_nodes);
  const auto d = static_cast<std::size_t>(_dimension);
  std::vector<double> with_slope(d * n);
  std::vector<double> with_value(d * n, 0.0);
  std::vector<double> scaled(n);
  double along_slope = 0.0;
  for (std::size_t i = 0; i < d; ++i) {
    for (std::size_t j = 0; j < n; ++j) {
      scaled[j] = _scale[j] * y[i * n + j];
      with_slope[i * n + j] = _rate * scaled[j] / _density[j];
      along_slope += scaled[j] * _slope[i * n + j];
    }
    for (std::size_t l = 0; l < d; ++l) {
      const double* a = _a.data() + (i * d + l) * n;
      for (std::size_t j = 0; j < n; ++j) with_value[l * n + j] -= a[j] * scaled[j];
    }
  }
  std::vector<double> out = project_adjoint(unknowns, with_slope, with_value);
  if (unknowns.has_period()) out[static_cast<std::size_t>(unknowns.subspace.size())] = -_rate / _period * along_slope;
  for_each_column(unknowns, [&](std::size_t at, const std::vector<double>& column) {
    for (std::size_t i = 0; i < d; ++i)
      for (std::size_t j = 0; j < n; ++j) out[at] -= _scale[j] * y[i * n + j] * column[i * n + j];
  });
  return out;
}

std::vector<double> Linearization::gradient(const Unknowns& unknowns) const {
  std::vector<double> g = apply_jacobian_transposed(unknowns, residual());
  for (double& value : g) value *= 2.0;
  return g;
}

std::vector<double> Linearization::apply_hessian(const Unknowns& unknowns, std::span<const double> v,
                                                 Curvature curvature) const {
  std::vector<double> out = apply_jacobian_transposed(unknowns, apply_jacobian(unknowns, v));
  if (curvature == Curvature::full) {
    require_order(Order::second);
    core::require(unknowns.size() == unknowns.subspace.size() + (unknowns.has_period() ? 1 : 0),
                  "the full curvature knows no scalar but T: take Gauss and Newton's");
    const std::vector<double> modes = perturbation(unknowns, v);
    const auto n = static_cast<std::size_t>(_nodes);
    const auto d = static_cast<std::size_t>(_dimension);
    std::vector<double> dz(d * n);
    std::vector<double> dslope(d * n);
    _grid->synthesize(_cutoff, _dimension, modes.data(), dz.data());
    _grid->synthesize_derivative(_cutoff, _dimension, modes.data(), dslope.data());
    const double mean = 1.0 / _nodes;
    const double dt = unknowns.has_period() ? v.back() : 0.0;
    const double cross = -_rate / _period * mean;
    std::vector<double> with_slope(d * n);
    std::vector<double> with_value(d * n, 0.0);
    double period_entry = 0.0;
    const double bend = 2.0 * _rate / (_period * _period) * mean * dt;
    for (std::size_t i = 0; i < d; ++i)
      for (std::size_t j = 0; j < n; ++j) {  // the weight of a node and the 1 / w of dz' cancel
        const std::size_t m = i * n + j;
        with_slope[m] = cross * dt * _r[m];
        period_entry += _r[m] * (cross * dslope[m] + bend * _density[j] * _slope[m]);
      }
    for (std::size_t l = 0; l < d; ++l)
      for (std::size_t m = 0; m < d; ++m) {
        const double* s = _s.data() + (l * d + m) * n;
        for (std::size_t j = 0; j < n; ++j) with_value[l * n + j] -= mean * _density[j] * s[j] * dz[m * n + j];
      }
    const std::vector<double> second = project_adjoint(unknowns, with_slope, with_value);
    for (std::size_t m = 0; m < out.size(); ++m) out[m] += second[m];
    if (unknowns.has_period()) out.back() += period_entry;
  }
  for (double& value : out) value *= 2.0;
  return out;
}

}  // namespace orbweaver::loss
