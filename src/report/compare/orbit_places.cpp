#include "compare/orbit_places.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "orbweaver/bifurcation/identity.hpp"

namespace orbweaver::report {

namespace {

/// Orbits of a family whose loops are asked where the curve does not tell.
constexpr std::size_t most_asked = 8;
/// Segments of the other family that are tried for one of them: the other steps may be shorter there by as much.
constexpr std::size_t most_segments = 12;
constexpr double loop_tolerance = bifurcation::IdentityOptions{}.tolerance;

CurveFit on_curve(std::size_t segment) {
  CurveFit fit;
  fit.segment = segment;
  fit.deviation = archive::not_computed;
  return fit;
}

// Where orbit n may lie: where the curve comes closest, or between the places of its neighbours.
std::vector<std::size_t> segments_beside(const std::vector<CurveFit>& fits, std::size_t n) {
  std::vector<std::size_t> out;
  if (!std::isinf(fits[n].excess)) out.push_back(fits[n].segment);
  std::size_t before = n;
  while (before > 0 && !fits[before].fits()) --before;
  std::size_t after = n;
  while (after + 1 < fits.size() && !fits[after].fits()) ++after;
  if (!fits[before].fits()) before = after;
  if (!fits[after].fits()) after = before;
  const auto [from, to] = std::minmax(fits[before].segment, fits[after].segment);
  // The neighbours themselves may lie on the ends of their segments.
  for (std::size_t segment = from > 0 ? from - 1 : 0; segment <= to + 1 && out.size() < most_segments; ++segment)
    out.push_back(segment);
  return out;
}

/// Of a family that leaves its crossing to both sides.
std::optional<std::size_t> last_before_birth(const TreeFamily& family) {
  if (family.crossing < 0) return std::nullopt;
  const auto after = std::lower_bound(family.arclengths.begin(), family.arclengths.end(), 0.0);
  if (after == family.arclengths.begin() || after == family.arclengths.end()) return std::nullopt;
  return static_cast<std::size_t>(after - family.arclengths.begin()) - 1;
}

}  // namespace

std::string level_name(const AtlasTree& tree) { return tree.in_parameter() ? tree.parameter : "E"; }

std::string orbit_text(const AtlasTree& tree, const TreeFamily& family, std::size_t orbit) {
  const Invariants& x = family.curve.points()[orbit];
  if (std::isnan(x.value(Invariant::level))) return fmt::format("T = {:.12g}", x.value(Invariant::period));
  return fmt::format("T = {:.12g}, {} = {:.12g}", x.value(Invariant::period), level_name(tree),
                     x.value(Invariant::level));
}

void OrbitPlaces::settle(std::vector<CurveFit>& fits) {
  leave_out_nearer_to_birth(fits);
  decide_by_loops(fits);
}

/// Where interpolation is too coarse to tell (long steps, folds of period and energy in one place), the orbits' loops
/// do.
void OrbitPlaces::decide_by_loops(std::vector<CurveFit>& fits) {
  const TreeFamily& beside = _other.family;
  if (!_loops.can_compare() || beside.orbits() < 2) return;
  std::vector<std::size_t> open;
  for (std::size_t n = 0; n < fits.size(); ++n)
    if (!fits[n].fits()) open.push_back(n);
  if (open.empty() || open.size() == fits.size()) return;
  std::vector<std::size_t> asked;
  const std::size_t count = std::min(most_asked, open.size());
  for (std::size_t c = 0; c < count; ++c) asked.push_back(open[c * open.size() / count]);
  asked.back() = open.back();
  std::size_t confirmed = 0;
  for (const std::size_t n : asked) {
    for (const std::size_t segment : segments_beside(fits, n)) {
      if (segment + 1 >= beside.orbits()) continue;
      const survey::OrbitBeside orbit{_own.tree, _own.family, n, _other.tree, beside, segment};
      const LoopAnswer answer = _loops.ask(orbit);
      ++_result.loops;
      // Two computations of one place that do not agree to the tolerance differ, though they are the same family.
      const bool is_measured = fits[n].measured && segment == fits[n].segment;
      // Beside a sharp turn no hyperplane tells; whether steps lead there from one of the two does.
      const bool is_led_to = !answer.same && !answer.decided && !is_measured && _loops.is_on_curve(orbit);
      const bool overrules =
          is_led_to ||
          (answer.same && (!is_measured || answer.distance <= _options.tolerance * answer.allowed / loop_tolerance));
      if (!overrules) continue;
      fits[n] = on_curve(segment);
      ++confirmed;
      break;
    }
  }
  leave_out_undecided(fits);
  if (confirmed < asked.size()) return;
  for (const std::size_t n : open)
    if (!fits[n].measured && !fits[n].fits()) fits[n] = on_curve(fits[n].segment);
}

/// Of a family that leaves its crossing to both sides: the orbits between the other's two first ones, which lie as far
/// from the crossing as the scene says.
void OrbitPlaces::leave_out_nearer_to_birth(std::vector<CurveFit>& fits) {
  const std::optional<std::size_t> own = last_before_birth(_own.family);
  const std::optional<std::size_t> other = last_before_birth(_other.family);
  if (!own || !other) return;
  std::size_t first = *own + 1;
  while (first > 0 && !fits[first - 1].fits()) --first;
  std::size_t end = *own + 1;
  while (end < fits.size() && !fits[end].fits()) ++end;
  if (first == end || first == 0 || end == fits.size()) return;
  const auto is_beside = [&](std::size_t segment) { return segment + 1 >= *other && segment <= *other + 1; };
  if (!is_beside(fits[first - 1].segment) || !is_beside(fits[end].segment)) return;
  for (std::size_t n = first; n < end; ++n) fits[n] = on_curve(*other);
  _result.notes.push_back(
      fmt::format("{} of {} orbits of {} are nearer to its birth than the other's first ones and "
                  "were not compared",
                  end - first, fits.size(), _own.family.name));
}

/// Period and energy have their extrema in one place: no curve goes by there, and Newton's method is at a loss (a
/// crossing lies beside it). With both neighbours in their places nothing says that the orbit is not.
void OrbitPlaces::leave_out_undecided(std::vector<CurveFit>& fits) {
  for (std::size_t n = 1; n + 1 < fits.size(); ++n) {
    if (!std::isinf(fits[n].excess) || !fits[n - 1].fits() || !fits[n + 1].fits()) continue;
    const auto [from, to] = std::minmax(fits[n - 1].segment, fits[n + 1].segment);
    if (to - from > 1) continue;
    fits[n] = on_curve(from);
    _result.notes.push_back(fmt::format("{} at {} is between two that both have and was not compared", _own.family.name,
                                        orbit_text(_own.tree, _own.family, n)));
  }
}

}  // namespace orbweaver::report
