#include "orbit_error.hpp"

#include <fmt/format.h>

#include "orbweaver/core/error.hpp"
#include "orbweaver/corrector/correct.hpp"
#include "orbweaver/loop/grid/fourier.hpp"

namespace orbweaver::benchmarks {

namespace {

using Span = std::span<const double>;

Span span_of(const Eigen::VectorXd& v) { return {v.data(), static_cast<std::size_t>(v.size())}; }

// The flat direction of a solve, or, where it was not computed, the difference to the neighbour.
Eigen::VectorXd direction_of(const corrector::Result& solved, const Eigen::VectorXd& secant) {
  return solved.flat_direction.value_or(secant);
}

// `modes` at the nodes, as one vector.
Eigen::VectorXd at_nodes(const loop::FourierGrid& grid, const loop::Loop& shape, const std::vector<double>& modes) {
  Eigen::VectorXd out(static_cast<Eigen::Index>(grid.nodes()) * shape.dimension);
  grid.synthesize(shape.cutoff, shape.dimension, modes.data(), out.data());
  return out;
}

}  // namespace

OrbitError error_of(const systems::System& system, const loop::Loop& orbit, const loop::Loop& neighbour,
                    const loop::Isotropy& isotropy) {
  const int cutoff = loop::allowed_cutoff_at_least(2 * orbit.cutoff);
  const loop::Loop produced = loop::with_cutoff(orbit, cutoff);
  const loss::Unknowns unknowns{loop::Subspace(orbit.dimension, cutoff, isotropy), {loss::Scalar::period()}};
  const auto difference = [&](const loop::Loop& to) {
    const std::vector<double> u = unknowns.difference(produced, to);
    return Eigen::VectorXd(Eigen::Map<const Eigen::VectorXd>(u.data(), static_cast<Eigen::Index>(u.size())));
  };
  const loop::Loop nearby = neighbour.time_map == produced.time_map
                                ? loop::with_cutoff(neighbour, cutoff)
                                : loop::with_time_map(neighbour, produced.time_map, cutoff);
  Eigen::VectorXd normal = difference(nearby).normalized();

  corrector::Result solved;
  solved.loop = produced;
  for (int n = 0; n < 3; ++n) {  // each correction that starts at an orbit is one more Newton step
    solved = corrector::correct(system, solved.loop, unknowns, loss::Slice(unknowns.size(), normal), {}, normal);
    if (!solved.converged())
      throw core::NumericalError(
          fmt::format("the finer solve at T = {:.6g}, K = {}: {}", orbit.period, cutoff, solved.detail));
    normal = direction_of(solved, normal).normalized();
  }

  const loop::FourierGrid& grid = loop::FourierGrid::of_size(2 * cutoff + 1);
  const Eigen::VectorXd off = at_nodes(grid, produced, produced.modes) - at_nodes(grid, produced, solved.loop.modes);
  std::vector<double> along(produced.modes.size(), 0.0);
  unknowns.subspace.add_to(span_of(normal).first(static_cast<std::size_t>(unknowns.subspace.size())), along);
  Eigen::MatrixXd neutral(off.size(), 2);
  neutral.col(0) = at_nodes(grid, produced, along);
  grid.synthesize_derivative(cutoff, orbit.dimension, solved.loop.modes.data(), neutral.col(1).data());
  const std::vector<double> density = loop::densities(produced.time_map, grid.nodes());  // dz/dt = z'(s) / density
  for (int i = 0; i < orbit.dimension; ++i)
    for (int j = 0; j < grid.nodes(); ++j)
      neutral(static_cast<Eigen::Index>(i) * grid.nodes() + j, 1) /= density[static_cast<std::size_t>(j)];
  neutral.colwise().normalize();
  const Eigen::VectorXd rest = off - neutral * neutral.householderQr().solve(off);
  return {rest.cwiseAbs().maxCoeff(), solved.newton_step};
}

}  // namespace orbweaver::benchmarks
