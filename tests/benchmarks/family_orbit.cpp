#include "family_orbit.hpp"

#include <cstdlib>
#include <map>
#include <numbers>
#include <utility>

#include "orbweaver/starts/sweep.hpp"
#include "orbweaver/systems/registry.hpp"

namespace orbweaver::benchmarks {

FamilyStart start_of(Family family) {
  constexpr double pi = std::numbers::pi;
  FamilyStart out{systems::make_system("double_pendulum"), {}};
  const std::vector<double> point{family == Family::up_down ? pi : 0.0, family == Family::down_up ? pi : 0.0, 0.0, 0.0};
  const starts::SweepOptions options{.period_from = 3.0, .period_to = 8.5, .step = 0.05, .cutoff = 10};
  const starts::SweepResult found = starts::sweep(*out.system, point, options);
  const starts::NormalMode& mode = found.modes.at(family == Family::out_phase ? 1 : 0);
  out.start = {loop::constant_loop(point, mode.period, options.cutoff), mode.direction, mode.isotropy};
  return out;
}

const FamilyOrbit& family_orbit(Family family, double period) {
  static std::map<std::pair<Family, double>, FamilyOrbit> known;
  const auto key = std::pair(family, period);
  if (const auto found = known.find(key); found != known.end()) return found->second;
  const FamilyStart begin = start_of(family);
  continuation::Options options;
  options.period_limit = period;
  FamilyOrbit orbit{begin.system, {}, begin.start.isotropy};
  const continuation::Ending ending =
      continuation::trace(begin.system, begin.start, options, [&](const continuation::Orbit& o) {
        orbit.loop = o.loop;
        return true;
      });
  if (ending.reason != continuation::EndReason::period_limit) std::abort();
  return known.emplace(key, std::move(orbit)).first->second;
}

}  // namespace orbweaver::benchmarks
