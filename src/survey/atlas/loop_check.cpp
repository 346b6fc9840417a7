#include "orbweaver/survey/atlas/loop_check.hpp"

#include <algorithm>
#include <cmath>

#include "orbweaver/archive/read/loop_of.hpp"
#include "orbweaver/bifurcation/identity.hpp"
#include "orbweaver/continuation/family_curve.hpp"
#include "orbweaver/loop/curve/measures.hpp"
#include "orbweaver/loop/symmetry/alignment.hpp"
#include "orbweaver/loop/symmetry/isotropy_text.hpp"

namespace orbweaver::survey {

namespace {

/// Orbits that are tried before two families count as different: Newton's method may fail beside one.
constexpr int most_tries = 3;

continuation::Orbit orbit_of(const AtlasTree& tree, const TreeFamily& family, std::size_t orbit,
                             const systems::Structure& system) {
  const std::size_t row = family.first_orbit + orbit;
  continuation::Orbit out;
  out.loop = archive::loop_of(tree.atlas, row, system.angles);
  out.energy = tree.atlas.orbits().reals("energy")[row];
  out.action = tree.atlas.orbits().reals("action")[row];
  return out;
}

}  // namespace

LoopAnswer LoopCheck::ask(const OrbitBeside& x) const {
  const systems::Structure& system = _system->structure();
  const bifurcation::IdentityOptions options;
  const continuation::Orbit orbit = orbit_of(x.own, x.family, x.orbit, system);
  const continuation::Orbit a = orbit_of(x.other, x.beside, x.segment, system);
  const continuation::Orbit b = orbit_of(x.other, x.beside, x.segment + 1, system);
  const double allowed = options.tolerance * (1.0 + loop::rms_size(orbit.loop));
  // Where both were followed with the same steps it is one of the two, and nothing need be corrected.
  for (const continuation::Orbit* node : {&a, &b}) {
    const double in_period = std::abs(orbit.loop.period / node->loop.period - 1.0);
    if (in_period > allowed) continue;
    const double distance = std::hypot(in_period, loop::align(system, orbit.loop, node->loop, allowed).distance);
    if (distance <= allowed) return {true, distance, allowed, "the same orbit", true};
  }
  const bifurcation::Comparison found =
      bifurcation::same_family(*_system, a, b, loop::isotropy_of(system, x.beside.isotropy), orbit, options);
  return {found.same, found.distance, allowed, found.detail, found.decided};
}

LoopAnswer LoopCheck::ask_crossing(const AtlasTree& tree, std::size_t crossing, const TreeFamily& beside,
                                   std::size_t segment) const {
  const systems::Structure& system = _system->structure();
  const TreeCrossing& place = tree.crossings[crossing];
  const TreeFamily& family = tree.families[static_cast<std::size_t>(place.family)];
  const double position = tree.atlas.crossings().reals("arclength")[crossing];
  const auto after = std::upper_bound(family.arclengths.begin(), family.arclengths.end(), position);
  LoopAnswer undecided;
  undecided.decided = false;
  if (after == family.arclengths.begin() || after == family.arclengths.end()) return undecided;
  const auto next = static_cast<std::size_t>(after - family.arclengths.begin());
  const continuation::Orbit from = orbit_of(tree, family, next - 1, system);
  const continuation::Orbit to = orbit_of(tree, family, next, system);
  continuation::FamilyCurve curve(_system, loop::isotropy_of(system, family.isotropy), {});
  curve.add(family.arclengths[next - 1], from.loop);
  curve.add(family.arclengths[next], loop::aligned(to.loop, loop::align(system, to.loop, from.loop)));
  const std::optional<continuation::CurvePoint> there = curve.at(position);
  if (!there) return undecided;
  continuation::Orbit orbit;
  orbit.loop = place.multiplicity == 1 ? there->loop : loop::repeated(there->loop, place.multiplicity);
  orbit.energy = continuation::energy_of(*_system, orbit.loop);
  orbit.action = continuation::action_of(*_system, orbit.loop);
  const bifurcation::Comparison found = bifurcation::same_family(*_system, orbit_of(tree, beside, segment, system),
                                                                 orbit_of(tree, beside, segment + 1, system),
                                                                 loop::isotropy_of(system, beside.isotropy), orbit);
  return {found.same, found.distance, bifurcation::IdentityOptions{}.tolerance * (1.0 + loop::rms_size(orbit.loop)),
          found.detail, found.decided};
}

std::vector<LoopCheck::Sample> LoopCheck::sample(const AtlasTree& own, const TreeFamily& family, const AtlasTree& other,
                                                 const TreeFamily& beside, const std::vector<CurveFit>& fits,
                                                 int count) const {
  std::vector<Sample> samples;
  if (!can_compare() || beside.orbits() < 2) return samples;
  std::vector<std::size_t> placed;
  for (std::size_t n = 0; n < fits.size(); ++n)
    if (fits[n].fits()) placed.push_back(n);
  const std::size_t chosen = std::min(placed.size(), static_cast<std::size_t>(std::max(0, count)));
  for (std::size_t c = 0; c < chosen; ++c) {
    const std::size_t n = placed[(2 * c + 1) * placed.size() / (2 * chosen)];
    samples.push_back({n, ask({own, family, n, other, beside, fits[n].segment})});
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
