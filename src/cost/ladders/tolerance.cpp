#include "tolerance.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <fmt/format.h>

#include "orbweaver/core/error.hpp"
#include "timing.hpp"

namespace orbweaver::cost {

namespace {

constexpr int first_exponent = 4;  // of the tolerances 1e-4 to 1e-13
constexpr int last_exponent = 13;
constexpr int quick_stride = 3;
/// Orbits of a family that are held against true ones, evenly along its steps.
constexpr std::size_t samples = 5;
constexpr std::size_t quick_samples = 2;
/// The last harmonics that are left out weigh some hundred times in the residual: as branches have it by default.
constexpr double of_tail = 1e-2;

/// Worst error of orbits spread along a branch; those that neither period nor energy picks to more digits (`left_out`
/// counts them) are passed over.
double worst_error(const Setting& setting, const std::vector<loop::Loop>& loops, int& left_out) {
  const std::size_t count = setting.quick() ? quick_samples : samples;
  double worst = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t n = 1; n <= count; ++n) {
    const std::size_t at = (loops.size() - 1) * n / count;
    if (at == 0) continue;
    try {
      worst = std::fmax(worst, setting.truth_beside(loops[at], loops[at - 1]).error_of(loops[at]));
    } catch (const core::NumericalError&) {
      ++left_out;
    }
  }
  return worst;
}

void measure_tolerance(const Setting& setting, const Take& take) {
  Table table{"tolerance",
              fmt::format("{}: the whole family against the tolerance on sqrt(loss)", setting.family()),
              {{"solver"},
               {"tolerance"},
               {"orbits"},
               {"largest K"},
               {"time", "s"},
               {"time per orbit", "s"},
               {"worst error"},
               {"end"}},
              {},
              {},
              Plot{4, 6, {0}, {}}};
  int left_out = 0;
  for (int exponent = first_exponent; exponent <= last_exponent; exponent += setting.quick() ? quick_stride : 1) {
    continuation::Options options = setting.branch_options();
    options.corrector.tolerance = std::pow(10.0, -exponent);
    options.tail_tolerance = of_tail * options.corrector.tolerance;
    std::vector<loop::Loop> loops;
    std::string end;
    const auto run = [&] {
      loops.clear();
      const continuation::Ending ending =
          continuation::trace(setting.system(), setting.start(), options, [&](const continuation::Orbit& orbit) {
            loops.push_back(orbit.loop);
            return true;
          });
      end = continuation::name_of(ending.reason);
    };
    Timing timing;
    try {
      timing = timing_of(run, setting.budget(), setting.patience());
    } catch (const GivenUp& error) {
      timing.seconds = setting.patience();
      end = error.what();
    }
    if (loops.empty()) {
      table.rows.push_back({"automatic", options.corrector.tolerance, 0, {}, {}, {}, {}, end});
      continue;
    }
    int cutoff = 0;
    for (const loop::Loop& loop : loops) cutoff = std::max(cutoff, loop.cutoff);
    const auto orbits = static_cast<double>(loops.size());
    table.rows.push_back({"automatic", options.corrector.tolerance, orbits, cutoff, timing.seconds,
                          timing.seconds / orbits, worst_error(setting, loops, left_out), end});
  }
  table.remarks.emplace_back(fmt::format("errors of {} orbits spread along the family, the last one included",
                                         setting.quick() ? quick_samples : samples));
  if (left_out > 0)
    table.remarks.push_back(
        fmt::format("{} of all these have no true orbit: neither period nor energy picks it", left_out));
  take(table);
}

}  // namespace

const Ladder tolerance_ladder{"tolerance", "a whole family against the tolerance, 1e-4 to 1e-13", measure_tolerance};

}  // namespace orbweaver::cost
