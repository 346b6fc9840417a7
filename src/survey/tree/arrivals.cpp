#include "arrivals.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "orbweaver/loop/curve/measures.hpp"
#include "orbweaver/loop/symmetry/alignment.hpp"
#include "tasks/arrival.hpp"

namespace orbweaver::survey {

namespace {

/// How far an arrival may be from the crossing that it is compared with, in period and energy: both are extrapolated
/// along the branch.
constexpr double arrival_window = 1e-3;
/// How far the orbit before an arrival may be from a direction, in parts of its distance from the crossing's orbit.
/// Other directions are further off. At crossings of order 3 both are of what does not repeat as the crossing's orbit
/// does: a family that goes through one may leave it along the base as far as it likes.
constexpr double farthest_from_direction = 0.4;

/// Where crossings are mirror images of one another, a branch of one comes as near to the other: an image counts as so
/// much further from a direction, relatively and at least, that the branch's own is met. Rounding is less, other
/// directions are further.
constexpr double image_further = 0.05;
constexpr double least_further = 1e-6;

/// An orbit so many times as far from the crossing's as the branch has yet to go meets another one. Not measured; the
/// way is straight to a few parts in a hundred.
constexpr double beyond_ahead = 3.0;

double born_period(const LocateOutcome& crossing) { return crossing.multiplicity * crossing.period; }

/// Calls `found` for what has a key near `period`: all that can be within the window, and a little more.
template <typename Map, typename Found>
void for_near(const Map& by_period, double period, const Found& found) {
  const auto end = by_period.upper_bound(period * (1.0 + 2.0 * arrival_window));
  for (auto at = by_period.lower_bound(period * (1.0 - 2.0 * arrival_window)); at != end; ++at) found(at->second);
}

/// Of two loops that run evenly in time.
loop::Loop gap_between(const loop::Loop& one, const loop::Loop& other) {
  loop::Loop gap = loop::with_cutoff(one, std::max(one.cutoff, other.cutoff));
  for (std::size_t n = 0; n < other.modes.size(); ++n) gap.modes[n] -= other.modes[n];
  return gap;
}

}  // namespace

bool within_window(const ArrivalRecord& arrival, const LocateOutcome& crossing) {
  const bifurcation::PlaceError& open = crossing.place_error;
  const double in_level = std::fmax(0.0, std::isnan(crossing.parameter) ? open.energy : open.parameter);
  const double in_period = crossing.multiplicity * std::fmax(0.0, open.period);
  return std::abs(arrival.period - born_period(crossing)) <= arrival_window * born_period(crossing) + in_period &&
         !(std::abs(arrival.level - crossing.level()) > arrival_window * (1.0 + std::abs(crossing.level())) + in_level);
}

std::optional<Meeting> Arrivals::meeting(const ArrivalRecord& arrival, const LocateOutcome& crossing) const {
  if (!within_window(arrival, crossing)) return std::nullopt;
  std::optional<Meeting> met = met_by(arrival.near, crossing);
  return met || arrival.nearest.modes.empty() ? met : met_by(arrival.nearest, crossing);
}

std::optional<Meeting> Arrivals::met_by(const loop::Loop& near, const LocateOutcome& crossing) const {
  const bool is_third = crossing.q == 3 && crossing.multiplicity == 3;
  const auto size = [&](const loop::Loop& gap) { return not_repeated(gap, crossing.multiplicity); };
  std::optional<Meeting> best;
  double nearest = farthest_from_direction;
  for (const LeavingRecord& leaving : crossing.leaving) {
    const loop::Loop& base = leaving.base;
    const double distance = is_third ? size(near) : loop::align(_system, near, base).distance;
    for (const int side : {1, -1}) {
      if (side < 0 && !leaving.both_sides) continue;
      const loop::Tangent way = leaving.way(side);
      const loop::Loop along = loop::moved(base, way, 1.0);
      const double unit = is_third ? size(along) : loop::mean_distance(base, along);
      const loop::Loop expected = loop::moved(base, way, distance / unit);
      const loop::Alignment alignment = loop::align(_system, near, expected);
      const double apart = is_third ? size(gap_between(loop::aligned(near, alignment), expected)) : alignment.distance;
      double away = apart / distance;
      if (alignment.reversing || alignment.name != "1") away = (1.0 + image_further) * away + least_further;
      if (away < nearest) {
        nearest = away;
        best = Meeting{crossing.key, {leaving.key, side}, away};
      }
    }
  }
  return best;
}

void Arrivals::compare(const std::string& branch, const ArrivalRecord& arrival, const LocateOutcome& crossing) {
  if (!std::isfinite(arrival.ahead) || crossing.leaving.empty() || !within_window(arrival, crossing)) return;
  const bool is_apart = std::all_of(crossing.leaving.begin(), crossing.leaving.end(), [&](const LeavingRecord& l) {
    return loop::align(_system, arrival.near, l.base).distance > beyond_ahead * arrival.ahead;
  });
  if (is_apart) _apart.insert({branch, crossing.key});
}

std::vector<Meeting> Arrivals::add_branch(const std::string& key, ArrivalRecord arrival) {
  std::vector<Meeting> meetings;
  for_near(_crossings, arrival.period, [&](const LocateOutcome& crossing) {
    if (std::optional<Meeting> found = meeting(arrival, crossing))
      meetings.push_back(std::move(*found));
    else
      compare(key, arrival, crossing);
  });
  const double period = arrival.period;
  _arrived.emplace(period, Arrived{key, std::move(arrival)});
  return meetings;
}

std::vector<std::pair<std::string, Meeting>> Arrivals::add_crossing(const LocateOutcome& crossing) {
  std::vector<std::pair<std::string, Meeting>> meetings;
  for_near(_arrived, born_period(crossing), [&](const Arrived& branch) {
    if (std::optional<Meeting> found = meeting(branch.at, crossing))
      meetings.emplace_back(branch.key, std::move(*found));
    else
      compare(branch.key, branch.at, crossing);
  });
  _crossings.emplace(born_period(crossing), crossing);
  return meetings;
}

}  // namespace orbweaver::survey
