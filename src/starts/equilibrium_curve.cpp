#include "orbweaver/starts/equilibrium_curve.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <Eigen/Core>

#include "branch_points.hpp"
#include "curve_equations.hpp"
#include "hopf_points.hpp"
#include "orbweaver/core/error.hpp"

namespace orbweaver::starts {

namespace {

using Eigen::Index;
using Eigen::VectorXd;

/// Steps grow by this where Newton's method takes at most so many steps, and are halved where it fails.
constexpr double growth = 1.5;
constexpr int few_steps = 4;
/// Cosine of the largest turn of the direction over a step: a longer one may have gone over to another curve.
constexpr double least_cosine = 0.9;
/// Steps after which a curve may have come back.
constexpr std::size_t least_round = 8;
/// Of the length of state and parameter: the largest step far out, where scales of the neighbourhood say little.
constexpr double step_far_out = 0.01;

/// A point that was located between two nodes.
struct Between {
  VectorXd x;
  EquilibriumKind kind;
  double period = 0.0;
};

/// One side of the curve, from a node on.
class Side {
 public:
  Side(const CurveEquations& curve, CurveNode start) : _curve(curve), _nodes{std::move(start)} {}

  void run() {
    const EquilibriumCurveOptions& options = _curve.options();
    double length = options.largest_step;
    while (_end.empty()) {
      if (static_cast<int>(_nodes.size()) >= options.most_points) {
        _end = fmt::format("{} points, at {} = {:.9g}: it goes on", options.most_points, _curve.name(),
                           _nodes.back().x(_curve.dimension()) * _curve.unit());
        _is_cut = true;
      } else if (!step(length)) {
        break;
      }
    }
  }
  [[nodiscard]] const std::vector<CurveNode>& nodes() const { return _nodes; }
  [[nodiscard]] const std::string& end() const { return _end; }
  [[nodiscard]] bool is_cut() const { return _is_cut; }

 private:
  bool step(double& length) {
    const EquilibriumCurveOptions& options = _curve.options();
    const CurveNode& last = _nodes.back();
    const Index p = _curve.dimension();
    while (length >= options.smallest_step) {
      int steps = 0;
      const auto x = _curve.corrected(last.x + length * last.direction, last.direction, steps);
      if (x) {
        CurveNode next{*x, _curve.direction(*x, last.direction)};
        if (next.direction.dot(last.direction) >= least_cosine) return accept(std::move(next), steps, length);
      }
      length *= 0.5;
    }
    _end = fmt::format("no equilibrium further on from {} = {:.9g}", _curve.name(), last.x(p) * _curve.unit());
    return false;
  }

  bool accept(CurveNode next, int steps, double& length) {
    const EquilibriumCurveOptions& options = _curve.options();
    const Index p = _curve.dimension();
    if (!_curve.is_within(next.x(p))) {
      const double limit = next.x(p) > options.parameter_to ? options.parameter_to : options.parameter_from;
      const double share = (limit - _nodes.back().x(p)) / (next.x(p) - _nodes.back().x(p));
      VectorXd guess = _nodes.back().x + share * (next.x - _nodes.back().x);
      guess(p) = limit;
      int more = 0;
      if (const auto x = _curve.corrected(guess, VectorXd::Unit(p + 1, p), more))
        _nodes.push_back({*x, _curve.direction(*x, next.direction)});
      _end = fmt::format("parameter limit ({} = {:g})", _curve.name(), limit * _curve.unit());
      return false;
    }
    _nodes.push_back(std::move(next));
    if ((_nodes.back().x - _nodes.front().x).norm() > options.largest_state) {
      _end = "it leaves for infinity";
      return false;
    }
    if (_nodes.size() > least_round && (_nodes.back().x - _nodes.front().x).norm() < length) {
      _end = "closed curve";
      return false;
    }
    const double largest = std::max(options.largest_step, step_far_out * _nodes.back().x.norm());
    if (steps <= few_steps) length = std::min(largest, growth * length);
    return true;
  }

