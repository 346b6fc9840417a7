#include "orbweaver/refine/orbit.hpp"

#include <chrono>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <CLI/CLI.hpp>

#include "command.hpp"
#include "common_options.hpp"
#include "failure.hpp"
#include "orbweaver/archive/read/reader.hpp"
#include "orbweaver/core/log/log.hpp"
#include "orbweaver/core/output_file.hpp"
#include "orbweaver/refine/stored_family.hpp"
#include "orbweaver/report/refined_text.hpp"

namespace orbweaver::drivers {

namespace {

struct RefineOptions {
  std::filesystem::path atlas;
  std::string family;
  std::string orbit;
  std::optional<long> crossing;
  std::optional<int> after;
  int digits = 30;
  std::filesystem::path output;
};

/// Relative: where the archive has a crossing to 1e-10, another one lies further away.
constexpr double same_crossing = 1e-6;

struct Outcome {
  std::string text;
  refine::RefinedOrbit orbit;
};

std::string place_text(const archive::Archive& atlas, const refine::StoredFamily& family,
                       const refine::StoredFamily::Place& place) {
  const std::string where = place.first_step == place.last_step
                                ? fmt::format("step {}", place.first_step)
                                : fmt::format("between the steps {} and {}", place.first_step, place.last_step);
  const std::string symmetries = family.isotropy_text().empty() ? "none" : family.isotropy_text();
  return fmt::format("{}, {} in {}; symmetries {}", family.name(), where, atlas.path().string(), symmetries);
}

Outcome refine_one(const archive::Archive& atlas, const RefineOptions& options) {
  const auto family = refine::StoredFamily::named(atlas, options.family);
  const auto [place, held, equations] = family.named_orbit(options.orbit, options.after);
  const std::string exact = fmt::format("{}", fmt::join(equations, ", "));
  Outcome outcome;
  outcome.orbit = refine::refine_orbit(place.guess, held, options.digits);
  outcome.text =
      report::refined_text(fmt::format("{}, {}", family.name(), exact),
                           {{"family", place_text(atlas, family, place)}, {"held", fmt::format("{} exactly", exact)}},
                           *place.guess.system, outcome.orbit);
  return outcome;
}

Outcome refine_crossing(const archive::Archive& atlas, const RefineOptions& options) {
  if (*options.crossing < 0) throw core::InputError("expected --crossing ROW with a row from 0 on");
  const refine::StoredCrossing crossing = refine::stored_crossing(atlas, static_cast<std::size_t>(*options.crossing));
  const refine::CrossingCondition& condition = crossing.condition;
  Outcome outcome;
  outcome.orbit = refine::refine_crossing(crossing.place.guess, condition, options.digits);
  const double period = static_cast<double>(outcome.orbit.period.value);
  if (!(std::abs(period - crossing.period) < same_crossing * crossing.period))
    throw core::NumericalError(
        fmt::format("the crossing found has T = {:.12g}, not T = {:.12g}: it is another one", period, crossing.period));
  std::string exact;
  if (archive::has_sector(condition.kind))
    exact =
        fmt::format("{} the multiplier exp(2 pi i {}/{})",
                    outcome.orbit.order == 1 ? "the orbit has"
                                             : fmt::format("the fundamental map, over T/{}, has", outcome.orbit.order),
                    condition.sector_j, condition.sector_q);
  else
    exact = condition.kind == archive::CrossingKind::fold_period ? "dT/ds = 0" : "dE/ds = 0";
  outcome.text = report::refined_text(
      fmt::format("{}, {} at T = {:.6g}", crossing.family.name(), archive::name_of(condition.kind), period),
      {{"family", place_text(atlas, crossing.family, crossing.place)}, {"exactly", exact}},
      *crossing.place.guess.system, outcome.orbit);
  return outcome;
}

int refine_command(const RefineOptions& options) {
  if (options.crossing.has_value() == !options.family.empty() || options.family.empty() != options.orbit.empty())
    throw core::InputError("expected FAMILY and ORBIT (a step, T=.., E=.. or PARAMETER=..), or --crossing ROW");
  if (!options.output.empty()) core::require_output_file(options.output, options.atlas);
  const archive::Archive atlas(options.atlas);
  const auto start = std::chrono::steady_clock::now();
  const Outcome outcome = options.crossing ? refine_crossing(atlas, options) : refine_one(atlas, options);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  print_result(outcome.text);
  if (!options.output.empty())
    core::write_output_file(options.output, [&](std::ostream& file) { file << outcome.text; });
  core::write_line(stderr,
                   fmt::format("{:.2f} s: {} digits of arithmetic, Taylor series of order {}, {} steps", seconds,
                               outcome.orbit.working_digits, outcome.orbit.taylor_order, outcome.orbit.steps));
  return static_cast<int>(core::ExitStatus::done);
}

}  // namespace

Command make_refine_command(CLI::App& program) {
  CLI::App* parser = program.add_subcommand("refine", "Compute an orbit or a crossing of an atlas to many digits");
  auto options = std::make_shared<RefineOptions>();
  parser->add_option("ATLAS", options->atlas, "The atlas.h5 of a survey, or the survey's folder")->required();
  parser->add_option("FAMILY", options->family, "The name of a family");
  parser->add_option("ORBIT", options->orbit, "T=PERIOD, E=ENERGY or PARAMETER=VALUE, meant exactly, or a step");
  parser->add_option("--crossing", options->crossing, "A row of the table of crossings, counted from 0");
  parser->add_option("--after", options->after, "The first orbit with this value after a step");
  parser->add_option("-n,--digits", options->digits, "Significant digits of every number")->capture_default_str();
  parser->add_option("-o,--output", options->output, "A file for the text too")->check(named_path());
  add_examples(*parser, {"orbweaver refine out/double_pendulum/atlas.h5 In-Phase T=9 -n 50",
                         "orbweaver refine out/double_pendulum/atlas.h5 In-Phase E=-0.76 -o orbit.txt",
                         "orbweaver refine out/double_pendulum/atlas.h5 --crossing 0"});
  return {parser, [options](const Invocation&) { return refine_command(*options); }};
}

}  // namespace orbweaver::drivers
