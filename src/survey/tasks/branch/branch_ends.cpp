#include "branch_ends.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "orbweaver/continuation/branch.hpp"
#include "orbweaver/continuation/left_open.hpp"
#include "orbweaver/continuation/way_from_start.hpp"
#include "orbweaver/survey/tasks/branch_options.hpp"
#include "tasks/branch/end_folds.hpp"
#include "tasks/branch/foldable.hpp"
#include "tasks/branch/requested.hpp"
#include "tasks/orbit_row.hpp"

namespace orbweaver::survey {

namespace {

/// Places from a family's second orbit to its birth at which slopes tell folds, from the first orbit on each so much
/// nearer to the birth than the one before: the last is a thousandth of the first orbit's way from it.
constexpr std::size_t places_from_birth = 7;
constexpr double nearer_to_birth = 0.25;
/// Of the last place's way from the birth: a slope that is zero nearer to that than this is zero at the birth, but for
/// how it bends. And of a place's own way, by which rounding may leave the orbit open there. Not measured.
constexpr double least_left = 0.01;
constexpr double open_beside_birth = 0.1;
/// The share of the first orbit's way at which indices are looked at first: an index leaves 2 like a power of the way,
/// and may have come back to it at the first orbit.
constexpr double nearest_for_indices = 1.0 / 64.0;

bool is_zero(const bifurcation::Reading& reading) { return !std::isnan(reading.value) && reading.sign() == 0; }

}  // namespace

void BranchEnds::look_before_first(const std::optional<Arrival>& arrival) {
  detect_from_birth(arrival);
  folds_at_start();
  zeros_at_start();
}

/// The first orbit may lie so far out that an index has passed the values of other sectors on the way from the crossing
/// where the family is born.
void BranchEnds::detect_from_birth(const std::optional<Arrival>& arrival) {
  if (_followed.work.lineage.crossing.empty() || _followed.curve.known().empty()) return;
  const continuation::FamilyCurve::Known& first = _followed.curve.known().front();
  std::vector<continuation::FamilyCurve::Known> known{
      {first.position - continuation::arclength_between(_followed.start.base, first.loop), _followed.start.base,
       first.arclength - _followed.outcome.before_first}};
  known.insert(known.end(), _followed.curve.known().begin(), _followed.curve.known().end());
  if (arrival && known.back().position > _followed.last->arclength) known.pop_back();  // it lies beyond the meeting
  continuation::FamilyCurve curve(_followed.system, _followed.start.isotropy,
                                  branch_options(_followed.scene, _followed.team));
  for (const continuation::FamilyCurve::Known& one : known) curve.add(one);
  if (!_followed.functions.empty()) indices_from_birth(curve);
  curve.forget_found();  // where rounding tells little an orbit hangs on those around: folds on none of the indices'
  folds_from_birth(curve);
}

void BranchEnds::indices_from_birth(continuation::FamilyCurve& curve) {
  const std::vector<continuation::FamilyCurve::Known>& known = curve.known();
  const auto probe = [&](double position) -> std::optional<bifurcation::TestPoint> {
    const auto point = curve.at(position);
    if (!point || continuation::way_from(_followed.start, point->loop).is_along_base()) return std::nullopt;
    return _events.test_point(position, point->loop,
                              stability_of(*_followed.system, point->loop, _followed.start.isotropy, _followed.team));
  };
  std::optional<spectrum::Stability> birth =
      stability_of(*_followed.system, _followed.start.base, _followed.start.isotropy, _followed.team);
  if (birth) bifurcation::tell_birth(_followed.system->structure(), *birth);
  bifurcation::TestPoint at_birth = _followed.test_point(known[0].position, birth);
  const std::vector<bifurcation::ZerosPassed> passed_at_birth = std::exchange(at_birth.passed, {});
  for (bifurcation::Reading& reading : at_birth.readings) {
    const bool is_zero = std::abs(reading.value) <= bifurcation::zero_at_birth;
    reading.error = is_zero ? bifurcation::zero_at_birth : 0.0;  // orbits are not isolated there, and have no bounds
  }
  _events.forget_hidden();
  bifurcation::Detector detector;
  std::vector<bifurcation::Bracket> found = detector.advance(at_birth, probe);
  std::vector<bifurcation::TestPoint> places;
  for (double share = nearest_for_indices; share < 1.0; share /= nearer_to_birth)
    if (auto place = probe(known[0].position + share * (known[1].position - known[0].position)))
      places.push_back(*std::move(place));
  const loop::Loop& first = known[1].loop;
  places.push_back(_events.test_point(
      known[1].position, first, stability_of(*_followed.system, first, _followed.start.isotropy, _followed.team)));
  for (const bifurcation::TestPoint& place : places)
    for (const bifurcation::Bracket& bracket : detector.advance(place, probe)) found.push_back(bracket);
  _events.add_zeros_from_birth(found, known);
  for (const bifurcation::MissedZeros& missed : detector.missed()) _events.add_missed(missed);
  // Before the first place that tells. Of two zeros of one function signs show none. The one where a family is born is
  // none.
  for (std::size_t f = 0; f < _followed.functions.size(); ++f) {
    const auto place = std::find_if(places.begin(), places.end(),
                                    [&](const bifurcation::TestPoint& one) { return one.passed[f].is_known(); });
    if (_followed.functions[f].sector.q <= 2 || place == places.end()) continue;
    const int passed = bifurcation::zeros_between(passed_at_birth[f], place->passed[f]);
    const auto bracketed =
        static_cast<int>(std::count_if(found.begin(), found.end(), [&](const bifurcation::Bracket& b) {
          return b.function == f && b.to <= place->position;
        }));
    if (passed > 1 && passed > bracketed)
      _events.add_missed({f, known[0].position, place->position, passed - bracketed});
  }
}

/// Folds that the orbits from the first one on do not show: on the way from the birth to it, and on that to the second.
void BranchEnds::folds_from_birth(continuation::FamilyCurve& curve) {
  const std::vector<continuation::FamilyCurve::Known>& known = curve.known();
  const double birth = known[0].position;
  WayToEnd way;
  way.crossing = _followed.start.base;
  way.goes_through = continuation::goes_through(_followed.start);
  if (known.size() > 2) way.inner = known[2];
  double place = known[1].position;
  for (std::size_t n = 0; n < places_from_birth; ++n, place = birth + nearer_to_birth * (place - birth)) {
    auto point = curve.at(place, true);
    if (!point || point->tangent.empty() || continuation::way_from(_followed.start, point->loop).is_along_base()) break;
    way.points.push_back(std::move(*point));
  }
  if (way.goes_through) add_beyond_zeros(curve, birth, way.points);
  _events.add_folds(folds_on(*_followed.system, _followed.start.isotropy, way), known);
}

/// Where slopes, continued from the last two places, are zero before the birth, a place between that and the birth.
void BranchEnds::add_beyond_zeros(continuation::FamilyCurve& curve, double birth,
                                  std::vector<continuation::CurvePoint>& places) const {
  if (places.size() < 2) return;
  const continuation::CurvePoint& a = places[places.size() - 2];
  const continuation::CurvePoint& b = places.back();
  std::vector<double> zeros;
  for (const bifurcation::Fold::Quantity quantity : foldable(*_followed.system)) {
    const double from = slope_of(*_followed.system, quantity, a);
    const double to = slope_of(*_followed.system, quantity, b);
    const double left = (b.position - to * (b.position - a.position) / (to - from) - birth) / (b.position - birth);
    if (left > least_left && left < 1.0) zeros.push_back(birth + left * (b.position - birth));
  }
  std::sort(zeros.begin(), zeros.end(), [&](double x, double y) { return std::abs(x - birth) > std::abs(y - birth); });
  for (const double zero : zeros) {
    auto point = curve.at(0.5 * (zero + birth), true);
    if (!point || point->tangent.empty()) return;
    const double open =
        continuation::left_open_by_rounding(*_followed.system, point->loop, _followed.start.isotropy).across;
    if (!(open > 0.0 && open < open_beside_birth * std::abs(point->position - birth))) return;
    places.push_back(std::move(*point));
  }
}

/// Of a family that goes on behind its first orbit, to the other side: a fold beside it shows on one of the two only.
void BranchEnds::folds_at_start() {
  const std::vector<continuation::FamilyCurve::Known>& known = _followed.curve.known();
  if (!_followed.work.base_is_orbit || known.size() < 2) return;
  const auto first = _followed.curve.at(known[0].position, true);
  if (!first || first->tangent.empty()) return;
  _events.add_folds(folds_on(*_followed.system, _followed.start.isotropy, {known[1], {*first}, std::nullopt}), known);
}

/// The same of test functions that are zero at the first orbit, to rounding: neither side sees their signs change. One
/// of the two looks, at the orbit that the other side steps to first.
void BranchEnds::zeros_at_start() {
  if (!_followed.work.base_is_orbit || _followed.work.lineage.side < 0 || _followed.functions.empty() ||
      _followed.curve.known().empty())
    return;
  const continuation::FamilyCurve::Known& first = _followed.curve.known().front();
  const auto point_at = [&](double position, const loop::Loop& loop) {
    return _followed.test_point(position, _followed.asked_stability(loop));
  };
  const bifurcation::TestPoint at_first = point_at(first.position, first.loop);
  if (std::none_of(at_first.readings.begin(), at_first.readings.end(), is_zero)) return;
  continuation::Start backwards = _followed.start;
  for (double& scalar : backwards.direction.scalars) scalar = -scalar;
  continuation::Branch other(_followed.system, backwards, branch_options(_followed.scene, _followed.team));
  const bool has_begun = other.advance().has_value();
  const std::optional<continuation::Orbit> before = has_begun ? other.advance() : std::nullopt;
  if (!before || _followed.curve.known().size() < 2) return _events.add_untold_start();
  std::vector<continuation::FamilyCurve::Known> known{
      {first.position - continuation::arclength_between(before->loop, first.loop), before->loop,
       first.arclength - continuation::arclength_in_units(*_followed.system, before->loop, first.loop)}};
  known.insert(known.end(), _followed.curve.known().begin(), _followed.curve.known().end());
  continuation::FamilyCurve curve(_followed.system, _followed.start.isotropy,
                                  branch_options(_followed.scene, _followed.team));
  for (const continuation::FamilyCurve::Known& one : known) curve.add(one);
  const auto probe = [&](double position) -> std::optional<bifurcation::TestPoint> {
    const auto point = curve.at(position);
    return point ? std::optional(point_at(position, point->loop)) : std::nullopt;
  };
  bifurcation::Detector detector;
  std::vector<bifurcation::Bracket> found;
  for (std::size_t n = 0; n < 3 && n < known.size(); ++n)
    for (const bifurcation::Bracket& bracket :
         detector.advance(n == 1 ? at_first : point_at(known[n].position, known[n].loop), probe))
      if (is_zero(at_first.readings[bracket.function])) found.push_back(bracket);
  _events.add_zeros_at_start(found, known);
}

std::vector<continuation::Orbit> BranchEnds::look_behind_last(const std::optional<Arrival>& arrival) {
  if (!_followed.last || _followed.curve.known().size() < 2) return {};
  const auto last = _followed.curve.at(_followed.last->arclength, true);
  if (!last || last->tangent.empty()) return {};
  const std::vector<bifurcation::Fold> before_last =
      _events.folds().finish(last->position, slopes_at(*_followed.system, *last));
  WayToEnd way;
  way.points = {*last};
  if (arrival) {
    if (!arrival->places.empty()) way.points = arrival->places;
    if (way.points.size() > 1) way.crossing = way.points.back().loop;
  }
  for (const bifurcation::Fold& fold : borne_out(*_followed.system, _followed.start.isotropy, before_last, way))
    _events.add_watched(fold);
  if (!arrival) {
    if (_followed.curve.known().size() > 2) _events.add_paired_folds(_followed.curve.known().size() - 2);
    return {};
  }
  const double left = arrival->position - way.points.back().position;
  add_behind(way.points);
  _events.go_to_meeting(_followed.last->arclength, way.points.back().position + left);
  std::vector<continuation::Orbit> behind = orbits_to_zeros(way.points);
  const std::vector<bifurcation::Fold> folds = folds_on(*_followed.system, _followed.start.isotropy, way);
  _events.add_folds(folds, _followed.curve.known());
  for (const bifurcation::Fold& fold : folds) add_orbits(way.points, fold.to, behind);
  if (way.points.size() > 1) {
    const continuation::Orbit near = orbit_of(*_followed.system, way.points.back().loop, way.points.back().position);
    for (continuation::Orbit& wanted : requested_orbits(_followed.scene, *_followed.system, _followed.curve,
                                                        *_followed.last, near, _followed.outcome.remarks))
      behind.push_back(std::move(wanted));
  }
  std::sort(behind.begin(), behind.end(), [](const auto& x, const auto& y) { return x.arclength < y.arclength; });
  return behind;
}

/// The places behind the last orbit become known orbits, as if the branch had stepped to them.
void BranchEnds::add_behind(std::vector<continuation::CurvePoint>& places) {
  _followed.curve.drop_behind(_followed.last->arclength);
  for (std::size_t n = 1; n < places.size(); ++n) {
    places[n].position = places[n - 1].position + continuation::arclength_between(places[n - 1].loop, places[n].loop);
    _followed.curve.add(places[n].position, places[n].loop, kept_orbits + n);
  }
}

/// Of the places behind the last orbit those up to the one at `to` become orbits: crossings lie within families.
void BranchEnds::add_orbits(const std::vector<continuation::CurvePoint>& places, double to,
                            std::vector<continuation::Orbit>& orbits) const {
  while (orbits.size() + 1 < places.size() && places[orbits.size()].position < to) {
    const continuation::CurvePoint& place = places[orbits.size() + 1];
    orbits.push_back(orbit_of(*_followed.system, place.loop, place.position));
  }
}

std::vector<continuation::Orbit> BranchEnds::orbits_to_zeros(const std::vector<continuation::CurvePoint>& places) {
  std::vector<continuation::Orbit> orbits;
  const auto point_at = [&](const continuation::CurvePoint& place) {
    return _events.test_point(place.position, place.loop, _followed.asked_stability(place.loop));
  };
  for (std::size_t n = 1; n < places.size(); ++n) {
    const int known = _events.count();
    _events.detect_zeros(point_at(places[n]));
    if (_events.count() > known) add_orbits(places, places[n].position, orbits);
  }
  _followed.outcome.arrival.front().is_short = _events.add_short_of_meeting(point_at(places.back()));
  return orbits;
}

}  // namespace orbweaver::survey
