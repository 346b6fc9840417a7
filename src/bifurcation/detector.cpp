#include "orbweaver/bifurcation/detector.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "orbweaver/core/error.hpp"
#include "orbweaver/numerics/locate.hpp"

namespace orbweaver::bifurcation {

namespace {

/// What surprises is measured in the largest modulus so far, kept between these: near its birth a family's functions
/// are small, and none is of interest beyond the scale of a stability index.
constexpr double least_scale = 0.1;
constexpr double largest_scale = 1.0;
/// Brent's method closes in on a minimum to this share of the bracket: its square is below rounding of the value there.
constexpr double minimum_width = 1e-6;
/// A touching zero is judged relative to the values at the bracket's ends where these are below a tenth.
constexpr double small_ends = 10.0;
/// A minimum nearer than this share to the bracket's end may belong to the next bracket, so it is looked for there
/// again.
constexpr double at_end = 0.01;
/// A parabola's minimum is examined where it lies below this share of its neighbours (a parabola is a poor model).
constexpr double deep_enough = 0.5;
/// How far beyond zero a line must come out, in parts of the function, which has not passed it. A function that comes
/// to rest at zero like a square is at 1. Not measured.
constexpr double past_zero = 2.0;

using Node = DetectorState::Node;

void sort_by_position(std::vector<Bracket>& brackets) {
  std::stable_sort(brackets.begin(), brackets.end(),
                   [](const Bracket& a, const Bracket& b) { return a.from < b.from; });
}

/// The extremum of the parabola through three nodes.
struct Vertex {
  double position;
  double value;
  double curvature;
};

Vertex vertex_of(const Node& a, const Node& b, const Node& c) {
  const double before = b.position - a.position;
  const double after = c.position - b.position;
  const double slope_before = (b.reading.value - a.reading.value) / before;
  const double slope_after = (c.reading.value - b.reading.value) / after;
  const double half_curvature = (slope_after - slope_before) / (before + after);
  const double slope = slope_before + half_curvature * before;
  return {b.position - 0.5 * slope / half_curvature, b.reading.value - 0.25 * slope * slope / half_curvature,
          2.0 * half_curvature};
}

/// A reading on the scale of its logarithm where it comes to its bound of 1, as that of a large index.
Reading stretched(const Reading& reading) {
  const double square = reading.value * reading.value;
  return {std::atanh(reading.value), reading.error / (1.0 - square)};
}

/// Halvings by which several zeros that signs show as one are parted, and where else than in the middle, if rounding
/// hides what passes there. Not measured.
constexpr int most_partings = 20;
constexpr double parting_shares[] = {0.5, 0.4, 0.6};

/// Whether its logarithm says more than the reading itself: of an index above some 20.
bool is_large(const Reading& reading) { return std::abs(reading.value) > 0.8; }

/// By how much linear interpolation from both sides is off, beyond the errors; below 0 within them, NaN where one is at
/// its bound.
double interpolation_error(const Reading& before, const Reading& here, const Reading& after, double share) {
  const double expected = before.value + share * (after.value - before.value);
  return std::abs(here.value - expected) - (before.error + here.error + after.error);
}

/// Whether a line through the first two passes zero far before the third, which has their sign: between two zeros a
/// function that is small altogether may turn, and surprise by no more than others do all the time.
bool turns_before(const Reading& before, const Reading& here, const Reading& after, double share) {
  if (here.sign() == 0 || before.sign() != here.sign() || after.sign() != here.sign()) return false;
  const double expected = here.value + (here.value - before.value) * (1.0 - share) / share;
  return expected * here.sign() < -(past_zero * std::abs(after.value) + before.error + here.error + after.error);
}

ZerosPassed passed_at(const TestPoint& point, std::size_t function) {
  return point.passed.empty() ? ZerosPassed{} : point.passed[function];
}

/// Whether some function has passed several zeros between two points: its signs would show every other one.
bool pass_several(const TestPoint& from, const TestPoint& to) {
  for (std::size_t f = 0; f < from.readings.size(); ++f)
    if (zeros_between(passed_at(from, f), passed_at(to, f)) > 1) return true;
  return false;
}

void add_sign_changes(std::size_t function, const std::vector<Node>& nodes, std::vector<Bracket>& found) {
  const Node* before = nullptr;
  for (const Node& node : nodes) {
    if (node.reading.sign() == 0) continue;
    if (before != nullptr && before->reading.sign() != node.reading.sign())
      found.push_back({function, before->position, node.position, false});
    before = &node;
  }
}

/// Where two zeros are passed that no sign shows.
void add_double_zeros(std::size_t function, const std::vector<Node>& nodes, std::vector<Bracket>& found) {
  const Node* before = nullptr;
  for (const Node& node : nodes) {
    if (!node.passed.is_known() || !has_sector(node.passed.function.kind)) continue;
    if (before != nullptr && zeros_between(before->passed, node.passed) == 2)
      found.push_back(
          {.function = function, .from = before->position, .to = node.position, .tangency = false, .is_double = true});
    before = &node;
  }
}

/// Zeros that are passed from node to node: of a dissipative system more nodes tell more passages from turns.
int zeros_along(const std::vector<Node>& nodes) {
  int count = 0;
  const Node* before = nullptr;
  for (const Node& node : nodes) {
    if (!node.passed.is_known()) continue;
    if (before != nullptr) count += zeros_between(before->passed, node.passed);
    before = &node;
  }
  return count;
}

}  // namespace

std::optional<TestPoint> Detector::probed(const Probe& probe, double position) const {
  std::optional<TestPoint> point = probe(position);
  core::require(!point || point->readings.size() == _state.watches.size(),
                "detector: the probe's point has another number of readings");
  return point;
}

/// Whether so much is turned on both sides of n that functions are no measure of it, but what the points next to it let
/// expect.
bool Detector::turns_evenly(const std::vector<TestPoint>& grid, std::size_t n) const {
  if (n == 0 || !(std::abs(grid[n].turns - grid[n - 1].turns) > _options.turning_step) ||
      !(std::abs(grid[n + 1].turns - grid[n].turns) > _options.turning_step))
    return false;
  const double share = (grid[n].position - grid[n - 1].position) / (grid[n + 1].position - grid[n - 1].position);
  const double expected = grid[n - 1].turns + share * (grid[n + 1].turns - grid[n - 1].turns);
  return std::abs(grid[n].turns - expected) <= 0.5 * _options.turning_error;
}

/// Whether the points next to n let expect another reading there: linear interpolation between them is off by half as
/// much as linear extrapolation from one side. The family's second point is compared with its first.
bool Detector::badly_extrapolated(const std::vector<TestPoint>& grid, std::size_t n) const {
  if (n + 1 == grid.size() || turns_evenly(grid, n)) return false;
  for (std::size_t f = 0; f < _state.watches.size(); ++f) {
    const Reading& here = grid[n].readings[f];
    const Reading& after = grid[n + 1].readings[f];
    const double allowed =
        _options.extrapolation_error * std::clamp(_state.watches[f].scale, least_scale, largest_scale);
    if (n == 0) {
      if (std::abs(after.value - here.value) > 2.0 * allowed + here.error + after.error) return true;
      continue;
    }
    const Reading& before = grid[n - 1].readings[f];
    const double share = (grid[n].position - grid[n - 1].position) / (grid[n + 1].position - grid[n - 1].position);
    if (interpolation_error(before, here, after, share) > 0.5 * allowed) return true;
    if (turns_before(before, here, after, share)) return true;
    if (is_large(here) && interpolation_error(stretched(before), stretched(here), stretched(after), share) >
                              0.5 * _options.logarithm_error)
      return true;
  }
  return false;
}

std::vector<TestPoint> Detector::subdivided(const TestPoint& next, const Probe& probe) const {
  std::vector<TestPoint> grid = _state.points;
  const auto known = static_cast<std::ptrdiff_t>(grid.size());
  grid.push_back(next);
  bool halved = known > 0;
  for (int level = 0; halved && level < std::max(_options.halvings, next.halvings); ++level) {
    halved = false;
    const bool in_any_case = level < next.halvings;
    std::vector<TestPoint> finer(grid.begin(), grid.begin() + known);
    for (auto n = static_cast<std::size_t>(known); n < grid.size(); ++n) {
      if (in_any_case || badly_extrapolated(grid, n - 1) || badly_extrapolated(grid, n) ||
          pass_several(grid[n - 1], grid[n])) {
        if (auto middle = probed(probe, 0.5 * (grid[n - 1].position + grid[n].position))) {
          finer.push_back(*std::move(middle));
          halved = true;
        }
      }
      finer.push_back(grid[n]);
    }
    grid = std::move(finer);
  }
  return {grid.begin() + known, grid.end()};
}

/// Closes in on the minimum of |value| between two nodes of one sign: a bracket where it may be zero. Returns how
/// many zeros are passed, as the counts of all that was probed tell.
int Detector::examine(std::size_t function, const Node& left, const Node& right, const Probe& probe,
                      std::vector<Bracket>& found) {
  const int sign = left.reading.sign();
  std::vector<Node> nodes{left, right};
  bool crossed = false;
  bool are_of_pairs = false;  // turns count the zeros of a single pair one by one
  std::optional<double> without_point;
  const auto size = [&](double position) {
    if (position == right.position) return std::abs(right.reading.value);
    if (crossed) return 0.0;
    const std::optional<TestPoint> point = probed(probe, position);
    if (!point) {
      without_point = position;
      return std::nan("");
    }
    const Reading& reading = point->readings[function];
    nodes.push_back({position, reading, passed_at(*point, function)});
    are_of_pairs = std::isnan(point->turns);
    crossed = reading.sign() == -sign;
    return sign * reading.value;
  };
  const double length = right.position - left.position;
  (void)numerics::locate_minimum(size, left.position, right.position, minimum_width * length, _options.probes);
  std::sort(nodes.begin(), nodes.end(), [](const Node& a, const Node& b) { return a.position < b.position; });
  const int passed = zeros_along(nodes);
  double& examined_to = _state.watches[function].examined_to;
  const std::size_t before = found.size();
  if (crossed)
    add_sign_changes(function, nodes, found);
  else if (are_of_pairs)
    add_double_zeros(function, nodes, found);
  if (found.size() > before) {
    examined_to = right.position;
    return passed;
  }
  // Orbits are lost where they are not isolated, as on a zero: what the minimum is, its location is to say.
  if (without_point) {
    const auto after =
        std::find_if(nodes.begin(), nodes.end(), [&](const Node& node) { return node.position > *without_point; });
    found.push_back({.function = function,
                     .from = std::prev(after)->position,
                     .to = after->position,
                     .tangency = true,
                     .lost = true});
    examined_to = right.position;
    return passed;
  }
  // Relative to the ends: near its birth a family's index leaves 2 like a power of its distance, small but not at a
  // zero.
  const double ends = std::min(std::abs(left.reading.value), std::abs(right.reading.value));
  const auto zero = [&](const Node& node) {
    return std::abs(node.reading.value) <=
           std::max(node.reading.error, _options.tangency_tolerance * std::min(1.0, small_ends * ends));
  };
  const auto least = std::min_element(nodes.begin(), nodes.end(), [](const Node& a, const Node& b) {
    return std::abs(a.reading.value) < std::abs(b.reading.value);
  });
  if (least->position < right.position - at_end * length) examined_to = right.position;
  if (!zero(*least) || !(least->reading.error <= _options.tangency_error)) return passed;
  if (least == nodes.begin() || least + 1 == nodes.end()) return passed;
  auto from = least;
  auto to = least;
  while (from != nodes.begin() && zero(*from)) --from;
  while (to + 1 != nodes.end() && zero(*to)) ++to;
  found.push_back({function, from->position, to->position, true});
  examined_to = right.position;
  return passed;
}

/// Brackets of zeros that the function has passed between two nodes one by one, as their counts tell, where places
/// between them are found that part these. Else one of all, if the sign tells one.
void Detector::part(std::size_t function, const Node& left, const Node& right, int halvings, const Probe& probe,
                    std::vector<Bracket>& found) const {
  if (halvings > 0 && zeros_between(left.passed, right.passed) > 1)
    for (const double share : parting_shares) {
      const double position = left.position + share * (right.position - left.position);
      const std::optional<TestPoint> point = probed(probe, position);
      if (!point || point->readings[function].sign() == 0 || !passed_at(*point, function).is_known()) continue;
      const Node middle{position, point->readings[function], passed_at(*point, function)};
      part(function, left, middle, halvings - 1, probe, found);
      return part(function, middle, right, halvings - 1, probe, found);
    }
  if (left.reading.sign() != right.reading.sign()) found.push_back({function, left.position, right.position, false});
}

/// Brackets the zeros that the function has passed between two nodes, as their counts tell, and signs do not show.
void Detector::count(std::size_t function, const Node& left, const Node& right, const Probe& probe,
                     std::vector<Bracket>& found) {
  int passed = zeros_between(left.passed, right.passed);
  if (passed == 0) return;
  const bool is_shown = left.reading.sign() != right.reading.sign();
  std::vector<Bracket> parted;
  if (is_shown && passed > 1) part(function, left, right, most_partings, probe, parted);
  if (parted.size() > 1) found.pop_back();  // that of all
  const std::size_t before = found.size();
  if (!is_shown) passed = std::min(passed, examine(function, left, right, probe, found));
  found.erase(std::remove_if(found.begin() + static_cast<std::ptrdiff_t>(before), found.end(),
                             [](const Bracket& bracket) { return bracket.lost; }),
              found.end());
  for (std::size_t n = before; n < found.size(); ++n)
    found[n].passed = found[n].tangency && passed == 1 && !right.passed.outside;  // there a sign would show it
  if (found.size() > before) _state.watches[function].examined_to = right.position;
  int bracketed = is_shown && parted.size() <= 1 ? 1 : 0;
  for (std::size_t n = before; n < found.size(); ++n) bracketed += found[n].is_double ? 2 : 1;
  if (parted.size() > 1) {
    found.insert(found.end(), parted.begin(), parted.end());
    bracketed += static_cast<int>(parted.size());
  }
  if (passed > bracketed) _state.missed.push_back({function, left.position, right.position, passed - bracketed});
}

/// Examines the minimum of |value| that the parabola through three nodes of one sign has between them, if it may reach
/// zero. (With unlike signs a minimum would have the wrong curvature.)
void Detector::look_for_minimum(std::size_t function, const Node& a, const Node& b, const Node& c, const Probe& probe,
                                std::vector<Bracket>& found) {
  const int sign = b.reading.sign();
  if (a.reading.sign() != sign || c.reading.sign() != sign) return;
  const Vertex vertex = vertex_of(a, b, c);
  const double examined_to = _state.watches[function].examined_to;
  if (!(vertex.position > std::max(a.position, examined_to) && vertex.position < c.position)) return;
  if (sign * vertex.curvature <= 0.0) return;
  const auto [least, most] = std::minmax({sign * a.reading.value, sign * b.reading.value, sign * c.reading.value});
  const Node& beside = vertex.position <= b.position ? a : c;
  const double smaller = sign * (std::abs(beside.reading.value) < std::abs(b.reading.value) ? beside : b).reading.value;
  if (sign * vertex.value > std::max(most - least, deep_enough * smaller)) return;
  examine(function, a.position >= examined_to ? a : b, c, probe, found);
}

void Detector::take(std::size_t function, const Node& node, const Probe& probe, std::vector<Bracket>& found) {
  Watch& watch = _state.watches[function];
  if (node.reading.sign() == 0) {
    const double size = std::abs(node.reading.value);
    if (node.reading.error <= _options.tangency_error &&
        (!watch.undecided || size < std::abs(watch.undecided->reading.value)))
      watch.undecided = node;
    return;
  }
  std::vector<Node>& last = watch.signed_nodes;
  if (!last.empty()) {
    if (last.back().reading.sign() != node.reading.sign())
      found.push_back({function, last.back().position, node.position, false});
    else if (watch.undecided && zeros_between(last.back().passed, node.passed) == 0)
      examine(function, last.back(), node, probe, found);
    count(function, last.back(), node, probe, found);
  }
  if (last.size() == 2) {
    look_for_minimum(function, last[0], last[1], node, probe, found);
    last.erase(last.begin());
  }
  last.push_back(node);
  watch.undecided.reset();
}

std::vector<Bracket> Detector::advance(const TestPoint& next, const Probe& probe) {
  if (_state.points.empty()) _state.watches.resize(next.readings.size());
  core::require(next.readings.size() == _state.watches.size(), "detector: a point has another number of readings");
  core::require(_state.points.empty() || next.position > _state.points.back().position,
                "detector: positions must increase");
  for (std::size_t f = 0; f < next.readings.size(); ++f)
    if (next.readings[f].sign() != 0)
      _state.watches[f].scale = std::max(_state.watches[f].scale, std::abs(next.readings[f].value));
  std::vector<Bracket> found;
  for (TestPoint& point : subdivided(next, probe)) {
    for (std::size_t f = 0; f < point.readings.size(); ++f)
      take(f, {point.position, point.readings[f], passed_at(point, f)}, probe, found);
    _state.points.push_back(std::move(point));
  }
  if (_state.points.size() > 2) _state.points.erase(_state.points.begin(), _state.points.end() - 2);
  sort_by_position(found);
  return found;
}

std::vector<Bracket> Detector::finish(const Probe& probe) {
  std::vector<Bracket> found;
  std::optional<TestPoint> middle;
  for (std::size_t f = 0; f < _state.watches.size(); ++f) {
    const std::vector<Node>& last = _state.watches[f].signed_nodes;
    if (last.size() < 2 || last[0].reading.sign() != last[1].reading.sign()) continue;
    const double position = 0.5 * (last[0].position + last[1].position);
    if (std::abs(last[1].reading.value) > _options.extrapolation_error || position <= _state.watches[f].examined_to)
      continue;
    if (!middle || middle->position != position) middle = probed(probe, position);
    if (!middle) continue;
    const std::vector<Node> nodes{last[0], {position, middle->readings[f]}, last[1]};
    if (nodes[1].reading.sign() == nodes[0].reading.sign())
      look_for_minimum(f, nodes[0], nodes[1], nodes[2], probe, found);
    else if (nodes[1].reading.sign() == 0 && nodes[1].reading.error <= _options.tangency_error)
      examine(f, nodes[0], nodes[2], probe, found);
    else
      add_sign_changes(f, nodes, found);
  }
  sort_by_position(found);
  return found;
}

}  // namespace orbweaver::bifurcation
