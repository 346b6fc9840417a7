#pragma once

#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <boost/math/tools/toms748_solve.hpp>

#include "continuation/families.hpp"
#include "orbweaver/continuation/off_branch.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/spectrum/floquet.hpp"
#include "orbweaver/spectrum/sliced_hessian.hpp"
#include "orbweaver/starts/sweep.hpp"
#include "support/delegating_system.hpp"

namespace orbweaver::test {

/// Another system's field and energy under other declared symmetries.
class Declaring final : public DelegatingSystem {
 public:
  Declaring(std::shared_ptr<const systems::System> system, std::vector<systems::Symmetry> equivariances,
            std::vector<systems::Symmetry> reversors)
      : DelegatingSystem(std::move(system)), _structure(whole().structure()) {
    _structure.equivariances = std::move(equivariances);
    _structure.reversors = std::move(reversors);
  }
  [[nodiscard]] const systems::Structure& structure() const override { return _structure; }

 private:
  systems::Structure _structure;
};

/// What directions start from: an orbit `times` around with its null vectors besides the time shift and the tangent.
struct Crossing {
  loop::Loop base;
  std::vector<loop::Tangent> kernel;
};

inline Crossing crossing_at(const systems::System& system, const loop::Loop& orbit, const loop::Isotropy& isotropy,
                            int times, int dimension) {
  const loss::Unknowns unknowns{loop::Subspace(orbit.dimension, orbit.cutoff, isotropy), {loss::Scalar::period()}};
  Eigen::MatrixXd normal(unknowns.size(), 1);
  normal.col(0) = Eigen::VectorXd::Unit(unknowns.size(), unknowns.size() - 1);
  const Eigen::VectorXd pinned = normal.col(0);
  std::vector<double> shift = unknowns.time_shift_direction(orbit);
  const Eigen::Map<const Eigen::VectorXd> along(shift.data(), unknowns.size());
  if (along.norm() > 1e-6) {
    normal.conservativeResize(Eigen::NoChange, 2);
    normal.col(1) = along.normalized();
  }
  const loss::Linearization linearization(system, orbit, loss::Linearization::Order::jacobian);
  const Eigen::VectorXd flat =
      spectrum::SlicedHessian(linearization, unknowns, loss::Slice(unknowns.size(), normal)).flat_direction(pinned);
  const loop::Tangent tangent = unknowns.tangent_of(std::span(flat.data(), static_cast<std::size_t>(flat.size())));
  Crossing out{loop::repeated(orbit, times), {}};
  const auto found = continuation::sector_triplets(system, out.base, {}, {}, loop::repeated(orbit, tangent, times),
                                                   {.count = dimension + 1, .multiple = true});
  for (const continuation::OffBranchTriplet& t : found)
    if (t.singular_value < 1e-6 * found.back().singular_value) {
      EXPECT_LT(std::abs(t.direction.period()), 1e-6);
      out.kernel.push_back(t.direction);
    }
  EXPECT_EQ(out.kernel.size(), static_cast<std::size_t>(dimension))
      << found[0].singular_value << " " << found[1].singular_value;
  return out;
}

/// A traced family of any system.
struct Family {
  std::shared_ptr<const systems::System> system;
  loop::Isotropy isotropy;
  std::vector<continuation::Orbit> orbits;

  [[nodiscard]] loop::Loop at_period(const loop::Loop& near, double period) const {
    const auto result = continuation::orbit_at_period(*system, near, isotropy, period, {});
    EXPECT_TRUE(result.converged()) << result.detail;
    return result.loop;
  }
  [[nodiscard]] double index_of(const loop::Loop& loop) const {
    return spectrum::floquet(*system, loop, isotropy).fundamental.front().real();
  }
  /// The first orbit along the family whose fundamental map has this stability index; T is monotone there.
  [[nodiscard]] loop::Loop with_index(double index) const {
    double before = index_of(orbits.front().loop) - index;
    for (std::size_t n = 1; n < orbits.size(); ++n) {
      const double after = index_of(orbits[n].loop) - index;
      if (before * after < 0.0) {
        const loop::Loop& near = orbits[n].loop;
        const bool rising = near.period > orbits[n - 1].loop.period;
        const std::pair<double, double> ends[2] = {{orbits[n - 1].loop.period, before}, {near.period, after}};
        const auto& [from, at_from] = ends[rising ? 0 : 1];
        const auto& [to, at_to] = ends[rising ? 1 : 0];
        std::uintmax_t evaluations = 60;
        const auto [low, high] = boost::math::tools::toms748_solve(
            [&](double period) { return index_of(at_period(near, period)) - index; }, from, to, at_from, at_to,
            boost::math::tools::eps_tolerance<double>(48), evaluations);
        return at_period(near, 0.5 * (low + high));
      }
      before = after;
    }
    throw core::NumericalError("the family has no orbit with this index");
  }
};

inline Family family_from(std::shared_ptr<const systems::System> system, const continuation::Start& start,
                          double period_limit) {
  continuation::Options options;
  options.period_limit = period_limit;
  options.fit_time_map = false;
  return {system, start.isotropy, trace_of(system, start, options).orbits};
}

}  // namespace orbweaver::test
