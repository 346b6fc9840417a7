#include <algorithm>
#include <cmath>

#include "attempt.hpp"
#include "curve_interval.hpp"
#include "orbweaver/corrector/correct.hpp"

namespace orbweaver::continuation {

namespace {

class LoopInterval final : public CurveInterval {
 public:
  explicit LoopInterval(const IntervalOf& of)
      : _system(of.system),
        _isotropy(of.isotropy),
        _options(of.options),
        _from(of.known[of.last - 1].position),
        _to(of.known[of.last].position) {
    int cutoff = 0;
    for (const FamilyCurve::Known& k : of.known) {
      CurvePoint point;
      point.position = k.position;
      point.loop = under_map(k.loop, of.known[of.last].loop.time_map, 0);
      cutoff = std::max(cutoff, point.loop.cutoff);
      _points.push_back(std::move(point));
    }
    set_cutoff(loop::allowed_cutoff_at_least(cutoff));
  }

  std::optional<CurvePoint> at(double position, bool) override {
    for (const CurvePoint& point : _points)
      if (point.position == position && !point.tangent.empty()) return point;
    while (true) {
      const loss::Unknowns unknowns{loop::Subspace(_first.dimension, _first.cutoff, _isotropy),
                                    {loss::Scalar::period()}};
      const std::vector<double> chord_values = unknowns.difference(_first, _last);
      const Eigen::Map<const Eigen::VectorXd> chord(chord_values.data(), unknowns.size());
      const double share = (position - _from) / (_to - _from);

      loop::Loop guess = guess_at(position);
      const std::vector<double> from_first = unknowns.difference(_first, guess);
      const double off = share - Eigen::Map<const Eigen::VectorXd>(from_first.data(), unknowns.size()).dot(chord) /
                                     chord.squaredNorm();
      const Eigen::VectorXd move = off * chord;
      guess = unknowns.moved(guess, std::span(move.data(), chord_values.size()));
      if (!(guess.period > 0.0)) return std::nullopt;

      const Eigen::VectorXd normal = chord.normalized();
      const corrector::Result result = corrector::correct(
          _system, guess, unknowns, loss::Slice(unknowns.size(), conditions_at(guess, unknowns, normal)),
          _options.corrector, normal);
      const int larger = loop::next_cutoff(_first.cutoff);
      if (needs_more_harmonics(result, _options) && larger <= 2 * _options.cutoff_to) {
        set_cutoff(larger);
        continue;
      }
      if (!result.converged()) return std::nullopt;
      const std::vector<double> correction = unknowns.difference(guess, result.loop);
      if (Eigen::Map<const Eigen::VectorXd>(correction.data(), unknowns.size()).norm() >
          largest_correction * chord.norm())
        return std::nullopt;
      CurvePoint point;
      point.position = position;
      point.loop = result.loop;
      const Eigen::VectorXd& tangent = result.flat_direction.value();
      const double side = tangent.dot(chord) < 0.0 ? -1.0 : 1.0;
      point.tangent = unknowns.tangent_of(std::span(tangent.data(), static_cast<std::size_t>(tangent.size())));
      point.tangent *= side;
      std::erase_if(_points, [&](const CurvePoint& p) { return p.position == position; });
      _points.push_back(point);
      return point;
    }
  }

 private:
  void set_cutoff(int cutoff) {
    for (CurvePoint& point : _points) {
      point.loop = loop::with_cutoff(point.loop, cutoff);
      if (!point.tangent.empty())
        point.tangent = loop::with_cutoff(std::move(point.tangent), cutoff, point.loop.dimension);
      if (point.position == _from) _first = point.loop;
      if (point.position == _to) _last = point.loop;
    }
  }

  [[nodiscard]] loop::Loop guess_at(double position) const {
    std::vector<double> positions;
    for (const CurvePoint& point : _points) positions.push_back(point.position);
    const std::vector<double> weights = lagrange_weights(positions, position, _to - _from);
    loop::Loop guess = _first;
    std::fill(guess.modes.begin(), guess.modes.end(), 0.0);
    guess.period = 0.0;
    for (std::size_t p = 0; p < _points.size(); ++p) {
      if (weights[p] == 0.0) continue;
      for (std::size_t n = 0; n < guess.modes.size(); ++n) guess.modes[n] += weights[p] * _points[p].loop.modes[n];
      guess.period += weights[p] * _points[p].loop.period;
    }
    return guess;
  }

  const systems::System& _system;
  const loop::Isotropy& _isotropy;
  const Options& _options;
  double _from;
  double _to;
  loop::Loop _first;
  loop::Loop _last;
  std::vector<CurvePoint> _points;  // known and found, under one time map and with one cutoff
};

}  // namespace

std::unique_ptr<CurveInterval> make_loop_interval(const IntervalOf& of) { return std::make_unique<LoopInterval>(of); }

}  // namespace orbweaver::continuation
