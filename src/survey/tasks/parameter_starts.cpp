#include "parameter_starts.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include "equilibrium_places.hpp"
#include "given_start.hpp"
#include "orbweaver/loop/symmetry/isotropy.hpp"
#include "orbweaver/starts/equilibrium_curve.hpp"

namespace orbweaver::survey {

namespace {

/// Of an orbit that rests: its neighbours take more where they need them.
constexpr int rest_cutoff = 15;

}  // namespace

SweepOutcome hopf_starts(const scene::Scene& scene, const systems::System& system, const SweepWork& work) {
  SweepOutcome outcome;
  outcome.index = work.index;
  outcome.point = work.point;
  starts::EquilibriumCurveOptions options;
  options.parameter_from = scene.limits.parameter_from;
  options.parameter_to = scene.limits.parameter_to;
  const starts::EquilibriumCurve curve = starts::follow_equilibrium(system, work.point, options);
  outcome.equilibria = places_on(system, curve);
  if (!std::isnan(curve.stays))
    outcome.without_family.push_back(fmt::format(
        "a pair of eigenvalues, of the period {:.9g}, stays on the imaginary axis along the curve of equilibria, which "
        "is no Hopf point: the equilibrium is a centre at all values of {}, and its orbits are no isolated ones; if "
        "the "
        "system conserves a quantity, name it in structure.conserved, if it is reversible, name its reversors (and no "
        "`dissipative`), and leave out continuation.free",
        curve.stays * system.scales().time, system.family_scalars().free.front()));
  std::vector<starts::HopfPoint> points = curve.hopf;
  std::stable_sort(points.begin(), points.end(),
                   [](const starts::HopfPoint& a, const starts::HopfPoint& b) { return a.distance < b.distance; });
  for (const starts::HopfPoint& hopf : points) {
    FoundMode found;
    found.place = outcome.families++;
    found.period = hopf.period;
    found.direction = hopf.direction;
    found.cutoff = options.cutoff;
    found.isotropy = hopf.isotropy;
    found.base = loop::constant_loop(hopf.at.state, hopf.period, options.cutoff);
    found.base.parameters = {hopf.at.parameter};
    found.distance = hopf.distance;
    outcome.modes.push_back(std::move(found));
  }
  return outcome;
}

SweepOutcome drive_start(const scene::Scene& scene, const systems::System& system, const SweepWork& work) {
  SweepOutcome outcome;
  outcome.index = work.index;
  outcome.point = work.point;
  std::vector<double> field(work.point.size());
  system.field(1, work.point.data(), field.data());
  FoundMode found;
  found.period = 2.0 * std::numbers::pi / std::abs(field.back());
  found.cutoff = rest_cutoff;
  found.base = loop::constant_loop(work.point, found.period, found.cutoff);
  found.base.winding.back() = std::copysign(1.0, field.back());
  for (const std::string& name : system.family_scalars().free)
    found.base.parameters.push_back(system.parameters().at(name) / system.parameter_scale(name));
  found.isotropy = loop::find_isotropy(system.structure(), found.base, loop::symmetry_tolerance);
  found.base_is_orbit = true;
  found.direction = along_last_scalar(found.base);
  const double here = found.base.parameters.back();
  const bool is_least = here <= scene.limits.parameter_from;
  const bool is_largest = here >= scene.limits.parameter_to;
  found.one_direction = is_least || is_largest;
  if (is_largest) found.direction *= -1.0;
  outcome.modes.push_back(std::move(found));
  outcome.families = 1;
  outcome.equilibria = {equilibrium_place(system, work.point, starts::linear_modes(system, work.point))};
  return outcome;
}

}  // namespace orbweaver::survey
