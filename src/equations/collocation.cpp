#include "orbweaver/equations/collocation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "box_scheme.hpp"
#include "dense_factor.hpp"
#include "fitted_cells.hpp"
#include "index.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/core/log/log_stage.hpp"
#include "orbweaver/loss/linearization.hpp"
#include "orbweaver/numerics/two_pi.hpp"
#include "shell_gmres.hpp"

namespace orbweaver::equations {

namespace {

using numerics::two_pi;

/// Of the right side: across a gap of 1e-8 what a residual leaves is magnified as much.
constexpr double of_linear_residual = 1e-10;
/// In parts of what rounding leaves of a residual: one that rounding explains. Those of solved equations were seen at
/// 0.25 to 2, those beside a narrow gap at 4 to 4000 (mu = 0.001, 13 turns).
constexpr double explained = 3.0;

}  // namespace

std::vector<loss::Scalar> Collocation::scalars_of_families(const systems::System& system,
                                                           const loop::FundamentalDomain& domain) {
  std::vector<loss::Scalar> scalars{loss::Scalar::period()};
  for (const std::string& name : system.family_scalars().free) scalars.push_back(loss::Scalar::of_parameter(name));
  if (system.structure().conservative() && !domain.reversor) scalars.push_back(loss::Scalar::unfolding());
  return scalars;
}

int Collocation::conditions_of_families(const systems::System& system, const loop::FundamentalDomain& domain) {
  const int holds = system.family_scalars().hold == systems::FamilyScalars::Hold::nothing ? 0 : 1;
  return 1 + holds + (domain.reversor ? 0 : 1);
}

bool Collocation::applies(const systems::System& system, const loop::FundamentalDomain& domain, int places) {
  const int conditions = conditions_of_families(system, domain) + places - 1;
  return domain.is_square() && static_cast<int>(scalars_of_families(system, domain).size()) == conditions;
}

Collocation::Collocation(const systems::System& system, const loop::FundamentalDomain& domain,
                         std::vector<double> centre, std::vector<double> winding, int cells, const loop::TimeMap& map,
                         std::vector<loss::Scalar> scalars)
    : _system(system),
      _grid(loop::StaggeredGrid::shared(domain, cells)),
      _map(map),
      _centre(std::move(centre)),
      _winding(std::move(winding)),
      _scalars(scalars.empty() ? scalars_of_families(system, domain) : std::move(scalars)),
      _keeps_mean(domain.coordinates_with_mean()),
      _ends(domain.ends()),
      _projection(domain.projection) {
  core::require(cells % BoxScheme::lanes == 0, "the cells of a domain must fill the lanes of the box scheme");
  core::require(_scalars.front().kind == loss::Scalar::Kind::period, "collocation solves for T");
  const double h = _grid.spacing();
  _density.resize(at(cells));
  _node_density.resize(at(cells + 1));
  for (int j = 0; j < cells; ++j) _density[at(j)] = _map.density((j + 0.5) * h);
  for (int j = 0; j <= cells; ++j) _node_density[at(j)] = _map.density(j * h);
  _node_weights.assign(at(_grid.stride()), 0.0);
  const bool mirrored = domain.reversor.has_value();
  for (int j = 0; j <= cells; ++j) {
    const double share = mirrored ? (j == 0 || j == cells ? 0.5 : 1.0) : (j < cells ? 1.0 : 0.0);
    _node_weights[at(j)] = share / cells;
  }
  const std::size_t d = at(dimension());
  _z.resize(d * at(cells));
  _f.resize(d * at(cells));
  _gradient.resize(d * at(cells));
  _blocks.resize(d * d * at(cells));
  _columns.resize(at(borders()) * d * at(_grid.stride()));
  _nodal.resize(d * at(_grid.stride()));
  _slope.resize(d * at(_grid.stride()));
  _weights.assign(at(borders() * size()), 0.0);
  _reference.assign(at(size()), 0.0);
}

Collocation::~Collocation() = default;

// Where a family crosses one of less symmetry the equations are singular across the projection's kernel, and the
// rounding that a solve multiplies there would leave the symmetry.
void Collocation::keep_symmetries(double* v) const {
  if (!_projection) return;
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  Eigen::Map<Rows> nodes(v, dimension(), _grid.stride());
  nodes = (*_projection * nodes).eval();
}

void Collocation::set_conditions(std::span<const double> weights, std::span<const double> reference) {
  core::require(weights.size() == _weights.size() && reference.size() == _reference.size(),
                "conditions of another size than the points they are for");
  std::copy(weights.begin(), weights.end(), _weights.begin());
  std::copy(reference.begin(), reference.end(), _reference.begin());
}

bool Collocation::keeps_mean(int coordinate) const { return _keeps_mean[at(coordinate)]; }

const systems::System& Collocation::system_at(const double* u) const {
  std::map<std::string, double> values;
  for (int p = 1; p < borders(); ++p)
    if (_scalars[at(p)].kind == loss::Scalar::Kind::parameter) {
      const std::string& name = _scalars[at(p)].parameter;
      values[name] = u[period_at() + p] * _system.parameter_scale(name);
    }
  if (values.empty()) return _system;
  _moved = _system.with_parameters(values);
  return *_moved;
}

void Collocation::derivatives_by(const systems::System& system, const loss::Scalar& scalar) const {
  if (scalar.kind == loss::Scalar::Kind::parameter)
    system.parameter_derivatives(scalar.parameter, at(cells()), _z.data(), _gradient.data());
  else
    system.conserved_gradients(scalar.quantity, at(cells()), _z.data(), _gradient.data());
}

void Collocation::midpoint_states(const double* u) const {
  const int m = cells();
  _grid.to_midpoints(u, _z.data());
  for (int i = 0; i < dimension(); ++i) {
    double* z = _z.data() + i * m;
    const double centre = _centre[at(i)];
    const double winding = _winding[at(i)];
    if (winding == 0.0) {
      for (int j = 0; j < m; ++j) z[j] += centre;
    } else {
      for (int j = 0; j < m; ++j) z[j] += centre + winding * (j + 0.5) * _grid.spacing();
    }
  }
}

/// z at the nodes into _nodal, without gaps, and its derivative by s into _slope, without winding.
void Collocation::node_states(const double* u) const {
  const int count = cells() + 1;
  const int stride = _grid.stride();
  _grid.at_nodes(u, _nodal.data(), _slope.data());
  for (int i = 0; i < dimension(); ++i)
    for (int j = 0; j < count; ++j)
      _nodal[at(i * count + j)] = _nodal[at(i * stride + j)] + _centre[at(i)] + _winding[at(i)] * j * _grid.spacing();
}

void Collocation::residual(const double* u, double* r) const {
  const core::LogEvent event(core::Event::residual);
  const int m = cells();
  const int d = dimension();
  const int stride = _grid.stride();
  const systems::System& system = system_at(u);
  midpoint_states(u);
  system.field(at(m), _z.data(), _f.data());
  const double scale = _grid.spacing() * u[period_at()] / two_pi;
  for (int p = 1; p < borders(); ++p) {
    if (_scalars[at(p)].kind != loss::Scalar::Kind::unfolding) continue;
    const double mu = u[period_at() + p];
    derivatives_by(system, _scalars[at(p)]);
    for (std::size_t q = 0; q < _f.size(); ++q) _f[q] += mu * _gradient[q];
  }
  for (int i = 0; i < d; ++i) {
    const double* y = u + i * stride;
    const double* f = _f.data() + i * m;
    double* out = r + i * stride;
    const double turning = _winding[at(i)] * _grid.spacing();
    for (int j = 0; j < m; ++j) out[j] = y[j + 1] - y[j] + turning - scale * _density[at(j)] * f[j];
    double end = 0.0;
    for (int l = 0; l < d; ++l) end += _ends.left(i, l) * u[l * stride] + _ends.right(i, l) * u[l * stride + m];
    out[m] = end;
    for (int j = m + 1; j < stride; ++j) out[j] = 0.0;
  }
  const Eigen::Map<const Eigen::VectorXd> point(u, size());
  const Eigen::Map<const Eigen::VectorXd> reference(_reference.data(), size());
  for (int q = 0; q < borders(); ++q) {
    const Eigen::Map<const Eigen::VectorXd> weights(_weights.data() + q * size(), size());
    r[period_at() + q] = weights.dot(point - reference);
  }
}

void Collocation::apply_jacobian(const double* v, double* r) const {
  const int m = cells();
  const int d = dimension();
  const int stride = _grid.stride();
  _grid.to_midpoints(v, _z.data());
  for (int i = 0; i < d; ++i) {
    const double* y = v + i * stride;
    double* out = r + i * stride;
    for (int j = 0; j < m; ++j) {
      out[j] = y[j + 1] - y[j];
      for (int l = 0; l < d; ++l) out[j] -= _blocks[at((i * d + l) * m + j)] * _z[at(l * m + j)];
      for (int p = 0; p < borders(); ++p) out[j] += _columns[at((p * d + i) * stride + j)] * v[period_at() + p];
    }
    double end = 0.0;
    for (int l = 0; l < d; ++l) end += _ends.left(i, l) * v[l * stride] + _ends.right(i, l) * v[l * stride + m];
    out[m] = end;
    for (int j = m + 1; j < stride; ++j) out[j] = 0.0;
  }
  const Eigen::Map<const Eigen::VectorXd> perturbation(v, size());
  for (int q = 0; q < borders(); ++q)
    r[period_at() + q] = Eigen::Map<const Eigen::VectorXd>(_weights.data() + q * size(), size()).dot(perturbation);
}

void Collocation::check_field(const double* u) const {
  const systems::System& system = system_at(u);
  const double period = u[period_at()];
  std::vector<double> f;
  std::vector<double> jacobian;
  const auto check = [&](const std::vector<double>& values, const char* what, const std::vector<double>& z,
                         std::size_t count, double first) {
    const auto bad = std::find_if(values.begin(), values.end(), [](double v) { return !std::isfinite(v); });
    if (bad == values.end()) return;
    const std::size_t j = static_cast<std::size_t>(bad - values.begin()) % count;
    std::vector<double> state;
    for (std::size_t i = 0; i < at(dimension()); ++i) state.push_back(z[i * count + j]);
    const double s = (static_cast<double>(j) + first) * _grid.spacing();
    throw loss::not_finite(system, what, *bad, period * _map.phase(s) / two_pi, period, state);
  };
  const auto m = at(cells());
  midpoint_states(u);
  f.resize(at(dimension()) * m);
  jacobian.resize(at(dimension()) * f.size());
  system.field_jacobian(m, _z.data(), f.data(), jacobian.data());
  check(f, "vector field", _z, m, 0.5);
  check(jacobian, "Jacobian", _z, m, 0.5);
  node_states(u);
  f.resize(at(dimension()) * (m + 1));
  system.field(m + 1, _nodal.data(), f.data());
  check(f, "vector field", _nodal, m + 1, 0.0);
}

void Collocation::factor(const double* u) {
  const core::LogEvent event(core::Event::factor);
  _exact.reset();
  _gmres.reset();
  const int m = cells();
  const int d = dimension();
  const int stride = _grid.stride();
  const systems::System& system = system_at(u);
  midpoint_states(u);
  system.field_jacobian(at(m), _z.data(), _f.data(), _blocks.data());
  const double period = u[period_at()];
  const double scale = _grid.spacing() * period / two_pi;
  double square = 0.0;
  for (int e = 0; e < d * d; ++e) {
    double* block = _blocks.data() + e * m;
    for (int j = 0; j < m; ++j) {
      square += block[j] * block[j];
      block[j] *= scale * _density[at(j)];
    }
  }
  _jacobian_rms = std::sqrt(square / m);
  for (int i = 0; i < d; ++i)
    for (int j = 0; j < m; ++j) {
      const double c = scale * _density[at(j)];
      _columns[at(i * stride + j)] = -c * _f[at(i * m + j)] / period;
    }
  for (int p = 1; p < borders(); ++p) {
    derivatives_by(system, _scalars[at(p)]);
    for (int i = 0; i < d; ++i)
      for (int j = 0; j < m; ++j) {
        const double c = scale * _density[at(j)];
        _columns[at((p * d + i) * stride + j)] = -c * _gradient[at(i * m + j)];
      }
  }
  if (_preconditioner == Preconditioner::exact) return factor_jacobian();
  const std::vector<double> fitted =
      _preconditioner == Preconditioner::box ? std::vector<double>{} : fitted_cells(_blocks.data(), d, m, 1.0);
  factor_box(fitted.empty() ? _blocks.data() : fitted.data());
  if (_preconditioner == Preconditioner::krylov) begin_gmres(u);
}

bool Collocation::has_cells_to_fit() const {
  return _jacobian_rms > 0.0 && !fitted_cells(_blocks.data(), dimension(), cells(), 1.0).empty();
}

void Collocation::factor_box(const double* blocks) {
  const int m = cells();
  const int d = dimension();
  const int stride = _grid.stride();
  BoxScheme::Matrices matrices;
  matrices.cells = m;
  matrices.count = m;
  matrices.column_stride = stride;
  matrices.stride = stride;
  matrices.blocks = blocks;
  matrices.columns = _columns.data();
  matrices.borders = borders();
  matrices.left = _ends.left;
  matrices.right = _ends.right;
  std::vector<double> rows(at(borders() * d * stride));
  std::vector<double> corner(at(borders() * borders()));
  for (int q = 0; q < borders(); ++q) {
    std::copy_n(_weights.data() + q * size(), d * stride, rows.data() + q * d * stride);
    for (int p = 0; p < borders(); ++p) corner[at(q * borders() + p)] = _weights[at(q * size() + period_at() + p)];
  }
  matrices.rows = rows.data();
  matrices.corner = corner.data();
  if (!_box) _box = BoxScheme::of_dimension(dimension(), BoxScheme::Storage::lanes);
  _box->factor(matrices);
}

void Collocation::factor_jacobian() {
  std::vector<int> entries;  // without what fills the strides
  for (int i = 0; i < dimension(); ++i)
    for (int j = 0; j <= cells(); ++j) entries.push_back(i * _grid.stride() + j);
  for (int q = 0; q < borders(); ++q) entries.push_back(period_at() + q);
  _exact = std::make_unique<DenseFactor>(size(), std::move(entries),
                                         [this](const double* v, double* r) { apply_jacobian(v, r); });
}

double Collocation::residual_rounding(const double* u) const {
  const int m = cells();
  const int d = dimension();
  const int stride = _grid.stride();
  midpoint_states(u);
  // A state's own digits, and those of the values at all nodes that it is a sum of, relative to the centre.
  std::vector<double> sizes;
  for (int l = 0; l < d; ++l) {
    const double mixed = Eigen::Map<const Eigen::VectorXd>(u + l * stride, m).norm() / std::sqrt(m);
    sizes.push_back(std::max(mixed, std::abs(_centre[at(l)])));
  }
  double square = 0.0;
  for (int i = 0; i < d; ++i)
    for (int j = 0; j < m; ++j) {
      double terms = std::abs(u[i * stride + j]) + std::abs(u[i * stride + j + 1]);
      for (int l = 0; l < d; ++l)
        terms += std::abs(_blocks[at((i * d + l) * m + j)]) * std::max(sizes[at(l)], std::abs(_z[at(l * m + j)]));
      square += terms * terms;
    }
  return std::numeric_limits<double>::epsilon() * std::sqrt(square);
}

bool Collocation::is_at_rounding(const double* u) const {
  Eigen::VectorXd values(size());
  residual(u, values.data());
  return values.norm() <= explained * residual_rounding(u);
}

void Collocation::begin_gmres(const double* u) {
  _rounding = residual_rounding(u);
  _gmres = std::make_unique<ShellGmres>(
      size(), "collocation_",
      ShellGmres::Actions{
          .multiply = [this](const ShellGmres::In& x, ShellGmres::Out y) { apply_jacobian(x.data(), y.data()); },
          .precondition =
              [this](const ShellGmres::In& x, ShellGmres::Out y) {
                y = x;
                _box->solve(y.data());
              }});
}

/// No further than to rounding: what it leaves of a residual would be magnified along directions that it hides. What
/// GMRES leaves is for the nonlinear solver to see.
void Collocation::solve_linearised(double* r) const {
  Eigen::Map<Eigen::VectorXd> values(r, size());
  _is_reached = values.allFinite();
  if (!_is_reached) return;
  const double size = values.norm();
  if (size <= explained * _rounding) {
    values.setZero();
    return;
  }
  const ShellGmres::Result result = _gmres->solve(values, {of_linear_residual, _rounding});
  values = result.x;
  _is_reached = result.residual <= std::max(of_linear_residual * size, _rounding);
}

void Collocation::precondition(double* r) const {
  const core::LogEvent event(core::Event::precondition);
  core::require(_exact || _box, "collocation points are preconditioned before their matrices are factored");
  if (_exact)
    _exact->solve(r);
  else if (_gmres)
    solve_linearised(r);
  else
    _box->solve(r);
  keep_symmetries(r);
}

bool Collocation::is_solved() const { return _exact != nullptr || (_gmres != nullptr && _is_reached); }

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
