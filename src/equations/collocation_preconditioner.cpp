#include "orbweaver/equations/collocation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "box_scheme.hpp"
#include "dense_factor.hpp"
#include "fitted_cells.hpp"
#include "index.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/core/log/log_stage.hpp"
#include "orbweaver/numerics/two_pi.hpp"
#include "shell_gmres.hpp"

namespace orbweaver::equations {

namespace {

using numerics::two_pi;

/// Of the right side: across a gap of 1e-8 what a residual leaves is magnified as much.
constexpr double of_linear_residual = 1e-10;

}  // namespace

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
  midpoint_states(u);
  double square = 0.0;
  for (int i = 0; i < d; ++i)
    for (int j = 0; j < m; ++j) {
      double terms = std::abs(u[i * _grid.stride() + j]) + std::abs(u[i * _grid.stride() + j + 1]);
      for (int l = 0; l < d; ++l) terms += std::abs(_blocks[at((i * d + l) * m + j)] * _z[at(l * m + j)]);
      square += terms * terms;
    }
  return std::numeric_limits<double>::epsilon() * std::sqrt(square);
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
  if (!values.allFinite()) return;
  values = _gmres->solve(values, {of_linear_residual, _rounding}).x;
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

}  // namespace orbweaver::equations
