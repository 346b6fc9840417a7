#include "orbweaver/report/plot/plot.hpp"

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "command.hpp"
#include "common_options.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/core/output_file.hpp"
#include "orbweaver/core/petsc/session.hpp"

namespace orbweaver::drivers {

namespace {

struct PlotOptions {
  std::filesystem::path atlas;
  report::PlotRequest request;
  std::filesystem::path output;
};

int run(const PlotOptions& options, const Invocation& invocation) {
  report::PlotRequest request = options.request;
  std::optional<core::Session> session;
  if (report::plot_computes(request.what)) session.emplace(invocation.petsc_options);
  request.format = report::plot_format_of(options.output);
  core::require_output_file(options.output, options.atlas);
  const archive::Archive atlas(options.atlas);
  const core::TemporaryFolder folder;
  const std::filesystem::path picture = report::draw_plot(atlas, request, folder.path());
  core::copy_output_file(picture, options.output);
  return static_cast<int>(core::ExitStatus::done);
}

}  // namespace

Command make_plot_command(CLI::App& program) {
  const auto options = std::make_shared<PlotOptions>();
  CLI::App* parser = program.add_subcommand("plot", "A static picture of an atlas, for a paper or a slide");
  parser->add_option("atlas", options->atlas, "The atlas.h5 of a survey, or the survey's folder")->required();
  parser
      ->add_option("what", options->request.what,
                   fmt::format("What to draw: {}", fmt::join(report::plot_names(), ", ")))
      ->required()
      ->check(CLI::IsMember(report::plot_names()));
  parser->add_option("-o,--output", options->output, "The file to write; its ending says how: svg, pdf or png")
      ->required()
      ->type_name("FILE")
      ->check(named_path());
  parser->add_option("--family", options->request.families, "Only this family (repeatable); one for orbits")
      ->allow_extra_args(false)
      ->take_all();
  parser->add_option("--step", options->request.step,
                     "Of orbit, strobe, convergence, spectrum: this step of the family");
  const std::map<std::string, report::PlotStyle> styles{
      {"paper", report::PlotStyle::paper}, {"wide", report::PlotStyle::wide}, {"slide", report::PlotStyle::slide}};
  parser
      ->add_option("--style", options->request.style,
                   "paper: a column, 8.6 cm; wide: both columns, 17.8 cm; slide: 25.4 cm, large letters")
      ->transform(CLI::CheckedTransformer(styles))
      ->type_name("paper|wide|slide");
  add_examples(*parser, {"orbweaver plot out/double_pendulum/atlas.h5 tree -o tree.pdf",
                         "orbweaver plot out/double_pendulum/atlas.h5 orbit --family In-Phase -o orbits.svg",
                         "orbweaver plot out/double_pendulum/atlas.h5 strobe --family In-Phase --step 20 --style slide "
                         "-o strobe.png"});
  return {parser, [options](const Invocation& invocation) { return run(*options, invocation); }};
}

}  // namespace orbweaver::drivers