  const CurveEquations& _curve;
  std::vector<CurveNode> _nodes;
  std::string _end;
  bool _is_cut = false;
};

}  // namespace

EquilibriumCurve follow_equilibrium(const systems::System& system, std::span<const double> start,
                                    const EquilibriumCurveOptions& options) {
  core::require(!system.family_scalars().free.empty(), "equilibria are followed in a parameter that moves");
  core::require(static_cast<int>(start.size()) == system.dimension(), "a state of another dimension");
  const CurveEquations curve(system, options);
  const Index d = curve.dimension();
  VectorXd x(d + 1);
  for (Index i = 0; i < d; ++i) x(i) = start[static_cast<std::size_t>(i)];
  x(d) = system.parameters().at(curve.name()) / curve.unit();
  int steps = 0;
  const auto first = curve.corrected(x, VectorXd::Unit(d + 1, d), steps);
  if (!first) throw core::NumericalError("Newton's method reaches no equilibrium from the start of the curve");
  const VectorXd ahead = curve.direction(*first, VectorXd::Unit(d + 1, d));
  Side up(curve, {*first, ahead});
  Side down(curve, {*first, -ahead});
  up.run();
  down.run();

  std::vector<CurveNode> nodes(down.nodes().rbegin(), down.nodes().rend());
  for (CurveNode& node : nodes) node.direction *= -1.0;
  nodes.insert(nodes.end(), up.nodes().begin() + 1, up.nodes().end());
  EquilibriumCurve out;
  out.ends = {down.end(), up.end()};
  out.are_cut = {down.is_cut(), up.is_cut()};
  const std::size_t begin = down.nodes().size() - 1;
  const auto length = [&](std::size_t from, std::size_t to) {
    double sum = 0.0;
    for (std::size_t n = from; n < to; ++n) sum += (nodes[n + 1].x - nodes[n].x).norm();
    return sum;
  };
  out.points.push_back({curve.equilibrium(nodes.front().x)});
  const std::vector<BranchPoints> branches = branch_points(curve, nodes);
  for (std::size_t n = 1; n < nodes.size(); ++n) {
    const CurveNode& a = nodes[n - 1];
    const CurveNode& b = nodes[n];
    std::vector<Between> between;
    const BranchPoints& branching = branches[n - 1];
    for (const VectorXd& place : branching.places) between.push_back({place, EquilibriumKind::branch_point});
    if ((a.direction(d) < 0.0) != (b.direction(d) < 0.0)) {
      const auto slope = [&](const VectorXd& at) { return curve.direction(at, a.direction)(d); };
      auto fold = zero_between(curve, a, b, slope);
      if (!branching.places.empty() || !fold) fold = zero_beside_curve(curve, a, b, slope);
      if (fold) {
        out.folds.push_back(curve.equilibrium(*fold));
        between.push_back({*fold, EquilibriumKind::fold});
      }
    }
    const double started = nodes[begin].x(d);
    if ((a.x(d) - started) * (b.x(d) - started) < 0.0)
      if (const auto again = zero_between(curve, a, b, [&](const VectorXd& at) { return at(d) - started; }))
        between.push_back({*again, EquilibriumKind::came_back});
    HopfPoints hopf = hopf_points(curve, a, b, {n == 1, n + 1 == nodes.size()});
    if (std::isnan(out.stays)) out.stays = hopf.stays;
    for (auto& [place, point] : hopf.found) {
      const double within = n > begin ? (place - a.x).norm() : (b.x - place).norm();
      point.distance = within + (n > begin ? length(begin, n - 1) : length(n, begin));
      between.push_back({place, EquilibriumKind::hopf, point.period});
      out.hopf.push_back(std::move(point));
    }
    const VectorXd chord = b.x - a.x;
    std::stable_sort(between.begin(), between.end(),
                     [&](const Between& one, const Between& other) { return chord.dot(one.x) < chord.dot(other.x); });
    for (const Between& point : between) out.points.push_back({curve.equilibrium(point.x), point.kind, point.period});
    if (n == begin) out.start = out.points.size();
    out.points.push_back({curve.equilibrium(b.x)});
    out.points.back().may_branch_before = branching.is_undecided;
    out.points.back().may_pass_before = hopf.is_undecided;
  }
  return out;
}

}  // namespace orbweaver::starts
