// What a team computes of a chain of oscillators, against one rank alone: whole branches, multipliers, kernels.
#include <complex>
#include <memory>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include "orbweaver/continuation/off_branch.hpp"
#include "orbweaver/core/mpi/team.hpp"
#include "orbweaver/spectrum/floquet.hpp"
#include "support/chain_start.hpp"

namespace orbweaver::continuation::team_test {
namespace {

std::shared_ptr<const test::OscillatorChain> chain() { return std::make_shared<const test::OscillatorChain>(8); }

struct Traced {
  std::vector<Orbit> orbits;
  Frontier frontier;
};

Traced trace_with(core::Team* team, const std::shared_ptr<const test::OscillatorChain>& system) {
  Options options;
  options.start_amplitude = 0.3;
  options.step_limit = 4;
  options.corrector.team = team;
  options.corrector.method = corrector::Method::newton_krylov;  // what a team divides; collocation it repeats
  Branch branch(system, test::slowest_oscillation(*system), options);
  Traced out;
  while (const std::optional<Orbit> orbit = branch.advance()) out.orbits.push_back(*orbit);
  out.frontier = branch.frontier();
  return out;
}

TEST(Teams, TraceTheSameBranchToTolerance) {
  core::Team team(MPI_COMM_WORLD);
  const auto system = chain();
  const Traced alone = trace_with(nullptr, system);
  const Traced shared = trace_with(&team, system);
  ASSERT_EQ(shared.orbits.size(), alone.orbits.size());
  ASSERT_EQ(alone.orbits.size(), 4U);
  for (std::size_t n = 0; n < alone.orbits.size(); ++n) {
    const Orbit& a = alone.orbits[n];
    const Orbit& b = shared.orbits[n];
    EXPECT_NEAR(b.loop.period, a.loop.period, 1e-11);
    EXPECT_NEAR(b.energy, a.energy, 1e-11);
    ASSERT_EQ(b.loop.cutoff, a.loop.cutoff);
    for (std::size_t m = 0; m < a.loop.modes.size(); ++m) EXPECT_NEAR(b.loop.modes[m], a.loop.modes[m], 1e-11);
    const auto* bytes = reinterpret_cast<const char*>(b.loop.modes.data());
    team.compare("modes", core::digest_of({bytes, sizeof(double) * b.loop.modes.size()}));
  }
  const Traced again = trace_with(&team, system);
  EXPECT_EQ(again.orbits.back().loop.modes, shared.orbits.back().loop.modes);
}

TEST(Teams, MultipliersHaveTheBitsOfOneRank) {
  core::Team team(MPI_COMM_WORLD);
  const auto system = chain();
  const loop::Loop loop = trace_with(nullptr, system).orbits.back().loop;
  spectrum::FloquetOptions divided;
  divided.team = &team;
  const loop::Isotropy symmetric = test::slowest_oscillation(*system).isotropy;
  for (const loop::Isotropy& isotropy : {symmetric, loop::Isotropy{}}) {
    const spectrum::Stability alone = spectrum::floquet(*system, loop, isotropy);
    const spectrum::Stability shared = spectrum::floquet(*system, loop, isotropy, divided);
    ASSERT_EQ(alone.full.size(), 7U);
    EXPECT_EQ(shared.full, alone.full);
    EXPECT_EQ(shared.full_error, alone.full_error);
    EXPECT_EQ(shared.fundamental, alone.fundamental);
    EXPECT_EQ(shared.fundamental_error, alone.fundamental_error);
  }
}

TEST(Teams, FindTheSameSingularTriplets) {
  core::Team team(MPI_COMM_WORLD);
  const auto system = chain();
  const Traced traced = trace_with(nullptr, system);
  const Frontier& at = traced.frontier;
  spectrum::TripletOptions options;
  options.count = 2;
  const auto alone = sector_triplets(*system, at.orbit.loop, {}, {}, at.tangent, options);
  options.team = &team;
  const auto shared = sector_triplets(*system, at.orbit.loop, {}, {}, at.tangent, options);
  ASSERT_EQ(shared.size(), 2U);
  for (std::size_t n = 0; n < 2; ++n) {
    EXPECT_NEAR(shared[n].singular_value, alone[n].singular_value, 1e-9 * alone[n].singular_value);
    EXPECT_NEAR(loop::dot(shared[n].direction, alone[n].direction), 1.0, 1e-9);
    const auto* bytes = reinterpret_cast<const char*>(shared[n].direction.modes.data());
    team.compare("triplet", core::digest_of({bytes, sizeof(double) * shared[n].direction.modes.size()}));
  }
}

}  // namespace
}  // namespace orbweaver::continuation::team_test
