#include "orbweaver/equations/loop_equations.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include "box_scheme.hpp"
#include "fitted_cells.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/core/interruption.hpp"
#include "orbweaver/core/log/log_stage.hpp"
#include "orbweaver/loop/curve/system_at.hpp"
#include "orbweaver/loss/dense.hpp"

namespace orbweaver::equations {

namespace {

// df/ds at the nodes for any scalar s but T.
std::vector<double> derivatives_by(const systems::System& system, const loss::Scalar& scalar,
                                   const std::vector<double>& z) {
  const std::size_t nodes = z.size() / static_cast<std::size_t>(system.dimension());
  std::vector<double> out(z.size());
  if (scalar.kind == loss::Scalar::Kind::parameter)
    system.parameter_derivatives(scalar.parameter, nodes, z.data(), out.data());
  else
    system.conserved_gradients(scalar.quantity, nodes, z.data(), out.data());
  return out;
}

// Nodal values (component-major) times one number a node.
void multiply_by(const std::vector<double>& density, std::vector<double>& nodal) {
  const std::size_t n = density.size();
  for (std::size_t row = 0; row < nodal.size() / n; ++row)
    for (std::size_t j = 0; j < n; ++j) nodal[row * n + j] *= density[j];
}

// z(s + offset) at the grid's nodes, winding included.
std::vector<double> states_at(const loop::FourierGrid& grid, const loop::Loop& loop, double offset) {
  const auto n = static_cast<std::size_t>(grid.nodes());
  loop::Loop curve = loop;
  curve.time_map = {};
  const loop::Loop shifted = loop::parameter_shifted(curve, offset / (2.0 * std::numbers::pi));
  std::vector<double> z(n * static_cast<std::size_t>(loop.dimension));
  grid.synthesize(loop.cutoff, loop.dimension, shifted.modes.data(), z.data());
  for (std::size_t i = 0; i < static_cast<std::size_t>(loop.dimension); ++i)
    for (std::size_t j = 0; j < n; ++j)
      z[i * n + j] += loop.winding[i] * 2.0 * std::numbers::pi * static_cast<double>(j) / grid.nodes();
  return z;
}

// Harmonic k of real modes times sin(x)/x, x = k half_cell.
void smooth(std::vector<double>& modes, std::size_t d, double half_cell) {
  for (std::size_t row = 1; row < modes.size() / d; ++row) {
    const double x = static_cast<double>((row + 1) / 2) * half_cell;
    const double factor = std::sin(x) / x;
    for (std::size_t i = 0; i < d; ++i) modes[row * d + i] *= factor;
  }
}

// Modes of z(s + offset).
void shift(std::vector<double>& modes, std::size_t d, double offset) {
  for (std::size_t k = 1; k <= (modes.size() / d - 1) / 2; ++k) {
    const double c = std::cos(static_cast<double>(k) * offset);
    const double s = std::sin(static_cast<double>(k) * offset);
    for (std::size_t i = 0; i < d; ++i) {
      double& a = modes[(2 * k - 1) * d + i];
      double& b = modes[2 * k * d + i];
      const double a_new = a * c + b * s;
      b = b * c - a * s;
      a = a_new;
    }
  }
}

// What takes the transpose of the synthesis to the analysis on n nodes, or back: 1/n for the mean, 2/n for harmonics.
void scale(std::vector<double>& modes, std::size_t d, double mean, double harmonics) {
  for (std::size_t m = 0; m < d; ++m) modes[m] *= mean;
  for (std::size_t m = d; m < modes.size(); ++m) modes[m] *= harmonics;
}

// Adds the derivative with respect to s, times `factor`.
void add_derivative(const std::vector<double>& modes, std::size_t d, double factor, std::vector<double>& out) {
  for (std::size_t k = 1; k <= (modes.size() / d - 1) / 2; ++k) {
    const double weight = factor * static_cast<double>(k);
    for (std::size_t i = 0; i < d; ++i) {
      out[(2 * k - 1) * d + i] += weight * modes[2 * k * d + i];
      out[2 * k * d + i] -= weight * modes[(2 * k - 1) * d + i];
    }
  }
}

std::span<const double> view(const LoopEquations::In& x, int size) {
  return {x.data(), static_cast<std::size_t>(size)};
}
std::span<double> view(LoopEquations::Out& x, int size) { return {x.data(), static_cast<std::size_t>(size)}; }

}  // namespace

LoopEquations::LoopEquations(const systems::System& system, const loop::Loop& loop, const loss::Unknowns& unknowns,
                             const loop::Subspace& image, const loss::Slice& slice, core::Team* team)
    : _unknowns(unknowns),
      _image(image),
      _slice(slice),
      _team(core::several(team)),
      _unfoldings(unfoldings(unknowns, image, slice)),
      _linearization(system, loop, loss::Linearization::Order::jacobian, unknowns.scalars),
      _scalars(unknowns.scalars),
      _modes(loop.modes.size()),
      _other_modes(loop.modes.size()),
      _nodal(static_cast<std::size_t>(_linearization.rows())),
      _other_nodal(_nodal.size()),
      _boxed(static_cast<Eigen::Index>(loop.modes.size()) + slice.conditions().cols()) {
  unknowns.validate();
  core::require(_unfoldings >= 0, "loop equations need as many conditions as scalars");
  for (int k = 0; k < _unfoldings; ++k) _scalars.push_back(loss::Scalar::unfolding(k));
  const auto d = static_cast<std::size_t>(loop.dimension);
  _slope_modes.assign(loop.modes.size(), 0.0);
  std::copy(loop.winding.begin(), loop.winding.end(), _slope_modes.begin());
  add_derivative(loop.modes, d, 1.0, _slope_modes);
  if (columns() == 0) return;
  _columns.resize(image.size(), columns());
  const std::shared_ptr<const systems::System> here = loop::system_at(system, loop);
  const std::vector<double> z = states_at(_linearization.grid(), loop, 0.0);
  for (Eigen::Index c = 0; c < columns(); ++c) {
    const std::size_t first = _unknowns.has_period() ? 1 : 0;
    _nodal = derivatives_by(*here, _scalars[first + static_cast<std::size_t>(c)], z);
    weigh();
    project_nodal(_columns.col(c));
  }
}

LoopEquations::~LoopEquations() = default;

bool LoopEquations::are_square(const systems::System& system, const loss::Unknowns& unknowns,
                               const loop::Subspace& image, const loss::Slice& slice) {
  const int more = unfoldings(unknowns, image, slice);
  const int conserved = static_cast<int>(system.structure().conserved.size());
  return image.size() == unknowns.subspace.size() && more >= 0 && more <= conserved;
}

// _nodal times the density of the time map.
void LoopEquations::weigh() const {
  if (!_linearization.evenly_in_time()) multiply_by(_linearization.density(), _nodal);
}

// Of _nodal, onto the modes of the image.
void LoopEquations::project_nodal(Out out) const {
  _linearization.grid().analyze(_linearization.cutoff(), _linearization.dimension(), _nodal.data(), _modes.data());
  _image.project(_modes, view(out, _image.size()));
}

Eigen::VectorXd LoopEquations::residual() const {
  Eigen::VectorXd out = Eigen::VectorXd::Zero(size());
  std::copy_n(_linearization.raw_residual(0), _nodal.size(), _nodal.begin());
  weigh();
  project_nodal(out.head(_image.size()));
  return out;
}

// P w J u: the derivative among the modes, where harmonics do not mix, the rest on the grid of the loss.
void LoopEquations::apply(const In& x, Out out) const {
  core::interruption_point();
  const int cutoff = _linearization.cutoff();
  const int dimension = _linearization.dimension();
  const auto d = static_cast<std::size_t>(dimension);
  const auto n = static_cast<std::size_t>(_linearization.nodes());
  const double rate = _linearization.rate();
  std::fill(_other_modes.begin(), _other_modes.end(), 0.0);
  _unknowns.subspace.add_to(view(x, _unknowns.subspace.size()), _other_modes);
  _linearization.grid().synthesize(cutoff, dimension, _other_modes.data(), _other_nodal.data());
  std::fill(_nodal.begin(), _nodal.end(), 0.0);
  for (std::size_t i = 0; i < d; ++i)
    for (std::size_t l = 0; l < d; ++l) {
      const double* a = _linearization.field_jacobian(static_cast<int>(i), static_cast<int>(l));
      for (std::size_t j = 0; j < n; ++j) _nodal[i * n + j] -= a[j] * _other_nodal[l * n + j];
    }
  weigh();
  _linearization.grid().analyze(cutoff, dimension, _nodal.data(), _modes.data());
  add_derivative(_other_modes, d, rate, _modes);
  if (_unknowns.has_period()) {
    const double dt = -rate / _linearization.period() * x(first_scalar());
    for (std::size_t m = 0; m < _modes.size(); ++m) _modes[m] += dt * _slope_modes[m];
  }
  _image.project(_modes, view(out, _image.size()));
  for (Eigen::Index c = 0; c < columns(); ++c) out.head(_image.size()) -= x(first_column() + c) * _columns.col(c);
  out.tail(_slice.conditions().cols()).noalias() = _slice.conditions().transpose() * x.head(_unknowns.size());
}

// The steps of `apply` backwards. The transpose of the analysis is the synthesis of scaled modes, and the other way
// round.
void LoopEquations::apply_transposed(const In& y, Out out) const {
  const int cutoff = _linearization.cutoff();
  const int dimension = _linearization.dimension();
  const auto d = static_cast<std::size_t>(dimension);
  const auto n = static_cast<std::size_t>(_linearization.nodes());
  const double rate = _linearization.rate();
  std::fill(_other_modes.begin(), _other_modes.end(), 0.0);
  _image.add_to(view(y, _image.size()), _other_modes);
  std::copy(_other_modes.begin(), _other_modes.end(), _modes.begin());
  scale(_modes, d, 1.0, 2.0);
  _linearization.grid().synthesize(cutoff, dimension, _modes.data(), _other_nodal.data());
  std::fill(_nodal.begin(), _nodal.end(), 0.0);
  for (std::size_t i = 0; i < d; ++i)
    for (std::size_t l = 0; l < d; ++l) {
      const double* a = _linearization.field_jacobian(static_cast<int>(i), static_cast<int>(l));
      for (std::size_t j = 0; j < n; ++j) _nodal[l * n + j] -= a[j] * _other_nodal[i * n + j];
    }
  weigh();
  _linearization.grid().analyze(cutoff, dimension, _nodal.data(), _modes.data());
  scale(_modes, d, 1.0, 0.5);
  add_derivative(_other_modes, d, -rate, _modes);
  _unknowns.subspace.project(_modes, view(out, _unknowns.subspace.size()));
  if (_unknowns.has_period()) {
    double along_slope = 0.0;
    for (std::size_t m = 0; m < _slope_modes.size(); ++m) along_slope += _slope_modes[m] * _other_modes[m];
    out(first_scalar()) = -rate / _linearization.period() * along_slope;
  }
  for (Eigen::Index c = 0; c < columns(); ++c) out(first_column() + c) = -_columns.col(c).dot(y.head(_image.size()));
  out.head(_unknowns.size()).noalias() += _slice.conditions() * y.tail(_slice.conditions().cols());
}

void LoopEquations::project_rows(const In& rows, Out out) const {
  const auto n = static_cast<std::size_t>(_linearization.nodes());
  for (std::size_t m = 0; m < _nodal.size(); ++m)
    _nodal[m] =
        std::sqrt(_linearization.density()[m % n] * _linearization.nodes()) * rows(static_cast<Eigen::Index>(m));
  project_nodal(out);
}

void LoopEquations::project_rows_transposed(const In& y, Out rows) const {
  const auto n = static_cast<std::size_t>(_linearization.nodes());
  const double nodes = _linearization.nodes();
  std::fill(_modes.begin(), _modes.end(), 0.0);
  _image.add_to(view(y, _image.size()), _modes);
  scale(_modes, static_cast<std::size_t>(_linearization.dimension()), 1.0 / nodes, 2.0 / nodes);
  _linearization.grid().synthesize(_linearization.cutoff(), _linearization.dimension(), _modes.data(), rows.data());
  for (std::size_t m = 0; m < _nodal.size(); ++m)
    rows(static_cast<Eigen::Index>(m)) *= std::sqrt(_linearization.density()[m % n] * nodes);
}

void LoopEquations::factor(const systems::System& family, const loop::Loop& loop) {
  const core::LogEvent event(core::Event::factor);
  const std::shared_ptr<const systems::System> here = loop::system_at(family, loop);
  const systems::System& system = *here;
  const int nodes = 2 * loop.cutoff + 1;
  const loop::FourierGrid& grid = loop::FourierGrid::of_size(nodes);
  const core::Team::Part mine = cells_of(_team, nodes);
  const auto boxes = static_cast<std::size_t>(mine.end - mine.begin);
  const auto n = static_cast<std::size_t>(nodes);
  const auto d = static_cast<std::size_t>(loop.dimension);
  const double h = 2.0 * std::numbers::pi / nodes;
  const double rate = _linearization.rate();
  std::vector<double> z = states_at(grid, loop, 0.5 * h);
  for (std::size_t i = 0; i < d; ++i)
    std::copy_n(z.begin() + static_cast<std::ptrdiff_t>(i * n) + mine.begin, boxes,
                z.begin() + static_cast<std::ptrdiff_t>(i * boxes));
  z.resize(d * boxes);
  std::vector<double> blocks(d * d * boxes);
  std::vector<double> f(d * boxes);
  system.field_jacobian(boxes, z.data(), f.data(), blocks.data());
  std::vector<double> density;
  if (!loop.time_map.is_identity()) {
    for (int j = mine.begin; j < mine.end; ++j)
      density.push_back(loop.time_map.density(h * (static_cast<double>(j) + 0.5)));
    multiply_by(density, f);
    multiply_by(density, blocks);
  }

  const auto borders = static_cast<Eigen::Index>(_slice.conditions().cols());
  Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(d * boxes), borders);
  Eigen::MatrixXd rows(static_cast<Eigen::Index>(d * n), borders);
  Eigen::MatrixXd corner = Eigen::MatrixXd::Zero(borders, borders);
  for (Eigen::Index column = 0; column < borders; ++column) {
    const loss::Scalar& scalar = _scalars[static_cast<std::size_t>(column)];
    if (scalar.kind == loss::Scalar::Kind::period) {
      // d/dT of w r is -(rate / T) z', and z' rate = w f at an orbit.
      for (std::size_t q = 0; q < d * boxes; ++q) columns(static_cast<Eigen::Index>(q), column) = -f[q] / loop.period;
    } else {
      std::vector<double> derivative = derivatives_by(system, scalar, z);
      if (!density.empty()) multiply_by(density, derivative);
      for (std::size_t q = 0; q < d * boxes; ++q) columns(static_cast<Eigen::Index>(q), column) = -derivative[q];
    }
    if (first_scalar() + column < _unknowns.size())
      corner.col(column) = _slice.conditions().row(first_scalar() + column).transpose();
  }
  // c . u in coefficients is the mean over nodes of a loop with twice c's harmonics; y enters through the filter of z =
  // F(y).
  for (Eigen::Index r = 0; r < borders; ++r) {
    std::vector<double> modes((2 * static_cast<std::size_t>(loop.cutoff) + 1) * d, 0.0);
    const Eigen::VectorXd condition = _slice.conditions().col(r);
    _unknowns.subspace.add_to(
        std::span<const double>(condition.data(), static_cast<std::size_t>(_unknowns.subspace.size())), modes);
    for (std::size_t q = d; q < modes.size(); ++q) modes[q] *= 2.0;
    smooth(modes, d, 0.5 * h);
    grid.synthesize(loop.cutoff, loop.dimension, modes.data(), rows.col(r).data());
  }
  rows /= nodes;
  const Eigen::MatrixXd corner_by_rows = corner.transpose();
  BoxScheme::Matrices m;
  m.cells = nodes;
  m.first = mine.begin;
  m.count = mine.end - mine.begin;
  m.borders = static_cast<int>(borders);
  m.difference = rate / h;
  const std::vector<double> fitted = fitted_cells(blocks.data(), loop.dimension, m.count, m.difference);
  m.blocks = fitted.empty() ? blocks.data() : fitted.data();
  m.columns = columns.data();
  m.column_stride = m.count;
  m.rows = rows.data();
  m.stride = nodes;
  m.corner = corner_by_rows.data();
  _box = BoxScheme::of_dimension(loop.dimension, BoxScheme::Storage::line);
  _box->factor(m, _team);
}

