#include "orbweaver/equations/collocation.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>

#include "box_scheme.hpp"
#include "dense_factor.hpp"
#include "index.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/core/log/log_stage.hpp"
#include "orbweaver/loss/linearization.hpp"
#include "orbweaver/numerics/two_pi.hpp"

namespace orbweaver::equations {

namespace {

using numerics::two_pi;

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

}  // namespace orbweaver::equations
