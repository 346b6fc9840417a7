#include <chrono>
#include <exception>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "command.hpp"
#include "common_options.hpp"
#include "duration.hpp"
#include "failure.hpp"
#include "orbweaver/core/command_line.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/core/mpi/collective.hpp"
#include "orbweaver/core/mpi/communicator.hpp"
#include "orbweaver/core/pause.hpp"
#include "orbweaver/core/petsc/session.hpp"
#include "orbweaver/report/summary_text.hpp"
#include "orbweaver/survey/run/expected_work.hpp"
#include "orbweaver/survey/run/survey.hpp"
#include "orbweaver/survey/state/directory_status.hpp"
#include "orbweaver/systems/registry.hpp"
#include "result_stream.hpp"
#include "same_input.hpp"
#include "signals.hpp"
#include "summary_status.hpp"
#include "unused_options.hpp"

namespace orbweaver::drivers {

namespace {

struct SurveyOptions {
  SceneOptions scene;
  LogOptions log;
  std::filesystem::path directory;
  bool resume = false;
  std::optional<std::string> walltime;
  std::string progress = "auto";
};

std::string how_to_go_on(const SurveyOptions& options, const Invocation& invocation) {
  const std::string signal = stop_signal();
  std::vector<std::string> words{"survey", options.scene.file.string()};
  for (const std::string& setting : options.scene.overrides) words.insert(words.end(), {"--set", setting});
  words.insert(words.end(), {"-o", options.directory.string(), "--resume"});
  if (!invocation.petsc_options.empty()) words.emplace_back("--");
  words.insert(words.end(), invocation.petsc_options.begin(), invocation.petsc_options.end());
  return fmt::format("stopped{}; the survey goes on, on any number of ranks, with\n  {}\n",
                     signal.empty() ? "" : " by " + signal, core::command_line(words));
}

int survey_on(const core::Communicator& comm, const SurveyOptions& options, const Invocation& invocation,
              std::chrono::steady_clock::time_point began) {
  scene::Scene scene;
  std::shared_ptr<const systems::System> system;
  survey::DirectoryStatus status = survey::DirectoryStatus::none;
  survey::RunOptions run_options{display_of(options.log, options.progress), options.resume};
  run_options.began = began;
  agree(comm, [&] {
    scene = options.scene.load();
    system = scene::bound_system(scene.system);
    survey::require_memory(survey::expected_work(scene, *system));
    if (options.walltime) run_options.walltime = seconds_of(*options.walltime);
  });
  require_same_input(comm, scene.text + scene.model);
  stop_on_signals();  // again, whatever MPI and PETSc made of them
  agree(comm, [&] {
    if (!comm.is_root()) return;  // folders need not look alike from every machine
    status = survey::status_of(options.directory, scene);
    survey::require_startable(status, options.directory, options.resume);
  });
  status = core::agreed(comm.get(), status);
  if (status == survey::DirectoryStatus::finished || status == survey::DirectoryStatus::finished_with_failures) {
    const bool failed = status == survey::DirectoryStatus::finished_with_failures;
    if (comm.is_root())
      print_result(fmt::format("{} holds this survey, finished{}: nothing to do\n", options.directory.string(),
                               failed
                                   ? fmt::format(", with failures ({} says which)",
                                                 core::command_line({"show", options.directory.string(), "findings"}))
                                   : ""));
    return static_cast<int>(failed ? core::ExitStatus::goal_missed : core::ExitStatus::done);
  }
  const survey::Summary summary =
      alike_on_all_ranks(comm, [&] { return survey::run_survey(comm, scene, system, options.directory, run_options); });
  agree(comm, [&] {
    if (!comm.is_root()) return;
    ResultStream out;
    report::print(out, summary, options.log.verbose ? report::Detail::all : report::Detail::brief);
    if (summary.stopped_early) out << how_to_go_on(options, invocation);
    out.finish();
  });
  return static_cast<int>(status_of(summary));
}

int run(const SurveyOptions& options, const Invocation& invocation) {
  const auto began = std::chrono::steady_clock::now();
  stop_on_signals();
  const core::Session session(invocation.petsc_options);
  const core::Communicator comm;
  core::start_logging(options.log.level(), comm.rank(), comm.size());
  core::pause_point("begin survey");
  try {
    return run_on_ranks(comm, [&] {
      const int status = survey_on(comm, options, invocation, began);
      warn_of_unused_options(session, comm);
      return status;
    });
  } catch (
      // reported before MPI ends: mpirun kills a job when its first rank exits, maybe before another has printed
      ...) {
    return report_failure(std::current_exception());
  }
}

}  // namespace

Command make_survey_command(CLI::App& program) {
  const auto options = std::make_shared<SurveyOptions>();
  CLI::App* parser =
      program.add_subcommand("survey", "Find, follow and archive the families of a scene (under mpirun or alone)");
  add_scene_options(*parser, options->scene);
  parser->add_option("-o,--output", options->directory, "Folder for the archive, atlas.h5")
      ->required()
      ->check(named_path());
  parser->add_flag("--resume", options->resume,
                   "Go on with the survey in the folder, if there is one; limits may have become wider");
  parser->add_option("--walltime", options->walltime,
                     "Stop before this time is over, resumable: seconds, M:SS or H:MM:SS");
  parser
      ->add_option(
          "--progress", options->progress,
          "live: a bar and a line a family, redrawn; lines: plain lines now and then; auto: live on a terminal")
      ->check(CLI::IsMember({"auto", "live", "lines"}))
      ->capture_default_str();
  add_log_options(*parser, options->log);
  add_examples(*parser, {"mpirun -n 2 orbweaver survey drivers/scenes/double_pendulum.yaml -o out/double_pendulum",
                         "mpirun -n 2 orbweaver survey drivers/scenes/double_pendulum.yaml -o out/double_pendulum "
                         "--resume --set limits.period=20"});
  return {parser, [options](const Invocation& invocation) { return run(*options, invocation); }, true, true};
}

}  // namespace orbweaver::drivers
