#include "orbweaver/survey/atlas/loop_check.hpp"

#include <algorithm>
#include <cmath>

#include "orbweaver/archive/read/loop_of.hpp"
#include "orbweaver/bifurcation/family_jump.hpp"
#include "orbweaver/bifurcation/identity.hpp"
#include "orbweaver/continuation/family_curve.hpp"
#include "orbweaver/loop/curve/in_units.hpp"
#include "orbweaver/loop/curve/measures.hpp"
#include "orbweaver/loop/symmetry/alignment.hpp"
#include "orbweaver/loop/symmetry/isotropy.hpp"
#include "orbweaver/loop/symmetry/isotropy_text.hpp"
#include "orbweaver/loop/symmetry/symmetry_group.hpp"
#include "orbweaver/survey/atlas/stored_orbits.hpp"

namespace orbweaver::survey {

namespace {

/// Orbits that are tried before two families count as different: Newton's method may fail beside one.
constexpr int most_tries = 3;
/// Orbits on either side of a crossing from which its own is found: as a location has
/// (survey/tasks/branch/followed_branch.hpp).
constexpr std::size_t orbits_beside = 3;
/// From an orbit to the next by way of one between them, in parts of the chord: that of a family that turns by 90
/// degrees is 1.4.
constexpr double longest_way = 1.5;
/// To either side of a place on a chord, in parts of it: where nearer orbits are looked for.
constexpr double beside_place = 0.05;
/// An orbit found to be the family's lies so far beyond the two that it is sought between, in parts of their chord, at
/// most: beside one of them Newton's method may fail in the segment that holds it, and not in the next.
constexpr double outside_segment = 0.1;

continuation::Orbit orbit_of(const AtlasTree& tree, const TreeFamily& family, std::size_t orbit,
                             const systems::System& system) {
  const std::size_t row = family.first_orbit + orbit;
  const systems::Scales& scales = system.scales();
  continuation::Orbit out;
  out.loop = stored_loop(tree.atlas, row, system);
  out.energy = tree.atlas.orbits().reals("energy")[row] / scales.energy();
  out.action = tree.atlas.orbits().reals("action")[row] / scales.action();
  return out;
}

/// The orbit at a crossing, gone around as what is born there.
loop::Loop born_loop(const AtlasTree& tree, std::size_t crossing, const loop::Loop& orbit) {
  const int times = tree.crossings[crossing].multiplicity;
  return times == 1 ? orbit : loop::repeated(loop::evenly_in_time(orbit), times);
}

std::size_t symmetries_of(const systems::Structure& system, const loop::Loop& orbit) {
  return loop::SymmetryGroup(system, loop::find_isotropy(system, orbit, loop::symmetry_tolerance)).elements().size();
}

/// Moves two orbits of a family towards the place between them where it may pass through a crossing of another one;
/// false where it passes too far away, or has no orbits there. The hyperplane across the chord at the crossing holds
/// orbits of the other family too, and the one found there is off by the chord's bulge: a hundredth as much on a tenth
/// of the chord.
bool closer_together(const std::shared_ptr<const systems::System>& system, const loop::Isotropy& isotropy,
                     const bifurcation::Comparison& found, continuation::Orbit& a, continuation::Orbit& b) {
  constexpr double off_chord = 0.02;  // an orbit further from it, in parts of its length, is another family's
  const double length = loop::mean_distance(a.loop, b.loop);
  if (!(found.position > beside_place && found.position < 1.0 - beside_place && found.distance < beside_place * length))
    return false;
  continuation::FamilyCurve curve(system, isotropy, {});
  curve.add(0.0, a.loop);
  curve.add(1.0, b.loop);
  std::vector<continuation::Orbit> near;
  for (const double position : {found.position - beside_place, found.position + beside_place}) {
    const std::optional<continuation::CurvePoint> point = curve.at(position);
    if (!point) return false;
    const double to_a = loop::mean_distance(point->loop, a.loop) / length;
    const double to_b = loop::mean_distance(point->loop, b.loop) / length;
    if (std::abs(to_a - position) > off_chord || std::abs(to_b - (1.0 - position)) > off_chord) return false;
    continuation::Orbit& orbit = near.emplace_back();
    orbit.loop = point->loop;
    orbit.energy = continuation::energy_of(*system, orbit.loop);
    orbit.action = continuation::action_of(*system, orbit.loop);
  }
  a = near.front();
  b = near.back();
  return true;
}

/// Where both were followed with the same steps it is one of the two, and nothing need be corrected.
std::optional<LoopAnswer> as_one_of(const systems::Structure& system, const loop::Loop& orbit, const loop::Loop& a,
                                    const loop::Loop& b, double allowed) {
  for (const loop::Loop* node : {&a, &b}) {
    const double in_period = std::abs(orbit.period / node->period - 1.0);
    if (in_period > allowed) continue;
    const double distance = std::hypot(in_period, loop::align(system, orbit, *node, allowed).distance);
    if (distance <= allowed) return LoopAnswer{true, distance, allowed, "the same orbit", true};
  }
  return std::nullopt;
}

/// By modes alone: no image under a symmetry is known, and nothing can be corrected.
LoopAnswer without_formulas(const OrbitBeside& x) {
  const archive::Header& header = x.own.atlas.header();
  systems::Structure known;
  known.dimension = static_cast<int>(header.state_names.size());
  known.angles = header.winding_coordinates;
  systems::Scales scales;
  if (header.scales.size() > header.state_names.size()) {
    scales.time = header.scales.front();
    scales.coordinates.assign(header.scales.begin() + 1, header.scales.begin() + 1 + known.dimension);
  }
  LoopAnswer unknown;
  unknown.decided = false;
  for (const AtlasTree* tree : {&x.own, &x.other})
    if (tree->atlas.header().winding_coordinates.size() != header.winding_names.size()) return unknown;
  const auto loop_at = [&](const AtlasTree& tree, const TreeFamily& family, std::size_t orbit) {
    return loop::in_scales(archive::loop_of(tree.atlas, family.first_orbit + orbit), scales);
  };
  const loop::Loop orbit = loop_at(x.own, x.family, x.orbit);
  return as_one_of(known, orbit, loop_at(x.other, x.beside, x.segment), loop_at(x.other, x.beside, x.segment + 1),
                   continuation::same_within(orbit))
      .value_or(unknown);
}

}  // namespace

LoopAnswer LoopCheck::ask(const OrbitBeside& x) const {
  if (!can_compare()) return without_formulas(x);
  const systems::Structure& system = _system->structure();
  const bifurcation::IdentityOptions options;
  const continuation::Orbit orbit = orbit_of(x.own, x.family, x.orbit, *_system);
  const continuation::Orbit a = orbit_of(x.other, x.beside, x.segment, *_system);
  const continuation::Orbit b = orbit_of(x.other, x.beside, x.segment + 1, *_system);
  const double allowed = continuation::same_within(orbit.loop, options.tolerance);
  if (const auto answer = as_one_of(system, orbit.loop, a.loop, b.loop, allowed)) return *answer;
  const bifurcation::Comparison found =
      bifurcation::same_family(*_system, a, b, loop::isotropy_of(system, x.beside.isotropy), orbit, options);
  // Where a family turns sharply it crosses the planes across its own chords beyond their ends.
  if (found.same && &x.family == &x.beside && !(found.position >= 0.0 && found.position <= 1.0))
    return {false, found.distance, allowed, "beyond the two orbits of its own family", true};
  return {found.same, found.distance, allowed, found.detail, found.decided};
}

bool LoopCheck::is_on_curve(const OrbitBeside& x) const {
  const systems::Structure& system = _system->structure();
  const loop::Isotropy isotropy = loop::isotropy_of(system, x.beside.isotropy);
  const loop::Loop orbit = orbit_of(x.own, x.family, x.orbit, *_system).loop;
  const double allowed = continuation::same_within(orbit);
  const std::size_t symmetries = symmetries_of(system, orbit);
  for (const std::size_t node : {x.segment, x.segment + 1}) {
    const loop::Loop known = orbit_of(x.other, x.beside, node, *_system).loop;
    if (symmetries_of(system, known) < symmetries) continue;  // what lies between such has more at a crossing only
    const loop::Loop beside = loop::aligned(orbit, loop::align(system, orbit, known));
    if (continuation::arclength_between(known, beside) <= allowed) return true;
    continuation::FamilyCurve curve(_system, isotropy, {});
    curve.add(0.0, known);
    curve.add(1.0, beside);
    if (bifurcation::is_one_curve(curve)) return true;
  }
  return false;
}

std::optional<loop::Loop> LoopCheck::orbit_at(const AtlasTree& tree, std::size_t crossing) const {
  const systems::Structure& system = _system->structure();
  const TreeFamily& family = tree.families[static_cast<std::size_t>(tree.crossings[crossing].family)];
  const double position = tree.atlas.crossings().reals("arclength")[crossing];
  const auto after = std::upper_bound(family.arclengths.begin(), family.arclengths.end(), position);
  if (after == family.arclengths.end()) return std::nullopt;
  const auto next = static_cast<std::size_t>(after - family.arclengths.begin());
  continuation::FamilyCurve curve(_system, loop::isotropy_of(system, family.isotropy), {});
  const std::size_t first = next > orbits_beside ? next - orbits_beside : 0;
  const std::size_t end = std::min(next + orbits_beside, family.orbits());
  std::optional<loop::Loop> before;
  if (next == 0) {  // before the first orbit there is the family's birth
    if (family.crossing < 0) return std::nullopt;
    const auto birth = static_cast<std::size_t>(family.crossing);
    const std::optional<loop::Loop> parent = orbit_at(tree, birth);
    if (!parent) return std::nullopt;
    const loop::Loop nearest = orbit_of(tree, family, 0, *_system).loop;
    const loop::Loop born = born_loop(tree, birth, *parent);
    before = loop::aligned(born, loop::align(system, born, nearest));
    const double start = family.arclengths[0] - continuation::arclength_in_units(*_system, *before, nearest);
    if (position < start) return std::nullopt;
    curve.add(start, *before, end + 1);
  }
  for (std::size_t n = first; n < end; ++n) {
    const continuation::Orbit known = orbit_of(tree, family, n, *_system);
    before = before ? started_as(system, known.loop, *before) : known.loop;
    curve.add(family.arclengths[n], *before, end - first + 1);
  }
  const std::optional<continuation::CurvePoint> there = curve.at(position);
  return there ? std::optional(there->loop) : std::nullopt;
}

bool LoopCheck::passes_by(const AtlasTree& tree, std::size_t crossing, const TreeFamily& beside,
                          std::size_t segment) const {
  const systems::Structure& system = _system->structure();
  const TreeFamily& family = tree.families[static_cast<std::size_t>(tree.crossings[crossing].family)];
  const double position = tree.atlas.crossings().reals("arclength")[crossing];
  const auto after = std::upper_bound(family.arclengths.begin(), family.arclengths.end(), position);
  if (after == family.arclengths.begin() || after == family.arclengths.end()) return false;
  const auto next = static_cast<std::size_t>(after - family.arclengths.begin());
  const auto born_beside = [&](std::size_t n) {
    return born_loop(tree, crossing, orbit_of(tree, family, n, *_system).loop);
  };
  const auto apart = [&](const loop::Loop& x, const loop::Loop& y) { return loop::align(system, x, y).distance; };
  const loop::Loop near = born_beside(next - 1);
  const double reach = longest_way * apart(near, born_beside(next));
  const loop::Loop a = orbit_of(tree, beside, segment, *_system).loop;
  const loop::Loop b = orbit_of(tree, beside, segment + 1, *_system).loop;
  return apart(near, a) + apart(near, b) - 2.0 * reach > longest_way * loop::mean_distance(a, b);
}

LoopAnswer LoopCheck::ask_crossing(const AtlasTree& tree, std::size_t crossing, const TreeFamily& beside,
                                   std::size_t segment) const {
  const std::optional<loop::Loop> there = orbit_at(tree, crossing);
  if (!there) {
    LoopAnswer unknown;
    unknown.decided = passes_by(tree, crossing, beside, segment);
    return unknown;
  }
  continuation::Orbit orbit;
  orbit.loop = born_loop(tree, crossing, *there);
  orbit.energy = continuation::energy_of(*_system, orbit.loop);
  orbit.action = continuation::action_of(*_system, orbit.loop);
  return between_orbits(orbit, tree, beside, segment).answer;
}

std::optional<double> LoopCheck::arclength_of(const loop::Loop& loop, const AtlasTree& tree, const TreeFamily& beside,
                                              std::size_t segment) const {
  continuation::Orbit orbit;
  orbit.loop = loop;
  orbit.energy = continuation::energy_of(*_system, loop);
  orbit.action = continuation::action_of(*_system, loop);
  const Between found = between_orbits(orbit, tree, beside, segment);
  const bool is_near = found.position >= -outside_segment && found.position <= 1.0 + outside_segment;
  if (!found.answer.same || !is_near) return std::nullopt;
  const double from = beside.arclengths[segment];
  return from + found.position * (beside.arclengths[segment + 1] - from);
}

LoopCheck::Between LoopCheck::between_orbits(const continuation::Orbit& orbit, const AtlasTree& tree,
                                             const TreeFamily& beside, std::size_t segment) const {
  const systems::Structure& system = _system->structure();
  bifurcation::IdentityOptions options;
  options.keeps_repetitions = true;
  const loop::Isotropy isotropy = loop::isotropy_of(system, beside.isotropy);
  continuation::Orbit a = orbit_of(tree, beside, segment, *_system);
  continuation::Orbit b = orbit_of(tree, beside, segment + 1, *_system);
  const double allowed = continuation::same_within(orbit.loop, options.tolerance);
  const double to_a = loop::align(system, orbit.loop, a.loop).distance;
  const double to_b = loop::align(system, orbit.loop, b.loop).distance;
  if (to_a + to_b > longest_way * loop::mean_distance(a.loop, b.loop))
    return {{false, std::min(to_a, to_b), allowed, "not between the neighbours", true}};
  bifurcation::Comparison found = bifurcation::same_family(*_system, a, b, isotropy, orbit, options);
  if (!found) {  // not before: on either side of the crossing may lie images of one another
    continuation::Orbit started = a;
    started.loop = loop::aligned(a.loop, loop::align(system, a.loop, b.loop));
    const bifurcation::Comparison again = bifurcation::same_family(*_system, started, b, isotropy, orbit, options);
    if (again.distance < found.distance) {
      found = again;
      a = started;
    }
  }
  double from = 0.0;
  double to = 1.0;
  if (!found && closer_together(_system, isotropy, found, a, b)) {
    from = found.position - beside_place;
    to = found.position + beside_place;
    found = bifurcation::same_family(*_system, a, b, isotropy, orbit, options);
  }
  return {{found.same, found.distance, allowed, found.detail, found.decided}, from + found.position * (to - from)};
}

std::vector<LoopCheck::Sample> LoopCheck::sample(const AtlasTree& own, const TreeFamily& family, const AtlasTree& other,
                                                 const TreeFamily& beside, const std::vector<CurveFit>& fits,
                                                 int count) const {
  std::vector<Sample> samples;
  if (beside.orbits() < 2) return samples;
  std::vector<std::size_t> placed;
  for (std::size_t n = 0; n < fits.size(); ++n)
    if (fits[n].fits()) placed.push_back(n);
  const std::size_t chosen = std::min(placed.size(), static_cast<std::size_t>(std::max(0, count)));
  for (std::size_t c = 0; c < chosen; ++c) {
    const std::size_t n = placed[(2 * c + 1) * placed.size() / (2 * chosen)];
    const LoopAnswer answer = ask({own, family, n, other, beside, fits[n].segment});
    if (can_compare() || answer.decided) samples.push_back({n, answer});
  }
  return samples;
}

bool LoopCheck::are_same(const AtlasTree& a, const TreeFamily& family_a, const AtlasTree& b,
                         const TreeFamily& family_b) const {
  const std::vector<CurveFit> fits = fit_all(family_b.curve, family_a.curve.points());
  const std::vector<Sample> samples = sample(a, family_a, b, family_b, fits, most_tries);
  return samples.empty() || std::any_of(samples.begin(), samples.end(), [](const Sample& s) { return s.answer.same; });
}

}  // namespace orbweaver::survey
