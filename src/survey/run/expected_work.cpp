#include "orbweaver/survey/run/expected_work.hpp"

#include <algorithm>
#include <cmath>

#include <unistd.h>

#include <fmt/format.h>

#include "orbweaver/core/address_space.hpp"
#include "orbweaver/core/error.hpp"

namespace orbweaver::survey {

namespace {

/// Per unknown, at K = 100000: 660 bytes (double pendulum) to 1090 (Van der Pol, whose loops have no symmetry).
constexpr double bytes_an_unknown = 1100.0;
/// Of the program without a family, resident: libraries, MPI. Its addresses are more (core::space_of_a_rank).
constexpr double bytes_of_the_program = 45.0 * (1 << 20);
/// Per unknown and orbit, at K = 100000: 1 us (double pendulum, planar problem) to 3.4 (Van der Pol).
constexpr double least_seconds_an_unknown = 1e-6;
constexpr double most_seconds_an_unknown = 3.5e-6;
/// Per period: 1.2 us (the double pendulum's saddle) to 5.7 (its centres and saddle-centres).
constexpr double seconds_a_period = 6e-6;

OrbitCost orbit_cost(int cutoff, int dimension) {
  OrbitCost cost;
  cost.cutoff = cutoff;
  cost.unknowns = (2.0 * cutoff + 1.0) * dimension;
  cost.working_bytes = bytes_an_unknown * cost.unknowns;
  cost.memory_bytes = bytes_of_the_program + cost.working_bytes;
  cost.archive_bytes = sizeof(double) * cost.unknowns;
  cost.seconds_from = least_seconds_an_unknown * cost.unknowns;
  cost.seconds_to = most_seconds_an_unknown * cost.unknowns;
  return cost;
}

}  // namespace

ExpectedWork expected_work(const scene::Scene& scene, const systems::System& system) {
  ExpectedWork work;
  const scene::Sweep& sweep = scene.sweep;
  const bool measured = sweep.period.has_value();
  // With `auto` the range is not known before the equilibria are; its step is then a thousandth of it.
  work.sweep_periods =
      measured
          ? std::floor((sweep.period->to - sweep.period->from) / sweep.step.value_or(scene::Sweep::standard_step)) + 1
          : 1000.0;
  work.sweep_seconds = seconds_a_period * work.sweep_periods;
  work.least = orbit_cost(scene.continuation.cutoff_from, system.dimension());
  work.most = orbit_cost(scene.continuation.cutoff_to, system.dimension());
  return work;
}

double usable_memory() {
  const double machine = static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE));
  const core::AddressSpace allowed = core::space_allowed();
  const core::AddressSpace taken = core::space_of_a_rank();
  return std::min({machine - bytes_of_the_program, allowed.addresses - taken.addresses, allowed.data - taken.data});
}

void require_memory(const ExpectedWork& work) {
  core::require_space_of_a_rank();
  const double memory_bytes = usable_memory();
  if (work.least.working_bytes <= memory_bytes) return;
  constexpr double gibibyte = 1 << 30;
  throw core::InputError(
      fmt::format("continuation.cutoff: expected orbits that fit into the memory at hand, {:.3g} GiB beside the "
                  "program, got at least {} harmonics, which take some {:.3g} GiB a rank; give a smaller least number",
                  memory_bytes / gibibyte, work.least.cutoff, work.least.working_bytes / gibibyte));
}

}  // namespace orbweaver::survey
