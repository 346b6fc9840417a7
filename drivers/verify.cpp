#include <chrono>
#include <exception>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "command.hpp"
#include "common_options.hpp"
#include "failure.hpp"
#include "orbweaver/core/mpi/collective.hpp"
#include "orbweaver/core/mpi/communicator.hpp"
#include "orbweaver/core/output_file.hpp"
#include "orbweaver/core/petsc/session.hpp"
#include "orbweaver/prove/proof_file.hpp"
#include "orbweaver/report/proof_text.hpp"
#include "orbweaver/report/verify_text.hpp"
#include "orbweaver/survey/verify/verify.hpp"

namespace orbweaver::drivers {

namespace {

struct VerifyOptions {
  LogOptions log;
  std::filesystem::path atlas;
  bool margins = false;
  bool prove = false;
  std::vector<std::string> orbits;  // with prove: FAMILY ORBIT, FAMILY ORBIT, ...
  int digits = 30;
  std::filesystem::path output;
};

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void require_options_fit(const VerifyOptions& options) {
  const bool is_proofs = prove::is_proofs_file(options.atlas);
  if (is_proofs && (options.prove || options.margins))
    throw core::InputError("a file of proofs is checked without options");
  if (!options.prove && (!options.orbits.empty() || !options.output.empty()))
    throw core::InputError("expected --prove before orbits to be proven and a file for their proofs");
  if (options.orbits.size() % 2 != 0 || (options.prove && options.orbits.empty()))
    throw core::InputError(
        "expected FAMILY and ORBIT (a step, T=.., E=.. or PARAMETER=..) for each orbit to be proven");
}

/// Proves orbits of an archive, one after the other; what cannot be proven does not stop the others.
bool prove_orbits(const VerifyOptions& options) {
  if (!options.output.empty()) {
    core::require_output_file(options.output, options.atlas);
    if (std::filesystem::exists(options.output) && !std::filesystem::is_regular_file(options.output))
      throw core::InputError(fmt::format("cannot write {}: proofs need a file", options.output.string()));
  }
  const archive::Archive atlas(options.atlas);
  std::vector<prove::Proof> proofs;
  std::vector<double> seconds;
  for (std::size_t n = 0; n < options.orbits.size(); n += 2) {
    const auto start = std::chrono::steady_clock::now();
    try {
      proofs.push_back(
          prove::prove(prove::statement_about(atlas, options.orbits[n], options.orbits[n + 1], options.digits)));
      seconds.push_back(seconds_since(start));
      print_result(report::to_text(proofs.back()));
    } catch (const core::NumericalError& failure) {
      print_result(fmt::format("{}, {}: not proven: {}\n", options.orbits[n], options.orbits[n + 1], failure.what()));
    }
  }
  if (!proofs.empty()) print_result("\n" + report::proofs_table(proofs, seconds));
  if (!options.output.empty()) prove::write_proofs(options.output, proofs);
  return 2 * proofs.size() == options.orbits.size();
}

/// Proves again what a file of proofs claims, from its statements alone.
bool check_proofs(const std::filesystem::path& path) {
  const std::vector<prove::Proof> proofs = prove::read_proofs(path);
  const auto start = std::chrono::steady_clock::now();
  std::size_t failed = 0;
  for (std::size_t row = 0; row < proofs.size(); ++row) {
    const std::vector<std::string> missing = prove::check(proofs[row]);
    for (const std::string& what : missing) print_result(fmt::format("/proofs row {}: {}\n", row, what));
    if (!missing.empty()) ++failed;
  }
  print_result(report::proofs_table(proofs, {}));
  print_result(fmt::format("{}: {} proofs: {}; {:.2f} s\n", path.string(), proofs.size(),
                           failed == 0 ? "all hold" : fmt::format("{} do not hold", failed), seconds_since(start)));
  return failed == 0;
}

int verify_on(const core::Communicator& comm, const VerifyOptions& options) {
  agree(comm, [&] { require_options_fit(options); });
  bool is_proven = false;
  const bool proves = options.prove || prove::is_proofs_file(options.atlas);
  agree(comm, [&] {  // by rank 0 alone
    if (proves && comm.is_root()) is_proven = options.prove ? prove_orbits(options) : check_proofs(options.atlas);
  });
  if (proves)
    return static_cast<int>(core::agreed(comm.get(), is_proven) ? core::ExitStatus::done
                                                                : core::ExitStatus::goal_missed);
  const survey::Verification found =
      alike_on_all_ranks(comm, [&] { return survey::verify(comm, options.atlas, display_of(options.log)); });
  agree(comm, [&] {
    if (comm.is_root()) print_result(report::to_text(found, options.atlas, options.margins));
  });
  const bool holds = core::agreed(comm.get(), found.holds());
  return static_cast<int>(holds ? core::ExitStatus::done : core::ExitStatus::goal_missed);
}

int run(const VerifyOptions& options, const Invocation& invocation) {
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
  const auto options = std::make_shared<VerifyOptions>();
  CLI::App* parser = program.add_subcommand(
      "verify", "Compute an atlas again from its modes alone and say what does not hold (under mpirun or alone)");
  parser->add_option("ATLAS", options->atlas, "The atlas.h5 of a survey, or the survey's folder, or a file of proofs")
      ->required();
  parser->add_flag("--prove", options->prove, "Prove orbits instead: enclose them by ball arithmetic");
  parser->add_option("ORBITS", options->orbits,
                     "With --prove: FAMILY T=PERIOD|E=ENERGY|PARAMETER=VALUE|STEP, for each orbit");
  parser->add_option("-n,--digits", options->digits, "With --prove: digits aimed at")->capture_default_str();
  parser->add_option("-o,--output", options->output, "With --prove: a file for the proofs, which verify checks again")
      ->check(named_path());
  parser->add_flag("--margins", options->margins, "Say how near each column came to what is allowed");
  add_log_options(*parser, options->log);
  add_examples(*parser, {"mpirun -n 2 orbweaver verify out/double_pendulum/atlas.h5",
                         "orbweaver verify out/double_pendulum/atlas.h5 --prove In-Phase T=9 -o proofs.h5",
                         "orbweaver verify proofs.h5"});
  return {parser, [options](const Invocation& invocation) { return run(*options, invocation); }, false, true};
}

}  // namespace orbweaver::drivers
