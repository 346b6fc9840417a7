#include <exception>
#include <filesystem>
#include <map>
#include <memory>

#include <fmt/format.h>

#include "command.hpp"
#include "common_options.hpp"
#include "failure.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/core/log/log.hpp"
#include "orbweaver/core/mpi/communicator.hpp"
#include "orbweaver/core/output_file.hpp"
#include "orbweaver/core/petsc/session.hpp"
#include "orbweaver/cost/ladders.hpp"
#include "orbweaver/report/cost/cost_report.hpp"
#include "same_input.hpp"
#include "unused_options.hpp"

namespace orbweaver::drivers {

namespace {

struct CostOptions {
  SceneOptions scene;
  cost::Options cost;
  std::filesystem::path directory;
  report::PlotFormat format = report::PlotFormat::svg;
};

void write_csv(const std::filesystem::path& directory, const cost::Table& table) {
  core::write_output_file(directory / (table.name + ".csv"),
                          [&](std::ostream& file) { file << report::table_csv(table); });
}

void make_folder(const std::filesystem::path& directory) {
  std::error_code error;
  std::filesystem::create_directories(directory, error);
  if (error) throw core::EnvironmentError(fmt::format("cannot make {}: {}", directory.string(), error.message()));
}

void measure_on(const core::Communicator& comm, const CostOptions& options) {
  scene::Scene scene;
  agree(comm, [&] { scene = options.scene.load(); });
  require_same_input(comm, scene.text + scene.model);
  agree(comm, [&] {
    if (!options.directory.empty() && comm.is_root()) make_folder(options.directory);
  });
  bool has_gnuplot = true;
  const auto take = [&](const cost::Table& table) {
    if (table.printed) print_result(report::table_text(table));
    if (options.directory.empty()) return;
    write_csv(options.directory, table);
    for (const report::Picture& picture : report::pictures_of(table, options.format)) {
      const core::TemporaryFolder folder;
      has_gnuplot = has_gnuplot && report::draw(folder.path(), picture);
      for (const auto& entry : std::filesystem::directory_iterator(folder.path()))
        core::copy_output_file(entry.path(), options.directory / entry.path().filename());
    }
  };
  alike_on_all_ranks(comm, [&] {
    cost::measure(comm, scene, options.cost, take);
    return true;
  });
  if (!has_gnuplot)
    core::log_warning(
        "no pictures: gnuplot is not installed (apt-get install gnuplot-nox); the tables are there as CSV");
}

int run(const CostOptions& options, const Invocation& invocation) {
  const core::Session session(invocation.petsc_options);
  const core::Communicator comm;
  try {
    return run_on_ranks(comm, [&] {
      measure_on(comm, options);
      if (comm.is_root()) warn_of_unused_options(session, core::Communicator(MPI_COMM_SELF));
      return static_cast<int>(core::ExitStatus::done);
    });
  } catch (...) {  // as in survey.cpp
    return report_failure(std::current_exception());
  }
}

}  // namespace

Command make_cost_command(CLI::App& program) {
  const auto options = std::make_shared<CostOptions>();
  CLI::App* parser = program.add_subcommand("cost", "What accuracy costs in time, on the scene's own families");
  add_scene_options(*parser, options->scene);
  parser->add_option("-o,--output", options->directory, "A folder for the tables (CSV) and their plots")
      ->type_name("DIR")
      ->check(named_path());
  parser->add_option("--only", options->cost.only, "Some of the ladders, as a,b")->delimiter(',')->type_name("NAMES");
  parser->add_option("--family", options->cost.family, "The family to measure on (default: the scene's first)")
      ->type_name("NAME");
  parser->add_flag("--quick", options->cost.quick, "Fewer rungs and repetitions");
  const std::map<std::string, report::PlotFormat> formats{
      {"svg", report::PlotFormat::svg}, {"pdf", report::PlotFormat::pdf}, {"png", report::PlotFormat::png}};
  parser->add_option("--format", options->format, "Of the plots: svg, pdf or png")
      ->transform(CLI::CheckedTransformer(formats))
      ->type_name("FORMAT");
  std::string ladders = "Ladders:";
  for (const cost::LadderInfo& ladder : cost::known_ladders())
    ladders += fmt::format("\n  {:<12}{}", ladder.name, ladder.about);
  parser->footer(ladders);
  add_examples(*parser, {"orbweaver cost --quick drivers/scenes/double_pendulum.yaml -o out/cost"});
  return {parser, [options](const Invocation& invocation) { return run(*options, invocation); }};
}

}  // namespace orbweaver::drivers
