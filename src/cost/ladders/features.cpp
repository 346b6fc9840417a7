#include "features.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "orbweaver/bifurcation/kernel.hpp"
#include "orbweaver/certificate/certificate.hpp"
#include "orbweaver/certificate/integrate.hpp"
#include "orbweaver/continuation/family_curve.hpp"
#include "orbweaver/continuation/off_branch.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/loop/curve/passages.hpp"
#include "orbweaver/spectrum/floquet.hpp"
#include "timing.hpp"

namespace orbweaver::cost {

namespace {

constexpr std::size_t samples = 8;  ///< orbits along the family
constexpr std::size_t quick_samples = 3;

/// A place to put rows: what it is, at which orbit, how long it took, and that in orbits of the branch.
class Prices {
 public:
  Prices(const Setting& setting, Table& table, double orbit_seconds)
      : _setting(setting), _table(table), _orbit_seconds(orbit_seconds) {}

  /// The seconds, 0 where it cannot be done.
  double add(const char* thing, const loop::Loop& at, const std::function<void()>& work) {
    const double period = at.period * _setting.system()->scales().time;
    try {
      const Timing timing = timing_of(work, _setting.budget(), _setting.patience());
      _table.rows.push_back({thing, period, at.cutoff, timing.seconds, timing.seconds / _orbit_seconds, {}});
      return timing.seconds;
    } catch (const core::NumericalError& error) {
      _table.rows.push_back({thing, period, at.cutoff, {}, {}, error.what()});
    }
    return 0.0;
  }

