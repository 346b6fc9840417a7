#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>

#include <CLI/CLI.hpp>

#include "command.hpp"
#include "common_options.hpp"
#include "orbweaver/report/show.hpp"
#include "pager.hpp"
#include "result_stream.hpp"

namespace orbweaver::drivers {

namespace {

constexpr std::size_t narrowest = 40;  // columns that lines have at least, whatever the terminal says

struct ShowOptions {
  std::filesystem::path atlas;
  std::string table;
  bool csv = false;
  bool json = false;
  report::Selection selection;

  [[nodiscard]] report::TextFormat format() const {
    if (csv) return report::TextFormat::csv;
    return json ? report::TextFormat::json : report::TextFormat::readable;
  }
};

int show(const ShowOptions& options) {
  const archive::Archive atlas(options.atlas);
  const Pager pager;
  const core::Terminal& terminal = pager.terminal();
  report::Layout layout{.unicode = terminal.unicode};
  if (terminal.reached) layout.width = std::clamp(terminal.width, narrowest, layout.width);
  ResultStream out(terminal);
  if (options.table.empty()) {
    report::print_summary(out, atlas, layout);
  } else {
    if (options.format() == report::TextFormat::readable) report::print_table_head(out, atlas, layout);
    report::print_table(out, atlas, options.table, options.format(), options.selection, layout);
  }
  out.finish();
  return 0;
}

}  // namespace

Command make_show_command(CLI::App& program) {
  CLI::App* parser = program.add_subcommand("show", "Print what an atlas holds");
  auto options = std::make_shared<ShowOptions>();
  parser->add_option("atlas", options->atlas, "The atlas.h5 of a survey, or the survey's folder")->required();
  CLI::Option* table =
      parser
          ->add_option("table", options->table,
                       "families, orbits, crossings, loci, equilibria or findings; none: a summary")
          ->check(CLI::IsMember({"families", "orbits", "crossings", "loci", "equilibria", "findings"}));
  CLI::Option* csv = parser->add_flag("--csv", options->csv, "The table as CSV, full precision")->needs(table);
  parser->add_flag("--json", options->json, "The table as JSON, full precision")->needs(table)->excludes(csv);
  parser->add_option("--family", options->selection.family, "Only what belongs to the family of this name")
      ->needs(table);
  parser->add_option("--columns", options->selection.columns, "These columns only, such as step,period,state_th1")
      ->delimiter(',')
      ->needs(table);
  parser
      ->add_option("--sort", options->selection.sort, "By this column; downwards with a `-` before it: --sort=-period")
      ->needs(table);
  parser
      ->add_flag(
          "--all", options->selection.all_equilibria,
          "Of equilibria every point of their curves, not only ends, Hopf points, folds and changes of stability")
      ->needs(table);
  add_examples(*parser, {"orbweaver show out/double_pendulum/atlas.h5 families",
                         "orbweaver show out/double_pendulum/atlas.h5 orbits --family In-Phase --columns "
                         "step,period,energy --sort=-period",
                         "orbweaver show out/double_pendulum/atlas.h5 crossings --csv",
                         "orbweaver show out/double_pendulum/atlas.h5 equilibria --all",
                         "orbweaver show out/double_pendulum/atlas.h5 findings"});
  return {parser, [options](const Invocation&) { return show(*options); }};
}

}  // namespace orbweaver::drivers
