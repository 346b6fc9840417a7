// bench_teams [--rounds N]: what a task costs one rank and a team of all ranks, in turn within one run; under mpirun -n
// 2.
#include <algorithm>
#include <chrono>
#include <functional>
#include <memory>
#include <thread>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "orbweaver/certificate/certificate.hpp"
#include "orbweaver/continuation/off_branch.hpp"
#include "orbweaver/core/blas_kernels.hpp"
#include "orbweaver/core/mpi/check_mpi.hpp"
#include "orbweaver/core/mpi/team.hpp"
#include "orbweaver/core/petsc/session.hpp"
#include "orbweaver/spectrum/floquet.hpp"
#include "support/chain_start.hpp"

namespace {

using namespace orbweaver;

/// Seconds of the parts of a task: five orbits of a branch with multipliers and certificates, and the two smallest
/// off-branch triplets at the last of them.
struct Times {
  double continuation = 0.0;
  double multipliers = 0.0;
  double triplets = 0.0;
  double rest = 0.0;
  [[nodiscard]] double total() const { return continuation + multipliers + triplets + rest; }
};

template <class Work>
auto timed(double& seconds, const Work& work) {
  const auto began = std::chrono::steady_clock::now();
  auto result = work();
  seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  return result;
}

Times do_task(const std::shared_ptr<const test::OscillatorChain>& chain, core::Team* team) {
  constexpr int orbits = 5;
  const continuation::Start start = test::slowest_oscillation(*chain);
  continuation::Options options;
  options.start_amplitude = 0.3;
  options.step_limit = orbits;
  options.corrector.team = team;
  spectrum::FloquetOptions multipliers;
  multipliers.team = team;
  spectrum::TripletOptions triplets;
  triplets.count = 2;
  triplets.team = team;
  Times times;
  continuation::Branch branch(chain, start, options);
  for (int n = 0; n < orbits; ++n) {
    const auto orbit = timed(times.continuation, [&] { return branch.advance(); }).value();
    (void)timed(times.multipliers, [&] { return spectrum::floquet(*chain, orbit.loop, start.isotropy, multipliers); });
    (void)timed(times.rest, [&] { return certificate::certify(*chain, orbit.loop); });
  }
  const continuation::Frontier& at = branch.frontier();
  (void)timed(times.triplets,
              [&] { return continuation::sector_triplets(*chain, at.orbit.loop, {}, {}, at.tangent, triplets); });
  return times;
}

/// All ranks leave together; those who wait sleep meanwhile.
void wait_for_all(MPI_Comm comm) {
  MPI_Request request = MPI_REQUEST_NULL;
  core::check_mpi(MPI_Ibarrier(comm, &request), "MPI_Ibarrier");
  for (int done = 0; done == 0; std::this_thread::sleep_for(std::chrono::microseconds(200)))
    core::check_mpi(MPI_Test(&request, &done, MPI_STATUS_IGNORE), "MPI_Test");
}

double least(const std::vector<Times>& all, const std::function<double(const Times&)>& part) {
  double least = part(all.front());
  for (const Times& times : all) least = std::min(least, part(times));
  return least;
}

double median(std::vector<Times> all) {
  std::sort(all.begin(), all.end(), [](const Times& a, const Times& b) { return a.total() < b.total(); });
  return all[all.size() / 2].total();
}

}  // namespace

int main(int argc, char** argv) {
  core::prefer_fitting_blas_kernels(argv);
  CLI::App program("What a task costs one rank and a team of all ranks");
  int rounds = 10;
  program.add_option("--rounds", rounds, "Tasks of each kind")->capture_default_str();
  CLI11_PARSE(program, argc, argv);
  const core::Session session;
  core::Team team(MPI_COMM_WORLD);
  if (team.leads())
    fmt::print("{:>4} {:>5} {:>11} {:>11} {:>11} {:>11} {:>11}   (least of {} rounds, ms; median of the total)\n", "n",
               "ranks", "orbits", "multipliers", "triplets", "total", "median", rounds);
  for (const int dimension : {8, 16, 32, 64}) {
    const auto chain = std::make_shared<const test::OscillatorChain>(dimension / 2);
    std::vector<Times> alone;
    std::vector<Times> shared;
    for (int round = 0; round < rounds; ++round) {
      if (team.leads()) alone.push_back(do_task(chain, nullptr));
      wait_for_all(MPI_COMM_WORLD);
      shared.push_back(do_task(chain, &team));
      wait_for_all(MPI_COMM_WORLD);
    }
    if (!team.leads()) continue;
    for (const auto* all : {&alone, &shared})
      fmt::print("{:>4} {:>5} {:>11.2f} {:>11.2f} {:>11.2f} {:>11.2f} {:>11.2f}\n", dimension,
                 all == &alone ? 1 : team.size(), 1e3 * least(*all, [](const Times& t) { return t.continuation; }),
                 1e3 * least(*all, [](const Times& t) { return t.multipliers; }),
                 1e3 * least(*all, [](const Times& t) { return t.triplets; }),
                 1e3 * least(*all, [](const Times& t) { return t.total(); }), 1e3 * median(*all));
  }
  return 0;
}
