#include "orbweaver/survey/survey.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <system_error>

#include <fmt/format.h>
#include <sys/resource.h>

#include "display.hpp"
#include "executor.hpp"
#include "family_tree.hpp"
#include "naming.hpp"
#include "orbweaver/archive/consolidate.hpp"
#include "orbweaver/continuation/fixed_points.hpp"
#include "orbweaver/core/check.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/core/log.hpp"
#include "orbweaver/queue/run.hpp"
#include "orbweaver/survey/version.hpp"
#include "recorders.hpp"
#include "segment_flusher.hpp"
#include "teams.hpp"
#include "time_limit.hpp"

namespace orbweaver::survey {

namespace {

using Clock = std::chrono::steady_clock;

double peak_memory_mib() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

archive::Header header_of(const scene::Scene& scene, const systems::Description& system) {
  archive::Header header;
  header.orbweaver_version = version();
  header.scene = scene.text;
  header.state_names = system.state_names;
  header.winding_names = system.winding_names;
  header.pairs = system.pairs();
  header.symplectic = system.symplectic;
  return header;
}

std::vector<queue::Task> sweep_tasks(const scene::Scene& scene, const systems::System& system) {
  std::vector<queue::Task> tasks;
  for (const std::vector<double>& point : continuation::find_fixed_points(system, scene.fixed_points.grid))
    tasks.push_back(task_of(SweepWork{static_cast<int>(tasks.size()), point}));
  core::log_info(fmt::format("{} equilibria; sweeping the period from {:g} to {:g} at each", tasks.size(),
                             scene.sweep.period_from, scene.sweep.period_to));
  if (tasks.empty())
    throw core::InputError(
        "Newton's method finds no equilibrium from starts.fixed_points.grid: give start values nearer to one");
  return tasks;
}

// Families in the order of their keys: equilibria sorted, longest period first; no more than the scene allows.
std::vector<queue::Task> branch_tasks(const scene::Scene& scene, const systems::Description& system,
                                      const SweepRecorder& sweeps, Summary& summary) {
  std::vector<queue::Task> tasks;
  for (const auto& [key, ended] : sweeps.ended()) {
    const auto& [task, outcome] = ended;
    if (outcome.failed) continue;  // gather_failed_sweeps
    const SweepOutcome found = unpack_sweep_outcome(outcome.payload);
    if (found.modes.empty() && found.rejected.empty())
      summary.remarks.push_back(fmt::format("no small oscillations around {} for T in [{:g}, {:g}]",
                                            point_text(system, found.point), scene.sweep.period_from,
                                            scene.sweep.period_to));
    for (const std::string& reason : found.rejected)
      summary.remarks.push_back(fmt::format("dip passed over at {}: {}", point_text(system, found.point), reason));
    for (std::size_t n = 0; n < found.modes.size(); ++n) {
      const std::string name = base_name(scene, system, found.point, found.index, static_cast<int>(n));
      const std::string branch_key = fmt::format("{:04}.{:04}", found.index, n);
      const FoundMode& mode = found.modes[n];
      BranchWork work;
      work.key = work.lineage.family = branch_key;
      work.name = name;
      work.direction = mode.direction;
      work.isotropy = mode.isotropy;
      work.base = record_of(loop::constant_loop(found.point, mode.period, mode.cutoff));
      if (mode.one_direction) {
        tasks.push_back(task_of(work));
        continue;
      }
      work.key = work.lineage.family = branch_key + "+";
      tasks.push_back(task_of(work));
      work.key = work.lineage.family = branch_key + "-";
      work.name += " (other side)";
      for (double& v : work.direction) v = -v;
      tasks.push_back(task_of(work));
    }
  }
  const auto allowed = static_cast<std::size_t>(scene.limits.families);
  if (tasks.size() > allowed) {
    summary.remarks.push_back(fmt::format("{} families found, {} followed (limits.families)", tasks.size(), allowed));
    tasks.resize(allowed);
  }
  return tasks;
}

// An equilibrium whose sweep failed is a family without orbits, so that the archive says so.
void gather_failed_sweeps(const systems::Description& system, const SweepRecorder& sweeps, Summary& summary,
                          archive::Records& tables) {
  for (const auto& [key, ended] : sweeps.ended()) {
    const auto& [task, outcome] = ended;
    if (!outcome.failed) continue;
    const SweepWork work = unpack_sweep_work(task.payload);
    archive::FamilyRecord record;
    record.key = fmt::format("{:04}", work.index);
    record.name = fmt::format("Equilibrium {}", work.index + 1);
    record.end_reason =
        limited(fmt::format("failure (the sweep at {}: {})", point_text(system, work.point), outcome.reason));
    summary.families.push_back({record.key, record.name, "", 0, 0.0, 0.0, 0.0, 0.0, record.end_reason, true});
    summary.failed_tasks.push_back(fmt::format("{}: {}", key, outcome.reason));
    tables.families.push_back(std::move(record));
  }
}

// Segments of a survey that is begun anew; nothing else in the folder is touched.
void remove_segments(const std::filesystem::path& folder) {
  std::error_code ignored;  // what stays behind is overwritten or does no harm
  for (const auto& entry : std::filesystem::directory_iterator(folder, ignored))
    if (entry.path().filename().string().starts_with("segment-")) std::filesystem::remove(entry.path(), ignored);
}

void make_folder(const core::Communicator& comm, const std::filesystem::path& folder) {
  std::string problem;
  if (comm.is_root()) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) problem = error.message();
    remove_segments(folder);
  }
  int failed = problem.empty() ? 0 : 1;
  core::check_mpi(MPI_Bcast(&failed, 1, MPI_INT, 0, comm.get()), "MPI_Bcast");
  if (failed != 0)
    throw core::EnvironmentError(fmt::format("cannot create the folder {}{}{}: give -o a place where you may write",
                                             folder.string(), problem.empty() ? "" : ": ", problem));
}