 private:
  const Setting& _setting;
  Table& _table;
  double _orbit_seconds;
};

/// Closure and return by one integrator, one piece of the period after the other.
void integrate_one_by_one(const systems::System& system, const loop::Loop& orbit) {
  const certificate::Options options;
  const int pieces = options.segments;
  for (int m = 0; m < pieces; ++m)
    static_cast<void>(certificate::integrate(system, loop::state_at(orbit, orbit.period * m / pieces),
                                             orbit.period / pieces, options.tolerance));
  static_cast<void>(certificate::integrate(system, loop::state_at(orbit, 0.0), orbit.period, options.tolerance));
}

/// Seconds an orbit of the branch between these steps: medians over runs along it.
std::vector<double> orbit_seconds(const Setting& setting, const std::vector<std::size_t>& steps) {
  std::vector<std::vector<double>> runs(steps.size());
  double spent = 0.0;
  while (runs.front().empty() || (spent < setting.budget() && runs.front().size() < most_repetitions)) {
    continuation::Branch branch(setting.system(), setting.start(), setting.branch_options());
    std::size_t before = 0;
    for (std::size_t n = 0; n < steps.size(); ++n) {
      const double seconds = seconds_of([&] {
        while (branch.advance().value().step < static_cast<int>(steps[n])) {
        }
      });
      spent += seconds;
      runs[n].push_back(seconds / static_cast<double>(steps[n] - before));
      before = steps[n];
    }
  }
  std::vector<double> medians;
  for (std::vector<double>& times : runs) {
    const auto middle = times.begin() + static_cast<std::ptrdiff_t>(times.size() / 2);
    std::nth_element(times.begin(), middle, times.end());
    medians.push_back(*middle);
  }
  return medians;
}

void measure_features(const Setting& setting, const Take& take) {
  Table table{"features",
              fmt::format("{}: the price of what a scene can ask for", setting.family()),
              {{"what"}, {"T"}, {"K"}, {"time", "s"}, {"orbits"}, {"remark"}},
              {},
              {},
              Plot{2, 3, {0}, {}}};
  const systems::System& system = *setting.system();
  const loop::Isotropy& isotropy = setting.isotropy();
  const auto trace = [&] {
    std::size_t orbits = 0;
    static_cast<void>(
        continuation::trace(setting.system(), setting.start(), setting.branch_options(),
                            [&](const continuation::Orbit&) { return ++orbits < setting.orbits().size(); }));
  };
  const double an_orbit = timing_of(trace, setting.budget()).seconds / static_cast<double>(setting.orbits().size());
  Prices prices(setting, table, an_orbit);
  const std::size_t count = std::min(setting.quick() ? quick_samples : samples, setting.orbits().size() - 1);
  std::vector<std::size_t> steps;
  for (std::size_t n = 1; n <= count; ++n) steps.push_back((setting.orbits().size() - 1) * n / count);
  const std::vector<double> here = orbit_seconds(setting, steps);
  double most_closure = 0.0;  // in times of the check that integrates once
  double most_full = 0.0;     // in times of an orbit with its multipliers
  continuation::Branch branch(setting.system(), setting.start(), setting.branch_options());
  for (std::size_t n = 0; n < count; ++n) {
    const std::size_t step = steps[n];
    while (branch.advance().value().step < static_cast<int>(step)) {
    }
    const loop::Loop orbit = branch.frontier().orbit.loop;
    const loop::Tangent tangent = branch.frontier().tangent;
    table.rows.push_back({"orbit", orbit.period * system.scales().time, orbit.cutoff, here[n], here[n] / an_orbit, {}});
    const double stability =
        prices.add("stability", orbit, [&] { static_cast<void>(spectrum::floquet(system, orbit, isotropy)); });
    const double once = prices.add("integrated once", orbit, [&] { integrate_one_by_one(system, orbit); });
    for (const auto& [name, level] : {std::pair{"certificate closure", certificate::Level::closure},
                                      std::pair{"certificate full", certificate::Level::full}}) {
      certificate::Options options;
      options.level = level;
      certificate::Certifier certifier(system, isotropy, options);
      const double seconds = prices.add(name, orbit, [&] { static_cast<void>(certifier(orbit)); });
      if (level == certificate::Level::closure && once > 0.0) most_closure = std::max(most_closure, seconds / once);
      if (level == certificate::Level::full) most_full = std::max(most_full, seconds / (here[n] + stability));
    }
    // Through the mean of the first coordinate, which every orbit that moves in it passes.
    prices.add("section", orbit, [&] {
      static_cast<void>(loop::passages(orbit, 0, orbit.cosine(0, 0), system.structure().is_angle(0)));
    });
    prices.add("off-branch eigenvalue", orbit,
               [&] { static_cast<void>(continuation::off_branch_eigenvalue(system, orbit, isotropy, tangent)); });
  }
  if (const auto found = setting.first_event(setting.branch_options())) {
    std::optional<bifurcation::Crossing> crossing;
    bifurcation::NotLocated why;
    prices.add("location", found->known.back().loop, [&] {
      continuation::FamilyCurve curve(setting.system(), isotropy, setting.branch_options());
      for (const auto& known : found->known) curve.add(known, found->known.size());
      crossing = bifurcation::locate(system, curve, found->event, found->from, found->to, why);
    });
    if (crossing)
      prices.add("kernel", crossing->point.loop, [&] {
        const bifurcation::Sector& sector = found->event.function.sector;
        static_cast<void>(bifurcation::kernel_of(system, crossing->point, isotropy, sector, sector.q <= 2 ? 1 : 2));
      });
    else
      table.rows.push_back({"kernel", {}, {}, {}, {}, "no crossing was located: " + to_text(why)});
  } else {
    table.rows.push_back({"location", {}, {}, {}, {}, "no multiplier passes a root of unity on this family"});
    table.rows.push_back({"kernel", {}, {}, {}, {}, "no crossing"});
  }
  table.remarks.emplace_back(fmt::format(
      "an orbit of this branch takes {:.3g} ms, `orbits`: the price in them; `orbit`: one of those up to there",
      1e3 * an_orbit));
  table.remarks.emplace_back(
      fmt::format("certificate none: nothing; closure: at most {:.2g} times `integrated once` (by one integrator, one "
                  "piece after the "
                  "other); full: at most {:.2g} times the orbit there with its multipliers",
                  most_closure, most_full));
  take(table);
}

}  // namespace

const Ladder features_ladder{"features",
                             "the price of stability, certificate, off-branch eigenvalue, location, kernel, section",
                             measure_features};

}  // namespace orbweaver::cost
