#include "numbered_starts.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "orbweaver/bifurcation/identity.hpp"
#include "orbweaver/continuation/orbit.hpp"
#include "tasks/units.hpp"

namespace orbweaver::survey {

namespace {

/// Of a level, in its scale: less is rounding, and not to be told in a name.
constexpr double no_level = 1e-8;

struct Candidate {
  GivenStart given;
  FoundMode mode;
  double level = 0.0;  ///< continuation::level_of
};

/// With six digits, which tell most orbits of one scene apart.
std::string name_of(const systems::System& system, const Candidate& of) {
  std::string winding;
  if (system.structure().has_angles()) {
    std::vector<int> numbers;
    for (const int angle : system.structure().angles)
      numbers.push_back(static_cast<int>(of.mode.base.winding[static_cast<std::size_t>(angle)]));
    winding = fmt::format("n({}) ", fmt::join(numbers, ","));
  }
  const Units units(system);
  const double level = std::abs(of.level) < no_level ? 0.0 : of.level;
  const std::string at_level =
      std::isnan(level) ? "" : fmt::format(" {}={:.6g}", units.level_name(), level * units.level());
  return fmt::format("Orbit {}T={:.6g}{}", winding, of.mode.period * units.time, at_level);
}

}  // namespace

std::vector<NumberedStart> numbered_starts(const scene::Scene& scene, const systems::System& system,
                                           std::vector<FoundStart> found, std::vector<std::string>& remarks) {
  std::vector<Candidate> kept;
  int returns = 0;
  int led = 0;
  int distinct = 0;
  for (FoundStart& start : found) {
    const bool is_return = start.given.is_return();
    returns += is_return ? 1 : 0;
    for (FoundMode& mode : start.outcome.modes) {
      led += is_return ? 1 : 0;
      const auto same = std::find_if(kept.begin(), kept.end(), [&](const Candidate& other) {
        return bifurcation::same_orbit(system, other.mode.base, mode.base);
      });
      if (same != kept.end()) {
        if (!is_return)
          remarks.push_back(
              fmt::format("{} gives the orbit of {}, which is followed once", start.given.told, same->given.told));
        continue;
      }
      distinct += is_return ? 1 : 0;
      const double level = continuation::level_of(system, mode.base);
      kept.push_back({start.given, std::move(mode), level});
    }
  }
  std::stable_sort(kept.begin(), kept.end(), [](const Candidate& a, const Candidate& b) {
    return std::tie(a.mode.base.winding, a.mode.period, a.level) <
           std::tie(b.mode.base.winding, b.mode.period, b.level);
  });
  if (scene.recurrences) {
    std::vector<double> periods;
    for (const Candidate& candidate : kept)
      if (candidate.given.is_return()) periods.push_back(candidate.mode.period);
    std::sort(periods.begin(), periods.end());
    const auto most = static_cast<std::size_t>(scene.recurrences->most);
    remarks.push_back(
        fmt::format("starts.recurrences: {} returns, {} led to an orbit, {} of these distinct and new, {} "
                    "followed",
                    returns, led, distinct, std::min(most, periods.size())));
    if (periods.size() > most) {
      const double longest = periods[most - 1];
      std::size_t room = most;
      std::erase_if(kept, [&](const Candidate& candidate) {
        if (!candidate.given.is_return()) return false;
        if (candidate.mode.period > longest || room == 0) return true;
        --room;
        return false;
      });
    }
  }
  std::vector<NumberedStart> numbered;
  std::map<std::string, int> times;
  for (Candidate& candidate : kept) {
    std::string name = candidate.given.name.empty() ? name_of(system, candidate) : candidate.given.name;
    const int again = ++times[name];
    if (again > 1) name += fmt::format(" ({})", again);
    numbered.push_back(
        {std::move(name), candidate.given.told, static_cast<int>(numbered.size()), std::move(candidate.mode)});
  }
  return numbered;
}

}  // namespace orbweaver::survey