// Rank 0's answer, on all ranks.
bool agreed(const core::Communicator& comm, bool answer) {
  int number = answer ? 1 : 0;
  core::check_mpi(MPI_Bcast(&number, 1, MPI_INT, 0, comm.get()), "MPI_Bcast");
  return number != 0;
}

// Failures of what stays in the archive, the same number on all ranks.
std::size_t agreed_failures(const core::Communicator& comm, const Summary& summary) {
  auto failures = static_cast<unsigned long>(summary.failed_tasks.size());
  core::check_mpi(MPI_Bcast(&failures, 1, MPI_UNSIGNED_LONG, 0, comm.get()), "MPI_Bcast");
  return failures;
}

void gather_memory(const core::Communicator& comm, Summary& summary) {
  const double mine = peak_memory_mib();
  summary.peak_memory_mib.resize(static_cast<std::size_t>(comm.size()));
  core::check_mpi(MPI_Gather(&mine, 1, MPI_DOUBLE, summary.peak_memory_mib.data(), 1, MPI_DOUBLE, 0, comm.get()),
                  "MPI_Gather");
}

// The survey of rank 0 and the leaders of teams, who are `comm`.
Summary lead_survey(const core::Communicator& comm, const scene::Scene& scene,
                    const std::shared_ptr<const systems::System>& system, const std::filesystem::path& directory,
                    Display display, core::Team* team) {
  const auto began = Clock::now();
  Summary summary;
  const archive::Header header = header_of(scene, system->description());
  const std::filesystem::path segments = directory / "segments";
  make_folder(comm, segments);

  archive::Records rows;
  Executor member(scene, system, rows, team);
  TeamExecutor executor(team, member);
  SegmentFlusher flusher(comm, segments, header, rows);
  ProgressDisplay progress(display);
  queue::Options options;
  options.flush_seconds = scene.output.flush_seconds;
  options.flush_rows = scene.output.flush_orbits;
  if (std::isfinite(scene.limits.task_time)) options.task_seconds = scene.limits.task_time;

  TimeLimit time(scene.limits.time);
  SweepRecorder sweeps(progress, time);
  // On every rank, so that a field that is not finite on the grid is the same error everywhere.
  const queue::RunSummary swept = queue::run(comm, options, sweep_tasks(scene, *system), executor, sweeps, flusher);
  FamilyTree tree(scene, system->description());
  TreeRecorder branches(progress, time, tree);
  queue::RunSummary followed = queue::run(comm, options, branch_tasks(scene, system->description(), sweeps, summary),
                                          executor, branches, flusher);
  while (!followed.stopped_early) {
    std::vector<queue::Task> tasks = comm.is_root() ? branches.wanted_after_all() : std::vector<queue::Task>{};
    if (!agreed(comm, !tasks.empty())) break;
    followed = queue::run(comm, options, std::move(tasks), executor, branches, flusher);
  }
  if (time.reached()) summary.remarks.push_back(time.remark(followed));
  for (const std::string& key : followed.put_aside)
    summary.remarks.push_back(
        fmt::format("put aside after limits.task_time = {:g} s: {}", scene.limits.task_time, key));

  FamilyTree::Result found = tree.resolve();
  archive::Records& tables = found.tables;
  summary.families = std::move(found.families);
  for (std::string& failure : found.failures) summary.failed_tasks.push_back(std::move(failure));
  for (std::string& remark : found.remarks) summary.remarks.push_back(std::move(remark));
  for (const FamilySummary& family : summary.families) summary.orbits += family.orbits;
  summary.crossings = static_cast<long>(tables.crossings.size());
  gather_failed_sweeps(system->description(), sweeps, summary, tables);
  summary.atlas = directory / "atlas.h5";
  archive::consolidate(comm.get(), flusher.segments(), summary.atlas, header, tables);
  if (comm.is_root()) {
    remove_segments(segments);
    std::error_code ignored;  // not empty: somebody else's files
    std::filesystem::remove(segments, ignored);
  }
  summary.failures = agreed_failures(comm, summary);
  summary.stopped_early = swept.stopped_early || followed.stopped_early;
  summary.seconds = std::chrono::duration<double>(Clock::now() - began).count();
  return summary;
}

Summary follow_survey(const scene::Scene& scene, const std::shared_ptr<const systems::System>& system,
                      core::Team& team) {
  archive::Records rows;
  Executor member(scene, system, rows, &team);
  return follow(team, member, rows);
}

}  // namespace

Summary run_survey(const core::Communicator& comm, const scene::Scene& scene,
                   const std::shared_ptr<const systems::System>& system, const std::filesystem::path& directory,
                   Display display) {
  Teams teams(comm, scene.survey.team_size);
  Summary summary;
  if (teams.follows()) {
    summary = follow_survey(scene, system, *teams.team());
  } else {
    try {
      summary = lead_survey(teams.queue(), scene, system, directory, display, teams.team());
    } catch (...) {
      dismiss(teams.team(), std::current_exception());
      throw;
    }
    dismiss(teams.team(), summary);
  }
  if (comm.size() == 1 && scene.survey.team_size > 1)
    summary.remarks.push_back(
        fmt::format("survey.team_size = {} needs more ranks: this one did every task alone", scene.survey.team_size));
  gather_memory(comm, summary);
  return summary;
}

}  // namespace orbweaver::survey
