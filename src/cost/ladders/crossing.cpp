#include "crossing.hpp"

#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "orbweaver/archive/schema/crossing_kind.hpp"
#include "orbweaver/continuation/family_curve.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/numerics/extended.hpp"
#include "orbweaver/refine/guess.hpp"
#include "timing.hpp"

namespace orbweaver::cost {

namespace {

constexpr int first_exponent = 4;  // of the tolerances 1e-4 to 1e-13
constexpr int last_exponent = 13;
constexpr int quick_stride = 3;

const std::vector<int> crossing_digits{15, 30, 50};
const std::vector<int> quick_crossing_digits{15};
/// Of the crossing that others are held against.
constexpr int reference_digits = 20;
constexpr double of_tail = 1e-2;  // as branches have it by default

/// Of whatever name: the sector says what holds there.
refine::CrossingCondition condition_of(const bifurcation::Event& event) {
  return {archive::CrossingKind::subharmonic, event.function.sector.j, event.function.sector.q};
}

void measure_crossing(const Setting& setting, const Take& take) {
  Table table{"crossing",
              fmt::format("{}: digits of its first crossing against time", setting.family()),
              {{"by"}, {"setting"}, {"time", "s"}, {"period"}, {"relative error"}, {"digits"}},
              {},
              {},
              Plot{2, 4, {0}, {}}};
  const double unit = setting.system()->scales().time;
  const auto best = setting.first_event(setting.branch_options());
  if (!best) {
    table.remarks.emplace_back("no multiplier passes a root of unity on this family: nothing to locate");
    return take(table);
  }
  const auto located = [&](const FoundEvent& event, const continuation::Options& options) {
    bifurcation::NotLocated why;
    continuation::FamilyCurve curve(setting.system(), setting.isotropy(), options);
    for (const auto& known : event.known) curve.add(known, event.known.size());
    return bifurcation::locate(*setting.system(), curve, event.event, event.from, event.to, why);
  };
  const auto crossing = located(*best, setting.branch_options());
  if (!crossing) throw core::NumericalError("the first crossing was not located");
  const refine::Guess guess =
      refine::guess_of(setting.plain(), *setting.system(), crossing->point.loop, setting.isotropy());
  const refine::RefinedOrbit truth = refine::refine_crossing(guess, condition_of(best->event), reference_digits);
  const auto period = static_cast<double>(truth.period.value);
  const auto add = [&](const char* by, double value, double seconds, double found, double error) {
    table.rows.push_back({by, value, seconds, found, error, error > 0.0 ? Cell(-std::log10(error)) : Cell()});
  };
  for (int exponent = first_exponent; exponent <= last_exponent; exponent += setting.quick() ? quick_stride : 1) {
    continuation::Options options = setting.branch_options();
    options.corrector.tolerance = std::pow(10.0, -exponent);
    options.tail_tolerance = of_tail * options.corrector.tolerance;
    const auto event = setting.first_event(options);  // with the harmonics of that tolerance
    std::optional<bifurcation::Crossing> found;
    Timing timing;
    if (event) timing = timing_of([&] { found = located(*event, options); }, setting.budget());
    if (!found) {
      table.rows.push_back({"location", options.corrector.tolerance, timing.seconds, {}, {}, "not located"});
      continue;
    }
    const double at = found->point.loop.period * unit;
    const numerics::WorkingDigits working(truth.working_digits);
    const auto off = static_cast<double>(numerics::Extended(abs(numerics::Extended(at) - truth.period.value)));
    add("location", options.corrector.tolerance, timing.seconds, at, off / period);
  }
  for (const int digits : setting.quick() ? quick_crossing_digits : crossing_digits) {
    refine::RefinedOrbit found;
    const Timing timing =
        timing_of([&] { found = refine::refine_crossing(guess, condition_of(best->event), digits); }, setting.budget());
    add("refine", digits, timing.seconds, static_cast<double>(found.period.value),
        static_cast<double>(numerics::Extended(found.period.error / found.period.value)));
  }
  table.remarks.emplace_back(
      "setting: the tolerance of the orbits, or the digits asked for; errors of refine are its bounds");
  take(table);
}

}  // namespace

const Ladder crossing_ladder{"crossing", "digits of the first crossing against time", measure_crossing};

}  // namespace orbweaver::cost
