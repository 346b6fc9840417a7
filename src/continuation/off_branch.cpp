#include "orbweaver/continuation/off_branch.hpp"

#include <algorithm>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "held_energy.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/equations/loop_equations.hpp"
#include "orbweaver/loop/curve/measures.hpp"
#include "orbweaver/loop/curve/system_at.hpp"
#include "orbweaver/loss/assembled.hpp"
#include "orbweaver/loss/linearization.hpp"
#include "orbweaver/loss/slice.hpp"
#include "orbweaver/spectrum/eigenpairs.hpp"

namespace orbweaver::continuation {

namespace {

/// What is left of a unit vector that the unknowns, or the directions excluded before, contain to rounding.
constexpr double contained = 1e-8;

// What is perturbed, and what is known to be flat there.
struct Sector {
  loss::Unknowns unknowns;
  loss::Slice slice;
};

using Hold = systems::FamilyScalars::Hold;

// How the energy at s = 0 depends on the unknowns.
Eigen::VectorXd energy_gradient(const systems::System& system, const loss::Unknowns& unknowns, const loop::Loop& loop) {
  const auto d = static_cast<std::size_t>(loop.dimension);
  std::vector<double> by_state(d);
  loop::system_at(system, loop)->conserved_gradient(0, loop::state_at(loop, 0.0), by_state);
  loop::Tangent gradient{std::vector<double>(loop.modes.size(), 0.0),
                         std::vector<double>(unknowns.scalars.size(), 0.0)};
  for (std::size_t row = 0; row < gradient.modes.size() / d; ++row)
    if (row == 0 || row % 2 == 1)  // the mean and the cosines
      std::copy(by_state.begin(), by_state.end(), gradient.modes.begin() + static_cast<std::ptrdiff_t>(row * d));
  const std::size_t first = unknowns.has_period() ? 1 : 0;
  for (std::size_t n = 0; first + n < gradient.scalars.size(); ++n)
    gradient.scalars[first + n] = energy_by_parameter(system, loop, n);
  const std::vector<double> in = unknowns.coordinates_of(gradient);
  return Eigen::Map<const Eigen::VectorXd>(in.data(), static_cast<Eigen::Index>(in.size()));
}

// The complement of the family's tangent, of the time shift and of what the family holds, as far as the unknowns
// contain them.
loss::Slice complement(const systems::System& system, const loss::Unknowns& unknowns, const loop::Loop& loop,
                       const loop::Tangent& tangent) {
  const int size = unknowns.size();
  Eigen::MatrixXd excluded(size, 0);
  const auto exclude = [&](Eigen::VectorXd direction) {
    for (Eigen::Index c = 0; c < excluded.cols(); ++c) direction -= excluded.col(c).dot(direction) * excluded.col(c);
    if (direction.norm() < contained) return;
    excluded.conservativeResize(Eigen::NoChange, excluded.cols() + 1);
    excluded.col(excluded.cols() - 1) = direction.normalized();
  };
  const std::vector<double> along = unknowns.coordinates_of(tangent);
  exclude(Eigen::Map<const Eigen::VectorXd>(along.data(), size));
  const std::vector<double> shift = unknowns.time_shift_direction(loop);
  const double amplitude = loop::rms_amplitude(loop);
  if (amplitude > 0.0) exclude(Eigen::Map<const Eigen::VectorXd>(shift.data(), size) / amplitude);
  if (!unknowns.scalars.empty() && system.family_scalars().hold == Hold::energy)
    exclude(energy_gradient(system, unknowns, loop).normalized());
  return {size, excluded};
}

// Of T and the parameters that move: their changes keep every symmetry.
std::vector<loss::Scalar> scalars_of(const systems::System& system, bool all_kept) {
  std::vector<loss::Scalar> scalars;
  if (!all_kept) return scalars;
  const systems::FamilyScalars& family = system.family_scalars();
  if (family.hold != Hold::period) scalars.push_back(loss::Scalar::period());
  for (const std::string& name : family.free) scalars.push_back(loss::Scalar::of_parameter(name));
  return scalars;
}

// All sign patterns of the generators, or the unrestricted space where they do not split the modes completely.
std::vector<Sector> sectors_of(const systems::System& system, const loop::Loop& loop, const loop::Isotropy& isotropy,
                               const loop::Tangent& tangent) {
  std::vector<Sector> sectors;
  const auto add = [&](loop::Subspace subspace, bool all_kept) {
    loss::Unknowns unknowns{std::move(subspace), scalars_of(system, all_kept)};
    loss::Slice slice = complement(system, unknowns, loop, tangent);
    if (slice.free() > 0) sectors.push_back({std::move(unknowns), std::move(slice)});
  };
  int covered = 0;
  if (!isotropy.empty())
    for (unsigned pattern = 0; pattern < (1u << isotropy.size()); ++pattern) {
      std::vector<int> signs;
      for (std::size_t n = 0; n < isotropy.size(); ++n) signs.push_back(((pattern >> n) & 1u) == 0u ? 1 : -1);
      loop::Subspace sector(loop.dimension, loop.cutoff, isotropy, signs);
      covered += sector.size();
      // The first pattern has all signs positive: the only one that changes of scalars belong to.
      if (sector.size() > 0) add(std::move(sector), pattern == 0);
    }
  loop::Subspace whole = loop::Subspace::unrestricted(loop.dimension, loop.cutoff);
  if (covered != whole.size()) {
    sectors.clear();
    add(std::move(whole), true);
  }
  return sectors;
}

double matrix_free_eigenvalue(const systems::System& system, const loop::Loop& loop, const Sector& whole) {
  try {
    return spectrum::smallest_eigenpairs(system, loop, whole.unknowns, whole.slice, {.count = 1}).values.front();
  } catch (const core::NumericalError&) {
    return std::numeric_limits<double>::quiet_NaN();
  }
}

}  // namespace

std::vector<OffBranchTriplet> sector_triplets(const systems::System& system, const loop::Loop& loop,
                                              const loop::Isotropy& isotropy, const std::vector<int>& signs,
                                              const loop::Tangent& tangent, const spectrum::TripletOptions& options) {
  const bool all_kept = std::all_of(signs.begin(), signs.end(), [](int sign) { return sign > 0; });
  const loss::Unknowns unknowns{loop::Subspace(loop.dimension, loop.cutoff, isotropy, signs),
                                scalars_of(system, all_kept)};
  if (unknowns.subspace.size() == 0) return {};
  const loss::Slice slice = complement(system, unknowns, loop, tangent);
  if (slice.free() == 0) return {};
  spectrum::TripletOptions here = options;
  here.count = std::min(options.count, slice.free());
  here.nearly_flat = std::min(options.nearly_flat, here.count - 1);
  const spectrum::SingularTriplets found = spectrum::smallest_singular_triplets(system, loop, unknowns, slice, here);
  std::vector<OffBranchTriplet> all;
  for (std::size_t n = 0; n < found.values.size(); ++n) {
    OffBranchTriplet t;
    t.singular_value = found.values[n];
    const Eigen::VectorXd v = found.right.col(static_cast<Eigen::Index>(n));
    t.direction = unknowns.tangent_of(std::span(v.data(), static_cast<std::size_t>(v.size())));
    t.signs = signs;
    t.residual = found.residuals[n];
    t.left_residual = found.left_residuals[n];
    all.push_back(std::move(t));
  }
  return all;
}

double off_branch_eigenvalue(const systems::System& system, const loop::Loop& loop, const loop::Isotropy& isotropy,
                             const loop::Tangent& tangent, int krylov_from) {
  if (!loop.time_map.is_identity()) {
    const loop::Loop even = loop::evenly_in_time(loop);
    return off_branch_eigenvalue(system, even, isotropy, loop::with_time_map(loop, tangent, {}, even.cutoff),
                                 krylov_from);
  }
  if (static_cast<int>(loop.modes.size()) >= krylov_from) {
    const Sector whole = sectors_of(system, loop, {}, tangent).front();
    if (equations::LoopEquations::are_square(system, whole.unknowns, whole.unknowns.subspace.image(), whole.slice))
      return matrix_free_eigenvalue(system, loop, whole);
  }
  const loss::Linearization linearization(system, loop, loss::Linearization::Order::jacobian, scalars_of(system, true));
  double smallest = std::numeric_limits<double>::infinity();
  for (const Sector& sector : sectors_of(system, loop, isotropy, tangent)) {
    const core::Handle<Mat> reduced = sector.slice.reduce_symmetric(
        loss::assemble_hessian(linearization, sector.unknowns, loss::Curvature::gauss_newton));
    smallest = std::min(smallest, spectrum::smallest_eigenpairs(reduced, {.count = 1}).values.front());
  }
  return smallest;
}

}  // namespace orbweaver::continuation
