#include "digits.hpp"

#include <vector>

#include <fmt/format.h>

#include "orbweaver/core/error.hpp"
#include "orbweaver/numerics/extended.hpp"
#include "timing.hpp"

namespace orbweaver::cost {

namespace {

const std::vector<int> orbit_digits{15, 30, 50, 100};
const std::vector<int> quick_orbit_digits{15, 30};

/// Correct digits of a number by its bound.
double digits_of(const refine::Number& number) {
  return numerics::log10_abs(number.value) - numerics::log10_abs(number.error);
}

void measure_digits(const Setting& setting, const Take& take) {
  Table table{"digits",
              fmt::format("{}: digits of an orbit by `orbweaver refine` against time", setting.family()),
              {{"orbit"},
               {"T"},
               {"digits asked for"},
               {"time", "s"},
               {"digits known"},
               {"arithmetic"},
               {"Taylor order"},
               {"steps"}},
              {},
              {},
              Plot{3, 4, {0}, {}}};
  const double unit = setting.system()->scales().time;
  for (const Probe& probe : setting.probes()) {
    const TrueOrbit& truth = setting.truth_of(probe);
    for (const int digits : setting.quick() ? quick_orbit_digits : orbit_digits) {
      refine::RefinedOrbit orbit;
      const Timing timing =
          timing_of([&] { orbit = refine::refine_orbit(truth.guess(), truth.held(), digits); }, setting.budget());
      double least = orbit.working_digits;
      for (const refine::Number& number : orbit.state)
        if (number.error > 0 && number.value != 0) least = std::min(least, digits_of(number));
      table.rows.push_back({probe.name, probe.orbit.loop.period * unit, digits, timing.seconds, least,
                            orbit.working_digits, orbit.taylor_order, static_cast<double>(orbit.steps)});
    }
  }
  table.remarks.emplace_back("digits known: of the coordinate at t = 0 that is known worst, by its bound");
  take(table);
}

}  // namespace

const Ladder digits_ladder{"digits", "digits of an orbit by refine against time", measure_digits};

}  // namespace orbweaver::cost
