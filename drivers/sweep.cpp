#include <filesystem>
#include <memory>

#include "command.hpp"
#include "common_options.hpp"
#include "failure.hpp"
#include "orbweaver/core/mpi/communicator.hpp"
#include "orbweaver/core/output_file.hpp"
#include "orbweaver/core/petsc/session.hpp"
#include "orbweaver/report/sweep_report.hpp"
#include "unused_options.hpp"

namespace orbweaver::drivers {

namespace {

struct SweepOptions {
  SceneOptions scene;
  std::filesystem::path csv;
  bool table = false;
};

int run(const SweepOptions& options, const Invocation& invocation) {
  const scene::Scene scene = options.scene.load();
  const core::Session session(invocation.petsc_options);
  const core::Communicator comm;
  if (!comm.is_root()) return 0;  // not distributed: under mpirun rank 0 does it
  if (!options.csv.empty()) core::require_output_file(options.csv, options.scene.file);
  const auto reports = report::sweep_report(scene);
  print_result(report::to_text(reports));
  if (options.table) print_result("\n" + report::eigenvalue_table(reports));
  if (!options.csv.empty())
    core::write_output_file(options.csv, [&](std::ostream& file) { file << report::eigenvalue_csv(reports); });
  warn_of_unused_options(session, core::Communicator(MPI_COMM_SELF));
  return 0;
}

}  // namespace

Command make_sweep_command(CLI::App& program) {
  const auto options = std::make_shared<SweepOptions>();
  CLI::App* parser =
      program.add_subcommand("sweep", "Smallest eigenvalues against the period at the scene's fixed points");
  add_scene_options(*parser, options->scene);
  parser->add_flag("--table", options->table, "Print the smallest eigenvalue at every period of the sweep");
  parser->add_option("--csv", options->csv, "Write that table to a CSV file")->check(named_path());
  add_examples(*parser, {"orbweaver sweep drivers/scenes/double_pendulum.yaml",
                         "orbweaver sweep drivers/scenes/double_pendulum.yaml --csv sweep.csv"});
  return {parser, [options](const Invocation& invocation) { return run(*options, invocation); }};
}

}  // namespace orbweaver::drivers
