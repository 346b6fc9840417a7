#include "tolerance.hpp"

#include <algorithm>
#include <cmath>
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

/// Worst error of orbits spread along a branch.
double worst_error(const Setting& setting, const std::vector<loop::Loop>& loops) {
  const std::size_t count = setting.quick() ? quick_samples : samples;
  double worst = 0.0;
  for (std::size_t n = 1; n <= count; ++n) {
    const std::size_t at = (loops.size() - 1) * n / count;
    if (at == 0) continue;
    worst = std::max(worst, setting.truth_beside(loops[at], loops[at - 1]).error_of(loops[at]));
  }
  return worst;
}

void measure(const Setting& setting, const Take& take) {
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
    const Timing timing = timing_of(run, setting.budget());
    if (loops.empty()) {
      table.rows.push_back({"automatic", options.corrector.tolerance, 0, {}, {}, {}, {}, end});
      continue;
    }
    int cutoff = 0;
    for (const loop::Loop& loop : loops) cutoff = std::max(cutoff, loop.cutoff);
    const auto orbits = static_cast<double>(loops.size());
    table.rows.push_back({"automatic", options.corrector.tolerance, orbits, cutoff, timing.seconds,
                          timing.seconds / orbits, worst_error(setting, loops), end});
  }
  table.remarks.emplace_back(fmt::format("errors of {} orbits spread along the family, the last one included",
                                         setting.quick() ? quick_samples : samples));
  take(table);
}

}  // namespace

const Ladder tolerance_ladder{"tolerance", "a whole family against the tolerance, 1e-4 to 1e-13", measure};

}  // namespace orbweaver::cost
