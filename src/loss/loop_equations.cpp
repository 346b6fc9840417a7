#include "orbweaver/loss/loop_equations.hpp"

#include <cmath>
#include <numbers>

#include "box_scheme.hpp"
#include "orbweaver/core/log_stage.hpp"

namespace orbweaver::loss {

namespace {

std::vector<double> energy_gradients(const systems::System& system, std::size_t nodes, const std::vector<double>& z) {
  std::vector<double> out(z.size());
  system.energy_gradients(nodes, z.data(), out.data());
  return out;
}

// Nodal values (component-major) times one number a node.
void multiply_by(const std::vector<double>& density, std::vector<double>& nodal) {
  for (std::size_t m = 0; m < nodal.size(); ++m) nodal[m] *= density[m % density.size()];
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

// Multiplies harmonic k by sin(x)/x e^{ix shift}, x = k h / 2, of real modes.
void filter(std::vector<double>& modes, int dimension, double half_cell, bool shift) {
  const auto d = static_cast<std::size_t>(dimension);
  const std::size_t cutoff = (modes.size() / d - 1) / 2;
  for (std::size_t k = 1; k <= cutoff; ++k) {
    const double x = static_cast<double>(k) * half_cell;
    const double factor = shift ? 1.0 : std::sin(x) / x;
    const double c = shift ? std::cos(x) : 1.0;
    const double s = shift ? std::sin(x) : 0.0;
    for (std::size_t i = 0; i < d; ++i) {
      double& a = modes[(2 * k - 1) * d + i];
      double& b = modes[2 * k * d + i];
      const double a_new = factor * (a * c + b * s);
      b = factor * (b * c - a * s);
      a = a_new;
    }
  }
}

}  // namespace

LoopEquations::LoopEquations(const systems::System& system, const loop::Loop& loop, const Unknowns& unknowns,
                             const loop::Subspace& image, const Slice& slice)
    : _unknowns(unknowns),
      _image(image),
      _slice(slice),
      _unfoldings(unfoldings(unknowns, image, slice)),
      _linearization(system, loop, Linearization::Order::jacobian) {
  if (_unfoldings == 0) return;
  const loop::FourierGrid& grid = _linearization.grid();
  std::vector<double> gradients =
      energy_gradients(system, static_cast<std::size_t>(grid.nodes()), states_at(grid, loop, 0.0));
  multiply_by(_linearization.density(), gradients);
  _unfolding_column = project_nodal(gradients);
}

LoopEquations::~LoopEquations() = default;

Eigen::VectorXd LoopEquations::project_nodal(const std::vector<double>& nodal) const {
  std::vector<double> modes((2 * static_cast<std::size_t>(_linearization.cutoff()) + 1) *
                            static_cast<std::size_t>(_linearization.dimension()));
  _linearization.grid().analyze(_linearization.cutoff(), _linearization.dimension(), nodal.data(), modes.data());
  Eigen::VectorXd out(_image.size());
  _image.project(modes, std::span(out.data(), static_cast<std::size_t>(out.size())));
  return out;
}

Eigen::VectorXd LoopEquations::residual() const {
  Eigen::VectorXd out = Eigen::VectorXd::Zero(size());
  const double* r = _linearization.raw_residual(0);
  std::vector<double> nodal(r, r + _linearization.rows());
  multiply_by(_linearization.density(), nodal);
  out.head(_image.size()) = project_nodal(nodal);
  return out;
}

Eigen::VectorXd LoopEquations::apply(const Eigen::VectorXd& x) const {
  const auto count = static_cast<std::size_t>(_unknowns.size());
  std::vector<double> nodal = _linearization.apply_jacobian(_unknowns, std::span<const double>(x.data(), count));
  // Rows of the Jacobian of the loss are dr sqrt(w / N); those here are w dr.
  std::vector<double> scale = _linearization.density();
  for (double& w : scale) w = std::sqrt(w * _linearization.nodes());
  multiply_by(scale, nodal);
  Eigen::VectorXd out(size());
  out.head(_image.size()) = project_nodal(nodal);
  if (_unfoldings > 0) out.head(_image.size()) -= x(_unknowns.size()) * _unfolding_column;
  out.tail(_slice.conditions().cols()) = _slice.conditions().transpose() * x.head(_unknowns.size());
  return out;
}

void LoopEquations::factor(const systems::System& system, const loop::Loop& loop) {
  const core::LogEvent event(core::Event::factor);
  const int nodes = 2 * loop.cutoff + 1;
  const loop::FourierGrid& grid = loop::FourierGrid::of_size(nodes);
  const auto n = static_cast<std::size_t>(nodes);
  const auto d = static_cast<std::size_t>(loop.dimension);
  const double h = 2.0 * std::numbers::pi / nodes;
  const double rate = _linearization.rate();
  const std::vector<double> z = states_at(grid, loop, 0.5 * h);
  BoxScheme::Matrices m;
  m.dimension = loop.dimension;
  m.nodes = nodes;
  m.spacing = h / rate;
  m.blocks.resize(d * d * n);
  std::vector<double> f(d * n);
  system.field_jacobian(n, z.data(), f.data(), m.blocks.data());
  std::vector<double> density;
  if (!loop.time_map.is_identity()) {
    density.resize(n);
    for (std::size_t j = 0; j < n; ++j) density[j] = loop.time_map.density(h * (static_cast<double>(j) + 0.5));
    multiply_by(density, f);
    multiply_by(density, m.blocks);
  }

  const auto borders = static_cast<Eigen::Index>(_slice.conditions().cols());
  m.columns = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(d * n), borders);
  m.rows = Eigen::MatrixXd::Zero(borders, static_cast<Eigen::Index>(d * n));
  m.corner = Eigen::MatrixXd::Zero(borders, borders);
  Eigen::Index column = 0;
  if (_unknowns.period) {
    // d/dT of w r is -(rate / T) z', and z' rate = w f at an orbit.
    for (std::size_t q = 0; q < d * n; ++q) m.columns(static_cast<Eigen::Index>(q), column) = -f[q] / loop.period;
    m.corner.col(column) = _slice.conditions().row(_unknowns.size() - 1).transpose();
    ++column;
  }
  if (_unfoldings > 0) {
    std::vector<double> gradient = energy_gradients(system, n, z);
    if (!density.empty()) multiply_by(density, gradient);
    for (std::size_t q = 0; q < d * n; ++q) m.columns(static_cast<Eigen::Index>(q), column) = -gradient[q];
  }
  // c . u in coefficients is the mean over nodes of a loop with twice c's harmonics; y enters through the filter of z = F(y).
  std::vector<double> nodal(d * n);
  for (Eigen::Index r = 0; r < borders; ++r) {
    std::vector<double> modes((2 * static_cast<std::size_t>(loop.cutoff) + 1) * d, 0.0);
    const Eigen::VectorXd condition = _slice.conditions().col(r);
    _unknowns.subspace.add_to(
        std::span<const double>(condition.data(), static_cast<std::size_t>(_unknowns.subspace.size())), modes);
    for (std::size_t q = d; q < modes.size(); ++q) modes[q] *= 2.0;
    filter(modes, loop.dimension, 0.5 * h, false);
    grid.synthesize(loop.cutoff, loop.dimension, modes.data(), nodal.data());
    for (std::size_t q = 0; q < d * n; ++q) m.rows(r, static_cast<Eigen::Index>(q)) = nodal[q] / nodes;
  }
  _box = factor_box_scheme(m);
}

Eigen::VectorXd LoopEquations::precondition(const Eigen::VectorXd& r) const {
  const core::LogEvent event(core::Event::precondition);
  const int cutoff = _linearization.cutoff();
  const int dimension = _linearization.dimension();
  const int nodes = 2 * cutoff + 1;
  const loop::FourierGrid& grid = loop::FourierGrid::of_size(nodes);
  const double half_cell = std::numbers::pi / nodes;
  const auto borders = _slice.conditions().cols();
  std::vector<double> modes(static_cast<std::size_t>(nodes) * static_cast<std::size_t>(dimension), 0.0);
  _image.add_to(std::span<const double>(r.data(), static_cast<std::size_t>(_image.size())), modes);
  filter(modes, dimension, half_cell, true);
  Eigen::VectorXd x(static_cast<Eigen::Index>(modes.size()) + borders);
  grid.synthesize(cutoff, dimension, modes.data(), x.data());
  x.tail(borders) = r.tail(borders);
  _box->solve(x);
  grid.analyze(cutoff, dimension, x.data(), modes.data());
  filter(modes, dimension, half_cell, false);
  Eigen::VectorXd out(size());
  _unknowns.subspace.project(modes, std::span(out.data(), static_cast<std::size_t>(_unknowns.subspace.size())));
  out.tail(borders) = x.tail(borders);
  return out;
}

}  // namespace orbweaver::loss
