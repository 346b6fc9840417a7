#include "orbweaver/cost/ladders.hpp"

#include <algorithm>
#include <chrono>
#include <optional>
#include <thread>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "ladders/crossing.hpp"
#include "ladders/digits.hpp"
#include "ladders/features.hpp"
#include "ladders/ranks.hpp"
#include "ladders/resolution.hpp"
#include "ladders/solvers.hpp"
#include "ladders/tolerance.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/core/mpi/check_mpi.hpp"
#include "orbweaver/core/mpi/collective.hpp"
#include "setting.hpp"

namespace orbweaver::cost {

namespace {

// One line a ladder, in the order in which they are measured.
const Ladder* const ladders[] = {
    &resolution_ladder, &tolerance_ladder, &solvers_ladder, &features_ladder,
    &crossing_ladder,   &digits_ladder,    &ranks_ladder,
};

/// Other ranks sleep while rank 0 measures: one that polls would take a core.
constexpr std::chrono::milliseconds nap{2};

void wait_for_root(const core::Communicator& comm) {
  MPI_Request request = MPI_REQUEST_NULL;
  core::check_mpi(MPI_Ibarrier(comm.get(), &request), "MPI_Ibarrier");
  int done = 0;
  while (true) {
    core::check_mpi(MPI_Test(&request, &done, MPI_STATUS_IGNORE), "MPI_Test");
    if (done != 0) return;
    std::this_thread::sleep_for(nap);
  }
}

void check_names(const std::vector<std::string>& names) {
  std::vector<std::string_view> known;
  for (const Ladder* ladder : ladders) known.push_back(ladder->name);
  for (const std::string& name : names)
    if (std::find(known.begin(), known.end(), name) == known.end())
      throw core::InputError(fmt::format("expected ladders among {}, got `{}`", fmt::join(known, ", "), name));
}

}  // namespace

std::vector<LadderInfo> known_ladders() {
  std::vector<LadderInfo> out;
  for (const Ladder* ladder : ladders) out.push_back({ladder->name, ladder->about});
  return out;
}

void measure(const core::Communicator& comm, const scene::Scene& scene, const Options& options,
             const std::function<void(const Table&)>& take) {
  std::optional<Setting> setting;
  core::collectively(comm.get(), [&] {
    check_names(options.only);
    setting.emplace(comm, scene, options);
  });
  for (const Ladder* ladder : ladders) {
    const bool wanted =
        options.only.empty() || std::find(options.only.begin(), options.only.end(), ladder->name) != options.only.end();
    if (!wanted) continue;
    const core::Failure failure = core::attempt([&] {
      try {
        if (comm.is_root() || ladder->collective) ladder->measure(*setting, take);
      } catch (const core::NumericalError& error) {  // the other ladders may still be climbed
        if (!comm.is_root()) return;
        take({std::string(ladder->name),
              std::string(ladder->about),
              {},
              {},
              {fmt::format("not measured: {}", error.what())}});
      }
    });
    wait_for_root(comm);
    // A table that cannot be written ends the others too.
    if (const auto shared = core::share(comm.get(), failure)) core::raise(shared->failure);
  }
}

}  // namespace orbweaver::cost
