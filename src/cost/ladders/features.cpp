#include "features.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "orbweaver/bifurcation/kernel.hpp"
#include "orbweaver/certificate/certificate.hpp"
#include "orbweaver/continuation/family_curve.hpp"
#include "orbweaver/continuation/off_branch.hpp"
#include "orbweaver/core/error.hpp"
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

  void add(const char* thing, const loop::Loop& at, const std::function<void()>& work) {
    const double period = at.period * _setting.system()->scales().time;
    try {
      const Timing timing = timing_of(work, _setting.budget());
      _table.rows.push_back({thing, period, at.cutoff, timing.seconds, timing.seconds / _orbit_seconds, {}});
    } catch (const core::NumericalError& error) {
      _table.rows.push_back({thing, period, at.cutoff, {}, {}, error.what()});
    }
  }

 private:
  const Setting& _setting;
  Table& _table;
  double _orbit_seconds;
};

void measure(const Setting& setting, const Take& take) {
  Table table{"features",
              fmt::format("{}: the price of what a scene can ask for", setting.family()),
              {{"what"}, {"T"}, {"K"}, {"time", "s"}, {"orbits"}, {"remark"}},
              {},
              {},
              Plot{2, 3, {0}, {}}};
  const systems::System& system = *setting.system();
  const loop::Isotropy& isotropy = setting.isotropy();
  const auto trace = [&] {
    static_cast<void>(continuation::trace(setting.system(), setting.start(), setting.branch_options(),
                                          [](const continuation::Orbit&) { return true; }));
  };
  const double an_orbit = timing_of(trace, setting.budget()).seconds / static_cast<double>(setting.orbits().size());
  Prices prices(setting, table, an_orbit);
  const std::size_t count = std::min(setting.quick() ? quick_samples : samples, setting.orbits().size() - 1);
  continuation::Branch branch(setting.system(), setting.start(), setting.branch_options());
  for (std::size_t n = 1; n <= count; ++n) {
    const std::size_t step = (setting.orbits().size() - 1) * n / count;
    while (branch.advance().value().step < static_cast<int>(step)) {
    }
    const loop::Loop orbit = branch.frontier().orbit.loop;
    const loop::Tangent tangent = branch.frontier().tangent;
    prices.add("stability", orbit, [&] { static_cast<void>(spectrum::floquet(system, orbit, isotropy)); });
    for (const auto& [name, level] : {std::pair{"certificate none", certificate::Level::none},
                                      std::pair{"certificate closure", certificate::Level::closure},
                                      std::pair{"certificate full", certificate::Level::full}}) {
      certificate::Options options;
      options.level = level;
      certificate::Certifier certifier(system, isotropy, options);
      prices.add(name, orbit, [&] { static_cast<void>(certifier(orbit)); });
    }
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
  table.rows.push_back({"section", {}, {}, {}, {}, "crossings of a section are not computed yet"});
  table.remarks.emplace_back(
      fmt::format("an orbit of this branch takes {:.3g} ms; `orbits`: the price in them", 1e3 * an_orbit));
  take(table);
}

}  // namespace

const Ladder features_ladder{"features", "the price of stability, certificate, off-branch eigenvalue, location, kernel",
                             measure};

}  // namespace orbweaver::cost
