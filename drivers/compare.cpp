#include <cmath>
#include <filesystem>
#include <memory>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "command.hpp"
#include "common_options.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/core/petsc/session.hpp"
#include "orbweaver/report/compare/comparison.hpp"
#include "orbweaver/report/compare/comparison_text.hpp"
#include "result_stream.hpp"

namespace orbweaver::drivers {

namespace {

struct CompareOptions {
  std::filesystem::path a;
  std::filesystem::path b;
  report::CompareOptions compare;
  bool json = false;
};

int compare(const CompareOptions& options, const Invocation& invocation) {
  if (const double tolerance = options.compare.tolerance; !std::isfinite(tolerance) || tolerance <= 0.0)
    throw core::InputError(fmt::format("--tolerance: expected a number above 0, got {}", tolerance));
  if (options.compare.loops < 0)
    throw core::InputError(fmt::format("--loops: expected a number from 0 on, got {}", options.compare.loops));
  const core::Session session(invocation.petsc_options);
  const archive::Archive a(options.a);
  const archive::Archive b(options.b);
  const report::Comparison comparison = report::compare(a, b, options.compare);
  ResultStream out;
  (options.json ? report::print_comparison_json : report::print_comparison)(out, comparison);
  out.finish();
  return comparison.same() ? 0 : static_cast<int>(core::ExitStatus::goal_missed);
}

}  // namespace

Command make_compare_command(CLI::App& program) {
  CLI::App* parser = program.add_subcommand("compare", "Say what differs between two atlases, as trees of families");
  auto options = std::make_shared<CompareOptions>();
  parser->add_option("A", options->a, "The atlas.h5 of a survey, or the survey's folder")->required();
  parser->add_option("B", options->b, "Another one")->required();
  parser->add_option("--tolerance", options->compare.tolerance, "Relative deviation that does not count")
      ->capture_default_str();
  parser->add_option("--loops", options->compare.loops, "Orbits of each family whose loops are compared")
      ->capture_default_str();
  parser->add_flag("--strict-names", options->compare.strict_names, "Families with another name differ");
  parser->add_flag("--json", options->json, "As JSON");
  add_examples(*parser, {"orbweaver compare out/old/atlas.h5 out/new/atlas.h5 --tolerance 1e-8",
                         "orbweaver compare out/old/atlas.h5 out/new/atlas.h5 --strict-names --json"});
  return {parser, [options](const Invocation& invocation) { return compare(*options, invocation); }};
}

}  // namespace orbweaver::drivers
