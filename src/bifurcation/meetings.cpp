#include "orbweaver/bifurcation/meetings.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <functional>
#include <iterator>
#include <utility>

#include "same_plane.hpp"

namespace orbweaver::bifurcation {

namespace {

using spectrum::Rotation;
using spectrum::Stability;

/// Of one meeting, orbits that are asked at most: pairs that pass one another where nothing holds them take four.
constexpr int most_orbits = 16;
/// Of a step, where planes of pairs are not told from one another over the whole.
constexpr int halvings_of_a_step = 3;
/// Radians between two multipliers that pass one another, below which nothing of a meeting would be located.
constexpr double together = 1e-7;
/// Of two planes that are mixtures of two others: how much of each is in these, at least.
constexpr double most_of_both = 0.5;
/// In lengths over which the square of a distance doubles: how well the place of the least one is known, how near
/// orbits on both sides of it are, and where others are taken where they are not.
constexpr double known_place = 0.1;
constexpr double near_enough = 10.0;
constexpr double beside = 4.0;

// Two indices that are equal by symmetry are a complex pair to rounding.
std::ptrdiff_t pairs_off_circle(const Stability& s) {
  std::ptrdiff_t count = 0;
  for (std::size_t n = 0; n < s.fundamental.size(); ++n)
    if (std::abs(s.fundamental[n].imag()) > s.fundamental_error[n]) ++count;
  return count;
}

/// The rotations of two pairs at an orbit: by their angles they are told to have passed one another.
struct Two {
  Rotation first;
  Rotation second;

  [[nodiscard]] double apart() const { return first.angle - second.angle; }
  /// The same at another orbit.
  [[nodiscard]] std::optional<Two> at(const Stability& there) const {
    const Counterpart one = counterpart(first, there);
    const Counterpart other = counterpart(second, there);
    if (!one || !other || one.rotation == other.rotation) return std::nullopt;
    return Two{*one.rotation, *other.rotation};
  }
  /// How far apart the pairs' angles are at another orbit, where both planes may be mixtures of these two.
  [[nodiscard]] std::optional<double> mixed_at(const Stability& there) const {
    std::vector<std::pair<double, double>> shares;  // in these planes, and the angle
    for (const Rotation& rotation : there.rotations)
      shares.emplace_back(std::abs(overlap(first, rotation)) + std::abs(overlap(second, rotation)), rotation.angle);
    if (shares.size() < 2) return std::nullopt;
    std::partial_sort(shares.begin(), shares.begin() + 2, shares.end(), std::greater<>());
    if (!(shares[1].first > most_of_both)) return std::nullopt;
    return std::abs(shares[0].second - shares[1].second);
  }
};

/// Looks for an orbit where two pairs are off the circle, between orbits where their angles are in different order.
class MeetingSearch {
 public:
  MeetingSearch(std::ptrdiff_t off_at_ends, const StabilityBetween& between)
      : _off_at_ends(off_at_ends), _between(between) {}

  /// Follows the pairs towards where their angles are equal, by the false position method, as long as their planes are
  /// told from one another.
  std::optional<StabilityAt> run(Two two, const Two& at_to, double from, double to) {
    double weight_from = two.apart();
    double weight_to = at_to.apart();
    Sample before{from, weight_from * weight_from};
    Sample after{to, weight_to * weight_to};
    std::optional<bool> was_before;
    while (_left > 0) {
      const double share = weight_from / (weight_from - weight_to);
      const double position = before.position + share * (after.position - before.position);
      if (!ask(position)) return found();
      std::optional<Two> there = two.at(_here.stability);
      if (!there) {
        const std::optional<double> mixed = two.mixed_at(_here.stability);
        return mixed ? least(two, before, {position, *mixed * *mixed}, after) : std::nullopt;
      }
      const double apart = there->apart();
      if (!(std::abs(apart) > together)) return std::nullopt;
      const bool is_before = apart * weight_from > 0.0;
      (is_before ? before : after) = {position, apart * apart};
      (is_before ? weight_from : weight_to) = apart;
      // An end that stays twice counts half.
      if (is_before == was_before) (is_before ? weight_to : weight_from) *= 0.5;
      was_before = is_before;
      if (is_before) two = *std::move(there);
    }
    return std::nullopt;
  }

 private:
  struct Sample {
    double position;
    double square;  // of how far apart the angles are: smooth, and below 0 where the pairs are off the circle
  };

