#include <exception>
#include <filesystem>
#include <memory>

#include "command.hpp"
#include "common_options.hpp"
#include "failure.hpp"
#include "orbweaver/core/mpi/collective.hpp"
#include "orbweaver/core/mpi/communicator.hpp"
#include "orbweaver/core/petsc/session.hpp"
#include "orbweaver/report/verify_text.hpp"
#include "orbweaver/survey/verify/verify.hpp"

namespace orbweaver::drivers {

namespace {

struct Options {
  LogOptions log;
  std::filesystem::path atlas;
  bool margins = false;
};

int verify_on(const core::Communicator& comm, const Options& options) {
  const survey::Verification found = alike_on_all_ranks(comm, [&] { return survey::verify(comm, options.atlas); });
  agree(comm, [&] {
    if (comm.is_root()) print_result(report::to_text(found, options.atlas, options.margins));
  });
  const bool holds = core::agreed(comm.get(), found.holds());
  return static_cast<int>(holds ? core::ExitStatus::done : core::ExitStatus::goal_missed);
}

int run(const Options& options, const Invocation& invocation) {
  const core::Session session(invocation.petsc_options);
  const core::Communicator comm;
  core::start_logging(options.log.level(), comm.rank(), comm.size());
  try {
    return run_on_ranks(comm, [&] { return verify_on(comm, options); });
  } catch (...) {  // as in survey.cpp
    return report_failure(std::current_exception());
  }
}

}  // namespace

Command make_verify_command(CLI::App& program) {
  const auto options = std::make_shared<Options>();
  CLI::App* parser = program.add_subcommand(
      "verify", "Compute an atlas again from its modes alone and say what does not hold (under mpirun or alone)");
  parser->add_option("ATLAS", options->atlas, "The atlas.h5 of a survey")->required();
  parser->add_flag("--margins", options->margins, "Say how near each column came to what is allowed");
  add_log_options(*parser, options->log);
  return {parser, [options](const Invocation& invocation) { return run(*options, invocation); }};
}

}  // namespace orbweaver::drivers
