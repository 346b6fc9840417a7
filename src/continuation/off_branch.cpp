#include "orbweaver/continuation/off_branch.hpp"

#include <algorithm>
#include <limits>
#include <vector>

#include "orbweaver/loss/linearization.hpp"
#include "orbweaver/loss/matrices.hpp"
#include "orbweaver/loss/slice.hpp"
#include "orbweaver/spectrum/eigenpairs.hpp"

namespace orbweaver::continuation {

namespace {

// All sign patterns of the generators, or the unrestricted space where they do not split the modes completely.
std::vector<loop::Subspace> sectors_of(const loop::Loop& loop, const loop::Isotropy& isotropy) {
  std::vector<loop::Subspace> sectors;
  const loop::Subspace whole = loop::Subspace::unrestricted(loop.dimension, loop.cutoff);
  int covered = 0;
  for (unsigned pattern = 0; pattern < (1u << isotropy.size()); ++pattern) {
    std::vector<int> signs;
    for (std::size_t n = 0; n < isotropy.size(); ++n) signs.push_back(((pattern >> n) & 1u) == 0u ? 1 : -1);
    loop::Subspace sector(loop.dimension, loop.cutoff, isotropy, signs);
    covered += sector.size();
    if (sector.size() > 0) sectors.push_back(std::move(sector));
  }
  if (covered != whole.size()) return {whole};
  return sectors;
}

}  // namespace

double off_branch_eigenvalue(const systems::System& system, const loop::Loop& loop, const loop::Isotropy& isotropy,
                             std::span<const double> tangent_modes, double tangent_period) {
  const loss::Linearization linearization(system, loop, loss::Linearization::Order::jacobian);
  double smallest = std::numeric_limits<double>::infinity();
  bool trivial_sector = true;  // the first pattern has all signs positive: the only one that a change of T belongs to
  for (loop::Subspace& sector : sectors_of(loop, isotropy)) {
    loss::Unknowns unknowns{std::move(sector), trivial_sector};
    trivial_sector = false;
    const int size = unknowns.size();
    Eigen::MatrixXd excluded(size, 0);
    const auto exclude = [&](Eigen::VectorXd direction) {
      for (Eigen::Index c = 0; c < excluded.cols(); ++c) direction -= excluded.col(c).dot(direction) * excluded.col(c);
      if (direction.norm() < 1e-8) return;
      excluded.conservativeResize(Eigen::NoChange, excluded.cols() + 1);
      excluded.col(excluded.cols() - 1) = direction.normalized();
    };
    Eigen::VectorXd tangent = Eigen::VectorXd::Zero(size);
    unknowns.subspace.project(tangent_modes,
                              std::span(tangent.data(), static_cast<std::size_t>(unknowns.subspace.size())));
    if (unknowns.period) tangent(size - 1) = tangent_period;
    exclude(tangent);
    std::vector<double> shift = unknowns.time_shift_direction(loop);
    const Eigen::VectorXd shift_direction = Eigen::Map<Eigen::VectorXd>(shift.data(), size);
    const double amplitude = loop::rms_amplitude(loop);
    if (amplitude > 0.0) exclude(shift_direction / amplitude);
    const loss::Slice slice(size, excluded);
    if (slice.free() < 1) continue;
    const core::Handle<Mat> reduced =
        slice.reduce_symmetric(loss::assemble_hessian(linearization, unknowns, loss::Curvature::gauss_newton));
    smallest = std::min(smallest, spectrum::smallest_eigenpairs(reduced, {.count = 1}).values.front());
  }
  return smallest;
}

}  // namespace orbweaver::continuation
