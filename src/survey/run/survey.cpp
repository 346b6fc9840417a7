#include "orbweaver/survey/run/survey.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <memory>
#include <set>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <sys/resource.h>

#include "archive_writer.hpp"
#include "display.hpp"
#include "orbweaver/archive/file/folder_lock.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/core/log/log.hpp"
#include "orbweaver/core/mpi/collective.hpp"
#include "orbweaver/core/petsc/check.hpp"
#include "orbweaver/core/survey_folder.hpp"
#include "orbweaver/queue/run.hpp"
#include "orbweaver/queue/stop.hpp"
#include "orbweaver/survey/run/scaled_scene.hpp"
#include "segment_flusher.hpp"
#include "state/checkpoint_keeper.hpp"
#include "state/payload_store.hpp"
#include "state/resume.hpp"
#include "storing_executor.hpp"
#include "tasks/executor.hpp"
#include "tasks/recorders.hpp"
#include "teams.hpp"
#include "time_limit.hpp"
#include "tree/base_families.hpp"
#include "tree/family_tree.hpp"
#include "version.hpp"

namespace orbweaver::survey {

namespace {

using Clock = std::chrono::steady_clock;

double peak_memory_mib() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

void gather_memory(const core::Communicator& comm, Summary& summary) {
  const double mine = peak_memory_mib();
  summary.peak_memory_mib.resize(static_cast<std::size_t>(comm.size()));
  core::check_mpi(MPI_Gather(&mine, 1, MPI_DOUBLE, summary.peak_memory_mib.data(), 1, MPI_DOUBLE, 0, comm.get()),
                  "MPI_Gather");
}

void make_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error)
    throw core::EnvironmentError(fmt::format("cannot create the folder {}: {}: give -o a place where you may write",
                                             folder.string(), error.message()));
}

/// A survey from where it stands, which is known on rank 0, to its end or to a stop; by rank 0 and the leaders of
/// teams.
class Run {
 public:
  Run(const core::Communicator& comm, const scene::Scene& scene, const ScaledScene& scaled,
      const std::filesystem::path& directory, const RunOptions& options, core::Team* team)
      : _comm(comm),
        _scene(scene),
        _scaled(scaled),
        _system(scaled.system()),
        _folder(state_folder(directory)),
        _header(header_of(scene, *_system)),
        _store(_folder),
        _member(scaled.scene(), _system, _rows, team, &_store),
        _team(team, _member),
        _executor(_store, _team),
        _display(options.display, Units(*_system), std::min(scene.limits.time, options.walltime)),
        _began(options.began),
        _tree(scaled.scene(), _system->structure(), Units(*_system)) {
    _queue_options.flush_seconds = scene.output.flush_seconds;
    _queue_options.flush_rows = scene.output.flush_orbits;
    if (scene.survey.team_size > 1) {
      _queue_options.root_works_up_to = 1;  // rank 0 is in no team
      _queue_options.stop_seconds = 0.0;    // teams end the step that they are in, however long it takes
    }
    if (std::isfinite(scene.limits.task_time)) _queue_options.task_seconds = scene.limits.task_time;
    if (comm.is_root()) _time.emplace(scene.limits.time, options.walltime, _began);
    _summary.atlas = core::atlas_in(directory);
  }

  Summary run(bool resume) {
    begin(resume);
    try {
      if (core::agreed(_comm.get(), _start.stage == Stage::sweeps)) sweep();
      if (!_summary.stopped_early) follow();
      end();
    } catch (const core::EnvironmentError& error) {
      std::error_code ignored;
      const bool stands = std::filesystem::exists(checkpoint_path(_folder), ignored);
      throw core::EnvironmentError(
          fmt::format("{}\n{}", error.what(),
                      stands ? "The last checkpoint stands: --resume goes on from it."
                             : fmt::format("No checkpoint is in {} any more: bring the folder back from a copy, or "
                                           "begin anew.",
                                           _folder.string())));
    }
    _summary.seconds = std::chrono::duration<double>(Clock::now() - _began).count();
    return std::move(_summary);
  }

