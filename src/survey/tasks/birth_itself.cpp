#include "birth_itself.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "orbweaver/bifurcation/crossing.hpp"
#include "orbweaver/continuation/way_from_start.hpp"
#include "orbweaver/loop/curve/loop.hpp"
#include "orbweaver/loop/curve/measures.hpp"

namespace orbweaver::survey {

namespace {

/// Of what the first orbit has that its base has not: an orbit with less is the base's to rounding. Seen: 1e-3 and
/// less.
constexpr double at_birth = 1e-2;

/// What an orbit has that its base, of which `birth` is the crossing's orbit, has not: what does not repeat as one that
/// is gone around so many times, or, of once, what it is aside of the birth.
double own_of(const loop::Loop& orbit, const loop::Loop& birth, int times) {
  if (times == 1) return loop::mean_distance(orbit, birth);
  const loop::Loop even = orbit.time_map.is_identity() ? orbit : loop::evenly_in_time(orbit);
  double square = 0.0;
  for (std::size_t n = 0; n < even.modes.size(); ++n) {
    const std::size_t harmonic = (n / static_cast<std::size_t>(even.dimension) + 1) / 2;  // a_0, a_1, b_1, a_2, ...
    if (harmonic % static_cast<std::size_t>(times) != 0) square += even.modes[n] * even.modes[n];
  }
  return std::sqrt(square);
}

}  // namespace

bool is_birth_itself(const LocateWork& work, continuation::FamilyCurve& family, double position) {
  const int times = work.lineage.multiplicity;
  const bool is_fold = work.event.kind != bifurcation::Event::Kind::test_function;
  const bool is_of_one =
      !is_fold && bifurcation::has_sector(work.event.function.kind) && work.event.function.sector.q == 1;
  if ((!is_fold && !is_of_one) || continuation::goes_through(times)) return false;
  const auto first = std::find_if(work.known.begin(), work.known.end(),
                                  [](const continuation::FamilyCurve::Known& known) { return known.position >= 0.0; });
  const bool is_beside_birth = first != work.known.begin() && first != work.known.end() && position < first->position;
  if (!is_beside_birth) return false;
  const std::optional<continuation::CurvePoint> there = family.at(position);
  const loop::Loop& birth = work.known.front().loop;
  return there && own_of(there->loop, birth, times) < at_birth * own_of(first->loop, birth, times);
}

}  // namespace orbweaver::survey
