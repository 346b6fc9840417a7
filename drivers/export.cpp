#include <filesystem>
#include <memory>
#include <string>

#include <fmt/format.h>

#include "command.hpp"
#include "common_options.hpp"
#include "failure.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/core/output_file.hpp"
#include "orbweaver/report/export/auto_restart.hpp"
#include "orbweaver/report/export/export_orbits.hpp"
#include "result_stream.hpp"

namespace orbweaver::drivers {

namespace {

struct ExportOptions {
  std::filesystem::path atlas;
  report::ExportSelection selection;
  std::string format;
  std::filesystem::path output;
  std::filesystem::path equations;
};

void write_orbits(std::ostream& out, const archive::Archive& atlas, const ExportOptions& options) {
  if (options.format == "csv") return report::export_csv(out, atlas, options.selection);
  if (options.format == "json") return report::export_json(out, atlas, options.selection);
  report::export_auto(out, atlas, options.selection);
}

int run(const ExportOptions& options) {
  if (!options.equations.empty() && options.format != "auto")
    throw core::InputError("expected --equations with --format auto: they are Fortran for AUTO-07p");
  if (!options.equations.empty() && options.equations == options.output)
    throw core::InputError("expected --equations in another file than -o");
  for (const std::filesystem::path& file : {options.output, options.equations})
    if (!file.empty()) core::require_output_file(file, options.atlas);
  const archive::Archive atlas(options.atlas);
  const std::string equations = options.equations.empty() ? std::string() : report::auto_equations(atlas);
  if (options.output.empty()) {
    ResultStream out;
    write_orbits(out, atlas, options);
    out.finish();
  } else {
    core::write_output_file(options.output, [&](std::ostream& file) { write_orbits(file, atlas, options); });
  }
  if (!options.equations.empty())
    core::write_output_file(options.equations, [&](std::ostream& file) { file << equations; });
  return static_cast<int>(core::ExitStatus::done);
}

}  // namespace

Command make_export_command(CLI::App& program) {
  const auto options = std::make_shared<ExportOptions>();
  CLI::App* parser = program.add_subcommand("export", "Initial states and periods of orbits for other programs");
  parser->add_option("atlas", options->atlas, "The atlas.h5 of a survey, or the survey's folder")->required();
  parser->add_option("--format", options->format, "csv, json, or auto: the file from which AUTO-07p restarts")
      ->required()
      ->check(CLI::IsMember({"csv", "json", "auto"}));
  CLI::Option* family =
      parser->add_option("--family", options->selection.family, "Only the orbits of the family of this name");
  parser->add_option("--step", options->selection.step, "Only this step of the family")->needs(family);
  parser->add_option("-o,--output", options->output, "The file to write; without it, to the standard output")
      ->type_name("FILE")
      ->check(named_path());
  parser->add_option("--equations", options->equations, "With --format auto: also the equations file, Fortran 90")
      ->type_name("FILE.f90")
      ->check(named_path());
  add_examples(*parser, {"orbweaver export out/double_pendulum/atlas.h5 --format csv -o orbits.csv",
                         "orbweaver export out/double_pendulum/atlas.h5 --family In-Phase --format json",
                         "orbweaver export out/double_pendulum/atlas.h5 --family In-Phase --format auto -o s.inphase "
                         "--equations pendulum.f90"});
  return {parser, [options](const Invocation&) { return run(*options); }};
}

}  // namespace orbweaver::drivers