  /// False where the search ends: there is no orbit, or it is `found`.
  bool ask(double position) {
    --_left;
    const std::optional<Stability> here = _between(position);
    if (!here) return false;
    _here = {position, *here};
    _is_found = pairs_off_circle(*here) > _off_at_ends;
    return !_is_found;
  }
  [[nodiscard]] std::optional<StabilityAt> found() const { return _is_found ? std::optional(_here) : std::nullopt; }

  /// Goes to the least square of how far they are apart by parabolas: below 0, or as far as pairs that repel come.
  std::optional<StabilityAt> least(const Two& two, Sample a, Sample b, Sample c) {
    while (_left > 0) {
      const double before = (b.square - a.square) / (b.position - a.position);
      const double after = (c.square - b.square) / (c.position - b.position);
      const double half_curvature = (after - before) / (c.position - a.position);
      const double slope = before + half_curvature * (b.position - a.position);
      const double vertex = b.position - 0.5 * slope / half_curvature;
      if (!(half_curvature > 0.0) || !(vertex > a.position && vertex < c.position)) return std::nullopt;
      const double length = std::sqrt(b.square / half_curvature);
      double next = vertex;
      if (std::abs(vertex - b.position) < known_place * length) {
        const bool is_after = c.position - b.position > b.position - a.position;
        if ((is_after ? c.position - b.position : b.position - a.position) < near_enough * length) return std::nullopt;
        next = b.position + (is_after ? beside : -beside) * length;
      }
      if (!ask(next)) return found();
      const std::optional<double> apart = two.mixed_at(_here.stability);
      if (!apart) return std::nullopt;
      const Sample here{next, *apart * *apart};
      const bool is_before = next < b.position;
      if (here.square < b.square) {
        (is_before ? c : a) = b;
        b = here;
      } else {
        (is_before ? a : c) = here;
      }
    }
    return std::nullopt;
  }

  std::ptrdiff_t _off_at_ends;
  const StabilityBetween& _between;
  int _left = most_orbits;
  StabilityAt _here{};
  bool _is_found = false;
};

/// Whether each pair that is on the circle at both orbits is told at the other one, and at most one event can be
/// between of those at which the number of pairs off it changes.
bool are_followed(const Stability& from, const Stability& to) {
  if (std::abs(pairs_off_circle(from) - pairs_off_circle(to)) > 2) return false;
  const auto followed = std::count_if(from.rotations.begin(), from.rotations.end(),
                                      [&](const Rotation& rotation) { return bool(counterpart(rotation, to)); });
  return followed >= static_cast<std::ptrdiff_t>(std::min(from.rotations.size(), to.rotations.size()));
}

void add_meetings(const StabilityAt& from, const StabilityAt& to, int halvings, const StabilityBetween& between,
                  std::vector<StabilityAt>& found) {
  if (halvings > 0 && !are_followed(from.stability, to.stability)) {
    const double middle = 0.5 * (from.position + to.position);
    if (const std::optional<Stability> here = between(middle)) {
      add_meetings(from, {middle, *here}, halvings - 1, between, found);
      found.push_back({middle, *here});
      add_meetings({middle, *here}, to, halvings - 1, between, found);
      return;
    }
  }
  const std::vector<Rotation>& rotations = from.stability.rotations;
  const std::ptrdiff_t off_at_ends = std::max(pairs_off_circle(from.stability), pairs_off_circle(to.stability));
  std::vector<StabilityAt> here;
  for (std::size_t i = 0; i < rotations.size(); ++i)
    for (std::size_t j = i + 1; j < rotations.size(); ++j) {
      const Two pairs{rotations[i], rotations[j]};
      const std::optional<Two> there = pairs.at(to.stability);
      if (!there || !(pairs.apart() * there->apart() < 0.0)) continue;
      MeetingSearch search(off_at_ends, between);
      if (auto one = search.run(pairs, *there, from.position, to.position)) here.push_back(std::move(*one));
    }
  std::sort(here.begin(), here.end(),
            [](const StabilityAt& a, const StabilityAt& b) { return a.position < b.position; });
  // Between two of them the pairs are on the circle, or all four off it.
  for (StabilityAt& one : here) {
    if (&one != &here.front()) {
      const double middle = 0.5 * (found.back().position + one.position);
      if (const std::optional<Stability> apart = between(middle)) found.push_back({middle, *apart});
    }
    found.push_back(std::move(one));
  }
}

}  // namespace

std::vector<StabilityAt> meetings_between(const StabilityAt& from, const StabilityAt& to,
                                          const StabilityBetween& between) {
  std::vector<StabilityAt> found;
  if (from.stability.rotations.size() + to.stability.rotations.size() > 2)
    add_meetings(from, to, halvings_of_a_step, between, found);
  return found;
}

}  // namespace orbweaver::bifurcation