 private:
  /// Finds where the survey stands; every survey that has begun has a checkpoint.
  void begin(bool resume) {
    // On every rank, so that a wrong model is the same error everywhere; a resumed one may have changed since.
    std::vector<queue::Task> sweeps;
    // After limits.time, too: its survey has an archive.
    queue::do_interruptibly(
        "the search for starts", [this] { return queue::stop_requested() && !(_time && _time->reached()); },
        [&] { sweeps = sweep_tasks(_scaled.scene(), *_system); });
    core::on_root(_comm.get(), [&] {
      make_folder(_folder);
      _lock = archive::FolderLock(_folder);
    });
    Found found;
    if (resume) found = find_checkpoint(_comm, _folder);
    if (!found.found) core::on_root(_comm.get(), [&] { expect_nothing(resume); });
    core::on_root(_comm.get(), [&] {
      const bool again = found.found && begins_again(_scene, _system->scales(), _folder, found.checkpoint);
      if (again) core::log_info("limits.parameter is wider: the survey begins again");
      if (found.found && !again) {
        _start = std::move(found.checkpoint);
        _scaled.expect(_start.scales);
        continue_with(_scene, _folder, _start, [this](const EndedTask& entry) { restore(entry); });
        core::log_info(
            fmt::format("going on: {} segments, {} tasks waiting", _start.segments.size(), _start.unfinished.size()));
      } else {
        if (!again) remove_unlisted(_folder, {});  // of a survey that had not come to a checkpoint
        _start.scene = _scene.text;
        _start.model = _scene.model;
        _start.scales = _system->scales();
        _start.unfinished = std::move(sweeps);
        write_checkpoint(_folder, _start);
      }
      _start.orbweaver_version = version();
    });
    _keeper.emplace(_folder, _start);
    _store.open(_comm);
    _flusher.emplace(_comm, _folder, _header, _rows, _start.segments, _store);
  }

  /// A survey writes its first checkpoint before anything else.
  void expect_nothing(bool resume) const {
    const auto stands = [](const std::filesystem::path& path) {
      std::error_code ignored;
      return std::filesystem::symlink_status(path, ignored).type() != std::filesystem::file_type::not_found;
    };
    if (stands(checkpoint_path(_folder)) || stands(previous_checkpoint_path(_folder)))
      throw core::InputError(fmt::format("{} already holds a survey, and nothing was changed: --resume goes on with it",
                                         _folder.parent_path().string()));
    for (const auto& entry : std::filesystem::directory_iterator(_folder)) {
      const std::string name = entry.path().filename().string();
      if (resume && is_listed_kind(name) && !name.ends_with(".part"))
        throw core::InputError(fmt::format(
            "{} holds {} and no checkpoint, and nothing was changed: bring the checkpoint back from a copy, or "
            "give another folder with -o",
            _folder.string(), name));
    }
  }

  void restore(const EndedTask& entry) {
    if (kind_of(entry.task) == TaskKind::sweep)
      _sweeps_ended.insert_or_assign(entry.task.key, std::pair(entry.task, entry.outcome));
    else
      _tree.add(entry.task, entry.outcome);
    _known.insert(entry.task.key);
  }

  void sweep() {
    SweepRecorder recorder({_display, *_keeper, *_flusher}, _sweeps_ended);
    const queue::RunSummary swept =
        queue::run(_comm, _queue_options, std::move(_start.unfinished), _executor, recorder, *_flusher);
    _start.unfinished.clear();
    note_stop(swept);
  }

