#include <exception>
#include <filesystem>
#include <memory>

#include "command.hpp"
#include "common_options.hpp"
#include "failure.hpp"
#include "orbweaver/core/mpi/communicator.hpp"
#include "orbweaver/core/petsc/session.hpp"
#include "orbweaver/report/summary_text.hpp"
#include "orbweaver/survey/run/survey.hpp"
#include "result_stream.hpp"
#include "summary_status.hpp"
#include "unused_options.hpp"

namespace orbweaver::drivers {

namespace {

struct ConsolidateOptions {
  LogOptions log;
  std::filesystem::path directory;
};

int consolidate_on(const core::Communicator& comm, const ConsolidateOptions& options) {
  const survey::Summary summary =
      alike_on_all_ranks(comm, [&] { return survey::archive_survey(comm, options.directory); });
  agree(comm, [&] {
    if (!comm.is_root()) return;
    ResultStream out;
    report::print(out, summary, options.log.verbose ? report::Detail::all : report::Detail::brief);
    out.finish();
  });
  return static_cast<int>(status_of(summary));
}

int run(const ConsolidateOptions& options, const Invocation& invocation) {
  const core::Session session(invocation.petsc_options);
  const core::Communicator comm;
  core::start_logging(options.log.level(), comm.rank(), comm.size());
  try {
    return run_on_ranks(comm, [&] {
      const int status = consolidate_on(comm, options);
      warn_of_unused_options(session, comm);
      return status;
    });
  } catch (...) {  // as in survey.cpp
    return report_failure(std::current_exception());
  }
}

}  // namespace

Command make_consolidate_command(CLI::App& program) {
  const auto options = std::make_shared<ConsolidateOptions>();
  CLI::App* parser = program.add_subcommand(
      "consolidate", "Make the archive of what a survey that was broken off has come to (under mpirun or alone)");
  parser->add_option("directory", options->directory, "The folder of the survey")->required()->check(named_path());
  add_log_options(*parser, options->log);
  add_examples(*parser, {"mpirun -n 2 orbweaver consolidate out/double_pendulum"});
  return {parser, [options](const Invocation& invocation) { return run(*options, invocation); }, false, true};
}

}  // namespace orbweaver::drivers
