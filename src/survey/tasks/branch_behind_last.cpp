// What a branch asks of the way behind its last orbit, to a limit or to the family that it meets.
#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "arrival.hpp"
#include "branch_task.hpp"
#include "end_folds.hpp"
#include "executor.hpp"
#include "orbit_row.hpp"
#include "requested.hpp"

namespace orbweaver::survey {

/// Folds that no orbit behind the last one shows; on the way from there to a meeting zeros of test functions too.
void BranchTask::look_behind_last() {
  if (!_last || _curve.known().size() < 2) return;
  const auto last = _curve.at(_last->arclength, true);
  if (!last || last->tangent.empty()) return;
  const std::vector<bifurcation::Fold> before_last = _folds.finish(last->position, slopes_at(*_system, *last));
  WayToEnd way;
  way.points = {*last};
  if (_arrival) {
    way.points = places_before(*_arrival, _curve, _symmetry, *last);
    if (way.points.size() > 1) way.crossing = way.points.back().loop;
  }
  add_folds(borne_out(*_system, _start.isotropy, before_last, way), _curve.known());
  if (!_arrival) {
    if (_curve.known().size() > 2) add_paired_folds(_curve.known().size() - 2);
    return;
  }
  add_behind(way.points);
  std::vector<continuation::Orbit> behind = orbits_to_zeros(way.points);
  add_folds(folds_on(*_system, _start.isotropy, way), _curve.known());
  if (way.points.size() > 1) {
    const continuation::Orbit near = orbit_of(*_system, way.points.back().loop, way.points.back().position);
    for (continuation::Orbit& wanted : requested_orbits(_scene, *_system, _curve, *_last, near, _outcome.remarks))
      behind.push_back(std::move(wanted));
  }
  std::sort(behind.begin(), behind.end(), [](const auto& x, const auto& y) { return x.arclength < y.arclength; });
  for (const continuation::Orbit& orbit : behind) store(orbit, asked_stability(orbit.loop));
}

/// The places behind the last orbit become known orbits, as if the branch had stepped to them.
void BranchTask::add_behind(std::vector<continuation::CurvePoint>& places) {
  _curve.drop_behind(_last->arclength);
  for (std::size_t n = 1; n < places.size(); ++n) {
    places[n].position = places[n - 1].position + continuation::arclength_between(places[n - 1].loop, places[n].loop);
    _curve.add(places[n].position, places[n].loop, kept_orbits + n);
  }
}

/// Of the places behind the last orbit those up to the last zero of a test function: crossings lie within families.
std::vector<continuation::Orbit> BranchTask::orbits_to_zeros(const std::vector<continuation::CurvePoint>& places) {
  std::vector<continuation::Orbit> orbits;
  for (std::size_t n = 1; n < places.size(); ++n) {
    const int known = _events;
    detect_zeros(test_point(places[n].position, asked_stability(places[n].loop)));
    while (_events > known && orbits.size() < n) {
      const continuation::CurvePoint& place = places[orbits.size() + 1];
      orbits.push_back(orbit_of(*_system, place.loop, place.position));
    }
  }
  return orbits;
}

}  // namespace orbweaver::survey
