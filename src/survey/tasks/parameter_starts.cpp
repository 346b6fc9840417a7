#include "parameter_starts.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "orbweaver/certificate/integrate.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/loop/curve/measures.hpp"
#include "orbweaver/loop/curve/time_samples.hpp"
#include "orbweaver/loop/symmetry/isotropy.hpp"
#include "orbweaver/loop/symmetry/shift_search.hpp"
#include "orbweaver/starts/equilibrium_curve.hpp"
#include "orbweaver/survey/tasks/branch_options.hpp"

namespace orbweaver::survey {

namespace {

/// Samples of a trajectory, and its integrator's tolerance: the orbit is corrected from them.
constexpr int samples_of_guess = 4 * loop::time_sample_count;
constexpr double guess_tolerance = 1e-10;
/// Of a guess's harmonics, relative to its size: smaller ones are left out.
constexpr double left_out = 1e-9;
/// Of an orbit that rests: its neighbours take more where they need them.
constexpr int rest_cutoff = 15;

/// The trajectory from a state over a period as a loop, what it misses spread evenly over it.
loop::Loop guess_of(const systems::System& system, const SweepWork& work) {
  const auto d = static_cast<std::size_t>(system.dimension());
  const auto count = static_cast<std::size_t>(samples_of_guess);
  loop::TimeSamples samples;
  samples.dimension = system.dimension();
  samples.count = samples_of_guess;
  samples.period = work.period;
  samples.states.resize(d * count);
  std::vector<double> state = work.point;
  for (std::size_t j = 0; j < count; ++j) {
    for (std::size_t i = 0; i < d; ++i) samples.states[i * count + j] = state[i];
    state = certificate::integrate(system, std::move(state), work.period / samples_of_guess, guess_tolerance);
  }
  samples.winding.assign(d, 0.0);
  for (std::size_t i = 0; i < d; ++i) {
    double gap = state[i] - work.point[i];
    if (system.structure().is_angle(i)) {
      samples.winding[i] = std::round(gap / (2.0 * std::numbers::pi));
      gap -= 2.0 * std::numbers::pi * samples.winding[i];
    }
    for (std::size_t j = 0; j < count; ++j) {
      const double share = static_cast<double>(j) / static_cast<double>(count);
      samples.states[i * count + j] -= share * (gap + 2.0 * std::numbers::pi * samples.winding[i]);
    }
  }
  loop::Loop out = loop::interpolant(samples);
  const double allowed = left_out * loop::rms_amplitude(out);
  int cutoff = out.cutoff;
  while (loop::previous_cutoff(cutoff) < cutoff &&
         loop::mean_distance(out, loop::with_cutoff(out, loop::previous_cutoff(cutoff))) < allowed)
    cutoff = loop::previous_cutoff(cutoff);
  out = loop::with_cutoff(out, loop::allowed_cutoff_at_least(cutoff));
  for (const std::string& name : system.family_scalars().free)
    out.parameters.push_back(system.parameters().at(name) / system.parameter_scale(name));
  return out;
}

/// The orbit started where the first reversor that it has maps it to itself; as it is where it has none.
loop::Loop at_reversor(const systems::Structure& structure, const loop::Loop& orbit) {
  const loop::Loop even = loop::evenly_in_time(orbit);
  for (const systems::Symmetry& reversor : structure.reversors) {
    // R z(-t), which is z(t - sigma) for some sigma where the orbit has the symmetry.
    const loop::Loop image = loop::transformed(even, reversor.map, true, 0.0);
    const std::vector<loop::ShiftMinimum> shifts = loop::shift_minima(image, even, structure.angles);
    if (shifts.empty() || !(shifts.front().square < std::pow(loop::symmetry_tolerance, 2))) continue;
    for (const double start : {-0.5 * shifts.front().shift, 0.5 * shifts.front().shift}) {
      loop::Loop moved = loop::time_shifted(even, start - std::floor(start));
      for (const loop::SymmetryElement& element : loop::find_isotropy(structure, moved, loop::symmetry_tolerance))
        if (element.reversing && element.shift_numerator == 0) return moved;
    }
  }
  return orbit;
}

loop::Tangent along_scalar(const loop::Loop& base, double sign) {
  loop::Tangent direction{std::vector<double>(base.modes.size(), 0.0),
                          std::vector<double>(1 + base.parameters.size(), 0.0)};
  direction.scalars.back() = sign;
  return direction;
}

}  // namespace

SweepOutcome hopf_starts(const scene::Scene& scene, const systems::System& system, const SweepWork& work) {
  SweepOutcome outcome;
  outcome.index = work.index;
  outcome.point = work.point;
  starts::EquilibriumCurveOptions options;
  options.parameter_from = scene.limits.parameter_from;
  options.parameter_to = scene.limits.parameter_to;
  std::vector<starts::HopfPoint> points = starts::follow_equilibrium(system, work.point, options).hopf;
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

SweepOutcome drive_start(const systems::System& system, const SweepWork& work) {
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
  found.direction = along_scalar(found.base, 1.0);
  outcome.modes.push_back(std::move(found));
  outcome.families = 1;
  return outcome;
}

SweepOutcome state_start(const scene::Scene& scene, const std::shared_ptr<const systems::System>& system,
                         const SweepWork& work, core::Team* team) {
  SweepOutcome outcome;
  outcome.index = work.index;
  outcome.point = work.point;
  continuation::Start start;
  start.base = guess_of(*system, work);
  start.direction = along_scalar(start.base, 1.0);
  start.base_is_orbit = true;
  continuation::Branch branch(system, start, branch_options(scene, team));
  const std::optional<continuation::Orbit> orbit = branch.advance();
  if (!orbit) throw core::NumericalError(branch.ending().value().text());
  FoundMode found;
  found.base = at_reversor(system->structure(), orbit->loop);
  found.isotropy = loop::find_isotropy(system->structure(), found.base, loop::symmetry_tolerance);
  found.period = found.base.period;
  found.cutoff = found.base.cutoff;
  found.base_is_orbit = true;
  found.one_direction = false;
  found.direction = along_scalar(found.base, 1.0);
  outcome.modes.push_back(std::move(found));
  outcome.families = 1;
  return outcome;
}

}  // namespace orbweaver::survey
