#include "orbweaver/report/page/page.hpp"

#include <filesystem>
#include <memory>

#include <fmt/format.h>

#include "command.hpp"
#include "common_options.hpp"
#include "failure.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/core/output_file.hpp"
#include "page/page_template.hpp"

namespace orbweaver::drivers {

namespace {

struct PageOptions {
  std::filesystem::path atlas;
  std::filesystem::path output;
};

int run(const PageOptions& options) {
  core::require_output_file(options.output, options.atlas);
  const archive::Archive atlas(options.atlas);
  const std::string_view page = page_template();
  if (page.empty()) throw core::EnvironmentError(fmt::format("cannot make a page: {}", missing_page_reason()));
  report::PageSummary summary;
  core::write_output_file(options.output, [&](std::ostream& file) { summary = report::write_page(file, atlas, page); });
  const auto megabytes = [](std::size_t bytes) { return static_cast<double>(bytes) / 1e6; };
  print_result(fmt::format("{}: {:.1f} MB, {} families, {} orbits\n", options.output.string(), megabytes(summary.bytes),
                           summary.families, summary.orbits));
  print_result(fmt::format(
      "loops of {} orbits, {:.1f} MB: {} of {} harmonics, coordinates within {:.1e} of their ranges\n", summary.loops,
      megabytes(summary.loop_bytes), summary.harmonics_kept, summary.harmonics_stored, summary.deviation));
  return static_cast<int>(core::ExitStatus::done);
}

}  // namespace

Command make_page_command(CLI::App& program) {
  const auto options = std::make_shared<PageOptions>();
  CLI::App* parser = program.add_subcommand("page", "An atlas to look at: one HTML file for any browser, offline");
  parser->add_option("atlas", options->atlas, "The atlas.h5 of a survey, or the survey's folder")->required();
  parser->add_option("-o,--output", options->output, "The file to write")
      ->required()
      ->check(named_path())
      ->type_name("FILE.html");
  add_examples(*parser, {"orbweaver page out/double_pendulum/atlas.h5 -o double_pendulum.html"});
  return {parser, [options](const Invocation&) { return run(*options); }};
}

}  // namespace orbweaver::drivers
