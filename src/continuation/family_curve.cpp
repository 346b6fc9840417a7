#include "orbweaver/continuation/family_curve.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "attempt.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/corrector/correct.hpp"

namespace orbweaver::continuation {

namespace {

/// The loop under another time map, with enough harmonics for it.
loop::Loop under_map(const loop::Loop& loop, const loop::TimeMap& map, int cutoff) {
  if (loop.time_map == map) return loop::with_cutoff(loop, std::max(cutoff, loop.cutoff));
  const double allowed = std::max(1e-12, 2.0 * loop::tail(loop));
  int k = std::max(cutoff, loop.cutoff);
  loop::Loop out = loop::with_time_map(loop, map, k);
  while (loop::tail(out) > allowed && k < 4 * loop.cutoff) {
    k = loop::next_cutoff(loop::allowed_cutoff_at_least(k));
    out = loop::with_time_map(loop, map, k);
  }
  return out;
}

}  // namespace

FamilyCurve::FamilyCurve(std::shared_ptr<const systems::System> system, loop::Isotropy isotropy, const Options& options)
    : _system(std::move(system)), _isotropy(std::move(isotropy)), _options(options) {}

void FamilyCurve::add(double position, const loop::Loop& loop, std::size_t keep) {
  core::require(_known.empty() || position > _known.back().position, "orbits of a family are added in their order");
  _known.push_back({position, loop});
  if (_known.size() > keep) _known.erase(_known.begin());
  _interval.reset();
}

void FamilyCurve::open_interval(double position) {
  if (_interval && position >= _interval->from && position <= _interval->to) return;
  core::require(_known.size() >= 2 && position >= _known.front().position && position <= _known.back().position,
                "a position outside the known part of a family");
  auto last = std::find_if(_known.begin() + 1, _known.end(), [&](const Known& k) { return position <= k.position; });
  const loop::TimeMap& map = last->loop.time_map;
  _interval.emplace();
  _interval->from = (last - 1)->position;
  _interval->to = last->position;
  int cutoff = 0;
  for (const Known& k : _known) {
    CurvePoint point;
    point.position = k.position;
    point.loop = under_map(k.loop, map, 0);
    cutoff = std::max(cutoff, point.loop.cutoff);
    _interval->points.push_back(std::move(point));
  }
  set_cutoff(loop::allowed_cutoff_at_least(cutoff));
}

void FamilyCurve::set_cutoff(int cutoff) {
  for (CurvePoint& point : _interval->points) {
    point.loop = loop::with_cutoff(point.loop, cutoff);
    if (!point.tangent_modes.empty()) point.tangent_modes.resize(point.loop.modes.size(), 0.0);
  }
  for (const CurvePoint& point : _interval->points) {
    if (point.position == _interval->from) _interval->first = point.loop;
    if (point.position == _interval->to) _interval->last = point.loop;
  }
}

const CurvePoint* FamilyCurve::found_at(double position) const {
  for (const CurvePoint& point : _interval->points)
    if (point.position == position && !point.tangent_modes.empty()) return &point;
  return nullptr;
}

/// The polynomial through the four nearest points.
loop::Loop FamilyCurve::guess_at(double position) const {
  std::vector<const CurvePoint*> nearest;
  for (const CurvePoint& point : _interval->points) nearest.push_back(&point);
  std::stable_sort(nearest.begin(), nearest.end(), [&](const CurvePoint* a, const CurvePoint* b) {
    return std::abs(a->position - position) < std::abs(b->position - position);
  });
  std::vector<const CurvePoint*> used;  // well apart, so that their rounding is not amplified
  for (const CurvePoint* point : nearest) {
    const bool apart = std::all_of(used.begin(), used.end(), [&](const CurvePoint* other) {
      return std::abs(point->position - other->position) > 1e-4 * (_interval->to - _interval->from);
    });
    if (apart && used.size() < 4) used.push_back(point);
  }
  loop::Loop guess = used.front()->loop;
  std::fill(guess.modes.begin(), guess.modes.end(), 0.0);
  guess.period = 0.0;
  for (const CurvePoint* point : used) {
    double weight = 1.0;
    for (const CurvePoint* other : used)
      if (other != point) weight *= (position - other->position) / (point->position - other->position);
    for (std::size_t n = 0; n < guess.modes.size(); ++n) guess.modes[n] += weight * point->loop.modes[n];
    guess.period += weight * point->loop.period;
  }
  return guess;
}

std::optional<CurvePoint> FamilyCurve::at(double position) {
  open_interval(position);
  if (const CurvePoint* found = found_at(position)) return *found;
  while (true) {
    const loop::Loop& first = _interval->first;
    const loss::Unknowns unknowns{loop::Subspace(first.dimension, first.cutoff, _isotropy), true};
    const std::vector<double> chord_values = unknowns.difference(first, _interval->last);
    const Eigen::Map<const Eigen::VectorXd> chord(chord_values.data(), unknowns.size());
    const double share = (position - _interval->from) / (_interval->to - _interval->from);

    loop::Loop guess = guess_at(position);
    const std::vector<double> from_first = unknowns.difference(first, guess);
    const double off =
        share - Eigen::Map<const Eigen::VectorXd>(from_first.data(), unknowns.size()).dot(chord) / chord.squaredNorm();
    const Eigen::VectorXd move = off * chord;
    guess = unknowns.moved(guess, std::span(move.data(), chord_values.size()));
    if (!(guess.period > 0.0)) return std::nullopt;

    const Eigen::VectorXd normal = chord.normalized();
    const corrector::Result result = corrector::correct(
        *_system, guess, unknowns, loss::Slice(unknowns.size(), conditions_at(guess, unknowns, normal)),
        _options.corrector, normal);
    const int larger = loop::next_cutoff(first.cutoff);
    if (needs_more_harmonics(result, _options) && larger <= 2 * _options.cutoff_to) {
      set_cutoff(larger);
      continue;
    }
    if (!result.converged()) return std::nullopt;
    CurvePoint point;
    point.position = position;
    point.loop = result.loop;
    const Eigen::VectorXd& tangent = result.flat_direction.value();
    const double side = tangent.dot(chord) < 0.0 ? -1.0 : 1.0;
    point.tangent_modes.assign(guess.modes.size(), 0.0);
    unknowns.subspace.add_to(std::span(tangent.data(), static_cast<std::size_t>(unknowns.subspace.size())),
                             point.tangent_modes);
    for (double& v : point.tangent_modes) v *= side;
    point.tangent_period = side * tangent(unknowns.size() - 1);
    std::vector<CurvePoint>& points = _interval->points;
    std::erase_if(points, [&](const CurvePoint& p) { return p.position == position; });
    points.insert(std::upper_bound(points.begin(), points.end(), point,
                                   [](const CurvePoint& a, const CurvePoint& b) { return a.position < b.position; }),
                  point);
    return point;
  }
}

}  // namespace orbweaver::continuation
