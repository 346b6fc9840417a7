#include "ranks.hpp"

#include <algorithm>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <mpi.h>

#include "correction.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/core/mpi/check_mpi.hpp"
#include "orbweaver/core/mpi/collective.hpp"
#include "orbweaver/core/mpi/team.hpp"
#include "orbweaver/core/output_file.hpp"
#include "orbweaver/spectrum/floquet.hpp"
#include "orbweaver/survey/run/survey.hpp"
#include "timing.hpp"

namespace orbweaver::cost {

namespace {

/// Whole loops with so many harmonics: what teams are for.
constexpr int team_cutoff = 1000;
constexpr int quick_team_cutoff = 300;
constexpr int team_repetitions = 5;
constexpr double usual_tolerance = 1e-10;

/// The first ranks of a communicator; none on the others. Collective.
std::optional<core::Communicator> first_ranks(const core::Communicator& comm, int count) {
  MPI_Comm part = MPI_COMM_NULL;
  core::check_mpi(MPI_Comm_split(comm.get(), comm.rank() < count ? 0 : MPI_UNDEFINED, comm.rank(), &part),
                  "MPI_Comm_split");
  if (part == MPI_COMM_NULL) return std::nullopt;
  std::optional<core::Communicator> own(part);
  core::check_mpi(MPI_Comm_free(&part), "MPI_Comm_free");
  return own;
}

/// Patiences that a survey may take.
constexpr double of_survey = 3.0;

void survey_with(const Setting& setting, const core::Communicator& part, int count, Table& table) {
  std::optional<core::TemporaryFolder> own;
  core::on_root(part.get(), [&] { own.emplace(); });
  const std::filesystem::path folder = core::agreed(part.get(), own ? own->path().string() : std::string());
  const double most = std::min(setting.asked().limits.time, of_survey * setting.patience());
  const scene::Scene bases =
      scene::parse(setting.asked().text, "the scene", {"survey.depth=0", fmt::format("limits.time={}", most)});
  survey::Summary summary;
  const double seconds =
      seconds_of([&] { summary = survey::run_survey(part, bases, setting.plain(), folder, {survey::Display::none}); });
  if (!part.is_root()) return;
  table.rows.push_back({"survey", count, static_cast<double>(summary.orbits), seconds, {}});
  if (summary.stopped_early)
    table.remarks.push_back(fmt::format("the survey on {} ranks was stopped after {:g} s", count, most));
}

/// Each time with a barrier before it: members that come late would be waited for.
double median_together(const core::Communicator& part, const std::function<void()>& work) {
  std::vector<double> times;
  for (int n = 0; n <= team_repetitions; ++n) {
    core::check_mpi(MPI_Barrier(part.get()), "MPI_Barrier");
    const double seconds = seconds_of(work);
    if (n > 0) times.push_back(seconds);  // the first one warms up
  }
  std::nth_element(times.begin(), times.begin() + team_repetitions / 2, times.end());
  return times[team_repetitions / 2];
}

void team_with(const Setting& setting, const core::Communicator& part, int count, Table& table) {
  core::Team team(part.get());
  const Probe& probe = setting.probes().back();
  const int cutoff = loop::allowed_cutoff_at_least(setting.quick() ? quick_team_cutoff : team_cutoff);
  const Correction correction(setting, expanded(probe, probe.orbit.loop.time_map, cutoff), {});
  const double newton = median_together(
      part, [&] { static_cast<void>(correction.by(corrector::Method::newton_krylov, usual_tolerance, 0, &team)); });
  spectrum::FloquetOptions options;
  options.team = &team;
  const double stability = median_together(part, [&] {
    static_cast<void>(spectrum::floquet(*setting.system(), probe.orbit.loop, setting.isotropy(), options));
  });
  if (!part.is_root()) return;
  table.rows.push_back({"whole loop, newton-krylov", count, cutoff, newton, {}});
  table.rows.push_back({"stability", count, probe.orbit.loop.cutoff, stability, {}});
}

/// How many times quicker than one rank; a survey by its orbits a second.
void add_speedups(Table& table) {
  for (std::vector<Cell>& row : table.rows)
    for (const std::vector<Cell>& first : table.rows)
      if (first[0].words == row[0].words && first[1].number == 1.0)
        row[4] = first[3].number / row[3].number * row[2].number / first[2].number;
}

void measure_ranks(const Setting& setting, const Take& take) {
  Table table{"ranks",
              fmt::format("{}: ranks for a survey, teams for one orbit", setting.family()),
              {{"what"}, {"ranks"}, {"orbits or K"}, {"time", "s"}, {"times quicker"}},
              {},
              {},
              Plot{1, 3, {0}, {}}};
  for (int count = 1; count <= setting.comm().size(); ++count) {
    const std::optional<core::Communicator> part = first_ranks(setting.comm(), count);
    core::collectively(setting.comm().get(), [&] {
      if (!part) return;
      survey_with(setting, *part, count, table);
      team_with(setting, *part, count, table);
    });
  }
  if (!setting.comm().is_root()) return;
  add_speedups(table);
  if (setting.comm().size() == 1)
    table.remarks.emplace_back("one rank only: start under mpirun -n 2 (or more) to see what ranks and teams bring");
  table.remarks.emplace_back("survey: the scene's base families; the others: at the end probe");
  take(table);
}

}  // namespace

const Ladder ranks_ladder{"ranks", "ranks for a survey, teams for one orbit", measure_ranks, true};

}  // namespace orbweaver::cost