void LoopEquations::solve_boxes(const In& given, Out out, void (BoxScheme::*solve)(double*) const) const {
  const int cutoff = _linearization.cutoff();
  const int dimension = _linearization.dimension();
  const loop::FourierGrid& grid = loop::FourierGrid::of_size(2 * cutoff + 1);
  const auto borders = _slice.conditions().cols();
  grid.synthesize(cutoff, dimension, _modes.data(), _boxed.data());
  _boxed.tail(borders) = given.tail(borders);
  (*_box.*solve)(_boxed.data());
  grid.analyze(cutoff, dimension, _boxed.data(), _modes.data());
  out.tail(borders) = _boxed.tail(borders);
}

void LoopEquations::precondition(const In& r, Out out) const {
  const core::LogEvent event(core::Event::precondition);
  const auto d = static_cast<std::size_t>(_linearization.dimension());
  const double half_cell = std::numbers::pi / (2 * _linearization.cutoff() + 1);
  std::fill(_modes.begin(), _modes.end(), 0.0);
  _image.add_to(view(r, _image.size()), _modes);
  shift(_modes, d, half_cell);
  solve_boxes(r, out, &BoxScheme::solve);
  smooth(_modes, d, half_cell);
  _unknowns.subspace.project(_modes, view(out, _unknowns.subspace.size()));
}

void LoopEquations::precondition_transposed(const In& u, Out out) const {
  const core::LogEvent event(core::Event::precondition);
  const auto d = static_cast<std::size_t>(_linearization.dimension());
  const int nodes = 2 * _linearization.cutoff() + 1;
  const double half_cell = std::numbers::pi / nodes;
  std::fill(_modes.begin(), _modes.end(), 0.0);
  _unknowns.subspace.add_to(view(u, _unknowns.subspace.size()), _modes);
  smooth(_modes, d, half_cell);
  scale(_modes, d, 1.0 / nodes, 2.0 / nodes);
  solve_boxes(u, out, &BoxScheme::solve_transposed);
  scale(_modes, d, nodes, 0.5 * nodes);
  shift(_modes, d, -half_cell);
  _image.project(_modes, view(out, _image.size()));
}

}  // namespace orbweaver::equations