  void follow() {
    TreeRecorder recorder({_display, *_keeper, *_flusher}, _tree, std::move(_start.left_out));
    std::vector<queue::Task> tasks = std::move(_start.unfinished);
    std::string given;
    core::on_root(_comm.get(), [&] {
      _keeper->set_stage(Stage::families);
      for (const queue::Task& task : tasks) _known.insert(task.key);
      for (const queue::Task& task : recorder.left_out_tasks()) _known.insert(task.key);
      BaseFamilies base = base_families(_scaled.scene(), *_system, _sweeps_ended, _summary);
      for (queue::Task& task : base.tasks)
        if (!_known.contains(task.key)) tasks.push_back(std::move(task));
      given = pack(base.given);
    });
    given = core::agreed(_comm.get(), given);
    _member.expect(unpack_given_orbits(given));
    _team.expect(given);
    do {
      note_stop(queue::run(_comm, _queue_options, std::move(tasks), _executor, recorder, *_flusher));
      if (_summary.stopped_early) return;
      tasks.clear();
      core::on_root(_comm.get(), [&] { tasks = recorder.wanted_after_all(); });
    } while (core::agreed(_comm.get(), !tasks.empty()));
  }

  void note_stop(const queue::RunSummary& run) {
    _summary.stopped_early = run.stopped_early;
    if (!_comm.is_root() || !run.stopped_early) return;
    if (_time->reached())
      _summary.remarks.push_back(_time->remark(run));
    else if (queue::stop_requested())
      _summary.remarks.push_back(
          fmt::format("stopped as asked: tasks cut short: {}, not begun: {}", run.stopped, run.waiting - run.stopped));
    for (const std::string& key : run.put_aside)
      _summary.remarks.push_back(
          fmt::format("put aside after limits.task_time = {:g} s: {}", _scene.limits.task_time, key));
  }

  void end() {
    _display.finish();
    if (_time) _time->end();
    // After a signal or the wall time others wait for the machine.
    _summary.archived = core::agreed(_comm.get(), !_summary.stopped_early || (_time && _time->reached_scene()));
    write_archive(_comm, _scene, _system, _keeper->last(), _tree, _sweeps_ended, _summary);
    if (_summary.stopped_early) return;
    core::on_root(_comm.get(), [&] {
      _keeper->finish(_summary.failures);
      keep_needed_payloads(_folder, _keeper->last());
    });
  }

  const core::Communicator& _comm;
  const scene::Scene& _scene;  // as given
  const ScaledScene& _scaled;
  const std::shared_ptr<const systems::System>& _system;
  std::filesystem::path _folder;
  archive::Header _header;
  archive::Records _rows;
  PayloadStore _store;
  Executor _member;
  TeamExecutor _team;
  StoringExecutor _executor;
  ProgressDisplay _display;
  Clock::time_point _began;
  std::optional<TimeLimit> _time;  // on rank 0
  FamilyTree _tree;
  queue::Options _queue_options;
  archive::FolderLock _lock;  // on rank 0
  Checkpoint _start;          // on rank 0
  std::optional<CheckpointKeeper> _keeper;
  std::optional<SegmentFlusher> _flusher;
  SweepsEnded _sweeps_ended;
  std::set<std::string> _known;  // keys of tasks of an earlier run
  Summary _summary;
};

/// The part of a rank that follows a leader.
struct Follower {
  Follower(const ScaledScene& scaled, core::Team& team) : member(scaled.scene(), scaled.system(), rows, &team) {}

  archive::Records rows;
  Executor member;
};

}  // namespace

Summary run_survey(const core::Communicator& comm, const scene::Scene& scene,
                   const std::shared_ptr<const systems::System>& system, const std::filesystem::path& directory,
                   const RunOptions& options) {
  std::optional<ScaledScene> in_scales;
  queue::do_interruptibly("the choice of scales", queue::stop_requested, [&] { in_scales.emplace(scene, system); });
  const ScaledScene& scaled = *in_scales;
  Teams teams(comm, scene.survey.team_size);
  std::optional<Run> run;
  std::optional<Follower> follower;
  core::collectively(comm.get(), [&] {  // nobody begins unless all can
    if (teams.follows())
      follower.emplace(scaled, *teams.team());
    else
      run.emplace(teams.queue(), scene, scaled, directory, options, teams.team());
  });
  Summary summary;
  if (follower) {
    summary = follow(*teams.team(), follower->member, follower->rows,
                     [&](const std::string& given) { follower->member.expect(unpack_given_orbits(given)); });
  } else {
    try {
      summary = run->run(options.resume);
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
