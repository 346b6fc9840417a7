#include "given_start.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "orbweaver/certificate/integrate.hpp"
#include "orbweaver/continuation/branch.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/loop/curve/measures.hpp"
#include "orbweaver/loop/curve/time_samples.hpp"
#include "orbweaver/loop/grid/time_map_fit.hpp"
#include "orbweaver/loop/symmetry/alignment.hpp"
#include "orbweaver/loop/symmetry/isotropy.hpp"
#include "orbweaver/loop/symmetry/shift_search.hpp"
#include "orbweaver/loop/symmetry/symmetry_group.hpp"
#include "orbweaver/starts/loop_guess.hpp"
#include "orbweaver/starts/multiple_shooting.hpp"
#include "orbweaver/survey/tasks/branch_options.hpp"
#include "orbweaver/survey/tree/undeclared.hpp"

namespace orbweaver::survey {

namespace {

/// Of a trajectory's integrator: the orbit is corrected from it.
constexpr double guess_tolerance = 1e-10;
/// And of the one by which multiple shooting finds an orbit.
constexpr double shooting_tolerance = 1e-12;
/// Of an energy, in its scale: branches end on limits to rounding.
constexpr double same_energy = 1e-9;
/// Orbits on the way to the energy of a return: one that is further away along its family is another orbit. Not
/// measured; most take one or two.
constexpr int most_steps_to_energy = 30;
/// How far from the guess a correction begins along the energy's gradient, in |dz(0)|: a branch's first
/// orbit needs a way from its base. Far less than a guess misses.
constexpr double beside_guess = 1e-7;
/// A repetition must be exact to this share of the amplitude (bifurcation::same_family has the same).
constexpr double repeated = 1e-6;
/// An orbit whose amplitude is less, relative to the size of its states, rests.
constexpr double at_rest = 1e-6;

/// Nodes of a trajectory that comes near its image after them, moved by what it misses, spread evenly over their time,
/// and continued by their images until they close.
void close_by_symmetry(const systems::Structure& structure, const GivenStart& given,
                       std::vector<starts::TrajectoryNode>& nodes) {
  const auto vector_of = [](const std::vector<double>& z) {
    return Eigen::Map<const Eigen::VectorXd>(z.data(), static_cast<Eigen::Index>(z.size()));
  };
  systems::AffineMap map =
      loop::SymmetryGroup::of_space(structure).elements().at(static_cast<std::size_t>(given.symmetry)).map;
  Eigen::VectorXd missed = vector_of(nodes.back().state) - map(vector_of(nodes.front().state));
  for (const int angle : structure.angles) {
    const double turns = 2.0 * std::numbers::pi * std::round(missed(angle) / (2.0 * std::numbers::pi));
    map.offset(angle) += turns;
    missed(angle) -= turns;
  }
  const std::size_t piece = nodes.size() - 1;
  for (starts::TrajectoryNode& node : nodes)
    for (std::size_t i = 0; i < node.state.size(); ++i) {
      const double rate = missed(static_cast<Eigen::Index>(i)) / given.period;
      node.state[i] -= node.time * rate;
      node.slope[i] -= rate;
    }
  const auto list = [](const Eigen::VectorXd& z) { return std::vector<double>(z.begin(), z.end()); };
  for (std::size_t j = 1; j <= piece * static_cast<std::size_t>(given.order - 1); ++j) {
    const starts::TrajectoryNode& of = nodes[j];
    nodes.push_back({of.time + given.period, list(map(vector_of(of.state))), list(map.matrix * vector_of(of.slope)),
                     list(map.matrix * vector_of(of.bend))});
  }
}

starts::Integrator integrator_of(const systems::System& system, double tolerance) {
  return {[&system, tolerance](const std::vector<double>& state, double time) {
            return certificate::integrate(system, state, time, tolerance);
          },
          [&system, tolerance](const std::vector<double>& state, double time) {
            return certificate::transitions(system, {state}, time, tolerance).front();
          },
          tolerance};
}

/// The part of a given start's trajectory that lies before its state.
double time_before(const systems::System& system, const GivenStart& given) {
  return given.is_return() || system.structure().dissipative ? 0.0 : 0.5 * given.period;
}

/// The trajectory of a given start. That of a return runs from its state over a period, and over one more for each time
/// that it goes on as its image. That through a state runs half a period to either side: where an orbit is unstable
/// errors grow over half the time only. Backwards from what damps they would grow more.
starts::GuessCurve trajectory_of(const systems::System& system, const std::vector<double>& point,
                                 const GivenStart& given) {
  const double before = time_before(system, given);
  const starts::Advance advance = integrator_of(system, guess_tolerance).advance;
  const auto nodes_over = [&](double time) {
    return starts::trajectory_nodes(system, advance, point, time, given.period * given.order / loop::time_sample_count);
  };
  std::vector<starts::TrajectoryNode> nodes = nodes_over(given.period - before);
  if (before > 0.0) {
    std::vector<starts::TrajectoryNode> earlier = nodes_over(-before);
    earlier.erase(earlier.begin());
    nodes.insert(nodes.begin(), std::make_move_iterator(earlier.rbegin()), std::make_move_iterator(earlier.rend()));
  }
  if (given.is_return()) close_by_symmetry(system.structure(), given, nodes);
  return starts::curve_through(std::move(nodes));
}

/// The curve of a given start, and the longest step of its mesh.
struct Given {
  starts::GuessCurve curve;
  double longest = 0.0;
};
Given curve_of(const systems::System& system, const SweepWork& work) {
  const GivenStart& given = work.given.front();
  const double longest = given.period * given.order / loop::time_sample_count;
  if (given.guess.modes.empty()) return {trajectory_of(system, work.point, given), longest};
  const auto state = [guess = given.guess](double time) { return loop::state_at(guess, time); };
  return {starts::curve_of(system, state, given.period, longest), longest};
}

/// The guess as a loop. Where times that are spaced evenly do not resolve a state's trajectory or a table, it is the
/// orbit that multiple shooting finds near it: an error of the size of a close passage's own small time leads harmonics
/// nowhere. Of returns there are many, most near no orbit; orbits of archives are corrected already.
struct Guess {
  loop::Loop loop;
  std::optional<starts::ShotCurve> shot;
};
Guess guess_of(const systems::System& system, const SweepWork& work) {
  const GivenStart& given = work.given.front();
  Guess out;
  loop::Loop& guess = out.loop;
  guess = given.guess.modes.empty() ? starts::loop_through(system.structure(), trajectory_of(system, work.point, given))
                                    : given.guess;
  const bool is_loose = given.from == GivenStart::From::state || given.from == GivenStart::From::loop;
  if (is_loose && !guess.time_map.is_identity()) {
    const Given from = curve_of(system, work);
    out.shot = starts::shot_through(system, integrator_of(system, shooting_tolerance), from.curve, from.longest);
    if (out.shot->curve) guess = starts::loop_through(system.structure(), *out.shot->curve);
  }
  guess.parameters.clear();
  for (const std::string& name : system.family_scalars().free)
    guess.parameters.push_back(system.parameters().at(name) / system.parameter_scale(name));
  return out;
}

/// The orbit started where the first reversor that it has maps it to itself; as it is where it has none.
loop::Loop at_reversor(const systems::Structure& structure, const loop::Loop& orbit) {
  const loop::Loop even = loop::resolved_in_time(orbit);
  const loop::Loop own = loop::with_cutoff(orbit, loop::allowed_cutoff_at_least(orbit.cutoff));
  for (const systems::Symmetry& reversor : structure.reversors) {
    // R z(-t), which is z(t - sigma) for some sigma where the orbit has the symmetry.
    const loop::Loop image = loop::transformed(even, reversor.map, true, 0.0);
    const std::vector<loop::ShiftMinimum> shifts = loop::shift_minima(image, even, structure.angles);
    if (shifts.empty() || !(shifts.front().square < std::pow(loop::symmetry_tolerance, 2))) continue;
    for (const double start : {-0.5 * shifts.front().shift, 0.5 * shifts.front().shift}) {
      loop::Loop moved = loop::time_shifted(own, start - std::floor(start));
      for (const loop::SymmetryElement& element : loop::find_isotropy(structure, moved, loop::symmetry_tolerance))
        if (element.reversing && element.shift_numerator == 0) return moved;
    }
  }
  return orbit;
}

continuation::Start start_at(const loop::Loop& base, double sign) {
  continuation::Start start;
  start.base = base;
  start.direction = along_last_scalar(base);
  start.direction *= sign;
  start.base_is_orbit = true;
  return start;
}

/// The orbit of the family through `orbit` that has this energy, if it is near.
std::optional<continuation::Orbit> at_energy(const std::shared_ptr<const systems::System>& system,
                                             const continuation::Orbit& orbit, double energy,
                                             continuation::Options options) {
  const double unit = std::max(1.0, std::abs(energy));
  if (std::abs(orbit.energy - energy) <= same_energy * unit) return orbit;
  const bool is_below = orbit.energy < energy;
  constexpr double unlimited = std::numeric_limits<double>::infinity();
  options.energy_from = is_below ? -unlimited : energy;
  options.energy_to = is_below ? energy : unlimited;
  options.period_limit = unlimited;
  options.fixed_step.reset();
  options.off_branch_spectrum = false;
  for (const double sign : {1.0, -1.0}) {
    continuation::Branch branch(system, start_at(orbit.loop, sign), options);
    std::optional<continuation::Orbit> next = branch.advance();
    double away = std::abs(orbit.energy - energy);
    for (int n = 0; next && n < most_steps_to_energy; ++n) {
      if (std::abs(next->energy - energy) <= same_energy * unit) return next;
      next = branch.advance();
      if (!next || !(std::abs(next->energy - energy) < away)) break;
      away = std::abs(next->energy - energy);
      if (away <= same_energy * unit) return next;
    }
  }
  return std::nullopt;
}

/// The branch from the guess with its energy held to first order (the change is orthogonal to the energy's gradient),
/// for where its period has no orbit near.
continuation::Branch beside_energy(const std::shared_ptr<const systems::System>& system, const loop::Loop& guess,
                                   continuation::Options options) {
  const int nodes = 2 * guess.cutoff + 2;  // equidistant in s, whatever the time map
  const loop::Samples states = loop::samples_of(guess, nodes);
  const auto count = static_cast<std::size_t>(nodes);
  const auto d = static_cast<std::size_t>(guess.dimension);
  loop::TimeSamples gradients{guess.dimension, nodes, guess.period, std::vector<double>(d, 0.0),
                              std::vector<double>(d * count)};
  std::vector<double> state(d);
  std::vector<double> gradient(d);
  for (std::size_t j = 0; j < count; ++j) {
    for (std::size_t i = 0; i < d; ++i) state[i] = states.states[i * count + j];
    system->conserved_gradient(0, state, gradient);
    for (std::size_t i = 0; i < d; ++i) gradients.states[i * count + j] = gradient[i];
  }
  continuation::Start start;
  start.base = guess;
  start.direction = {loop::with_cutoff(loop::interpolant(gradients), guess.cutoff).modes, {0.0}};
  options.start_amplitude = beside_guess;
  return {system, start, std::move(options)};
}

/// The orbit once around.
loop::Loop once_around(const loop::Loop& orbit) {
  const int times = loop::repetitions(orbit, repeated * loop::rms_amplitude(orbit));
  return times > 1 ? loop::without_repetition(orbit, times) : orbit;
}

/// What a correction came to: an orbit, or why there is none.
struct Correction {
  std::optional<continuation::Orbit> orbit;
  std::string why;
};

/// The first orbit of a branch; an equilibrium, which is an orbit of every period, is none.
Correction first_of(continuation::Branch branch) {
  Correction found{branch.advance(), {}};
  if (!found.orbit) {
    found.why = branch.ending().value().text();
    return found;
  }
  const loop::Loop& orbit = found.orbit->loop;
  const bool winds = std::any_of(orbit.winding.begin(), orbit.winding.end(), [](double n) { return n != 0.0; });
  if (winds || loop::rms_amplitude(orbit) >= at_rest * (1.0 + loop::rms_size(orbit))) return found;
  found.orbit.reset();
  found.why = "the orbit found rests: an equilibrium";
  return found;
}

/// The orbit with the energy at which the trajectory of a return runs, from the guess with its period or its energy.
Correction return_at_energy(const std::shared_ptr<const systems::System>& system, const loop::Loop& guess,
                            double energy, Correction found, const continuation::Options& options) {
  for (const bool by_energy : {false, true}) {
    if (by_energy) found = first_of(beside_energy(system, guess, options));
    if (!found.orbit) continue;
    if (std::optional<continuation::Orbit> there = at_energy(system, *found.orbit, energy, options))
      return {std::move(there), {}};
    found.why =
        fmt::format("the orbit with T = {:.9g} has another energy, {:.9g}, and none with the trajectory's lies near",
                    found.orbit->loop.period * system->scales().time, found.orbit->energy * system->scales().energy());
  }
  found.orbit.reset();
  return found;
}

/// The orbit that Newton's method finds near the guess with its period; where it finds none, as beside an equilibrium,
/// where all orbits of a family have nearly one period, with its energy.
Correction corrected(const scene::Scene& scene, const std::shared_ptr<const systems::System>& system,
                     const SweepWork& work, const loop::Loop& guess, core::Team* team) {
  continuation::Options options = branch_options(scene, team);
  const bool is_return = work.given.front().is_return();
  // A return's orbit is within the limits when it has the energy; a family that begins beyond them is left out.
  constexpr double unlimited = std::numeric_limits<double>::infinity();
  options.energy_from = -unlimited;
  options.energy_to = unlimited;
  if (!is_return) {
    options.period_limit = unlimited;
    options.parameter_from = -unlimited;
    options.parameter_to = unlimited;
    options.guard_limits.clear();
  }
  options.base_is_far = !is_return;  // of returns there are many, most near no orbit
  Correction found = first_of(continuation::Branch(system, start_at(guess, 1.0), options));
  if (!system->structure().conservative() || !system->family_scalars().free.empty()) return found;
  if (is_return) return return_at_energy(system, guess, system->conserved(0, work.point), std::move(found), options);
  if (found.orbit) return found;
  Correction with_energy = first_of(beside_energy(system, guess, options));
  if (!with_energy.orbit)
    with_energy.why = fmt::format("{}; with the energy held instead: {}", found.why, with_energy.why);
  return with_energy;
}

/// How far the trajectory is from `state` after `time`, in the survey's scales.
double missed(const systems::System& system, const std::vector<double>& state, double time) {
  const std::vector<double> end = certificate::integrate(system, state, time, guess_tolerance);
  double square = 0.0;
  for (std::size_t i = 0; i < end.size(); ++i) {
    const double away = end[i] - state[i];
    square += std::pow(system.structure().is_angle(i) ? std::remainder(away, 2.0 * std::numbers::pi) : away, 2);
  }
  return std::sqrt(square);
}

/// What is to be done where a trajectory closes to half of its integrator's digits, which no nearer state mends.
std::string advice_for_closed(const systems::System& system, const std::vector<double>& state, double period) {
  const int directions = undeclared_directions(system, state, period, guess_tolerance);
  if (directions == 0) return "";
  return fmt::format(
      "; its neighbours come back too, in {} direction{} more than the system declares, so that its orbits are not "
      "isolated (as about a centre, or where something is conserved), unless it lies at a fold or a branch point: "
      "declare what is conserved (docs/your_own_system.md), or give an orbit at parameters where it is isolated",
      directions, directions == 1 ? "" : "s");
}

/// Where along its guess the motion is fastest, and what multiple shooting leaves open, as a text: there a correction
/// is decided.
std::string fastest_text(const systems::System& system, const SweepWork& work,
                         const std::optional<starts::ShotCurve>& shot) {
  const double unit = system.scales().time;
  try {
    const starts::GuessCurve curve = curve_of(system, work).curve;
    const starts::GuessCurve::Fastest fastest = curve.fastest();
    const double begin = work.given.front().guess.modes.empty() ? time_before(system, work.given.front()) : 0.0;
    std::string text = fmt::format(
        "; along its guess, of period {:.9g}, the motion is fastest at t = {:.6g}, where it turns in a time of {:.2g}",
        curve.period * unit, (fastest.time - begin) * unit, unit / fastest.rate);
    const std::vector<systems::Guard>& guards = system.structure().guards;
    for (std::size_t k = 0; k < guards.size(); ++k)
      text += fmt::format("{}{} = {:.3g}", k == 0 ? " with " : ", ", guards[k].name,
                          system.guard(static_cast<int>(k), curve.state(fastest.time)));
    if (!shot) return text;
    if (!std::isfinite(shot->missed)) return text + "; multiple shooting cannot follow it";
    return text + fmt::format("; multiple shooting leaves its pieces open by {:.2g}, most at t = {:.6g}", shot->missed,
                              (shot->missed_at - begin) * unit);
  } catch (const core::NumericalError& error) {
    return fmt::format("; its guess: {}", error.what());
  }
}

/// What is to be done where a given state leads to no orbit; empty for other starts.
std::string advice_for(const systems::System& system, const SweepWork& work, bool is_shot) {
  const GivenStart& given = work.given.front();
  if (given.from != GivenStart::From::state) return "";
  const systems::Structure& structure = system.structure();
  std::string text;
  try {
    const double away = missed(system, work.point, given.period);
    text = fmt::format(
        "; after the given period the trajectory is {:.2g} away from the given state (in the survey's "
        "scales)",
        away);
    const std::string closed =
        away <= std::sqrt(guess_tolerance) ? advice_for_closed(system, work.point, given.period) : "";
    if (!closed.empty()) return text + closed;
  } catch (const core::NumericalError&) {  // it does not get there
  }
  if (is_shot)
    return text +
           "; multiple shooting finds an orbit near the state, which the loop's equations do not confirm: begin at "
           "parameters at which its fastest motion is slower (docs/starts.md, \"How good a state must be\")";
  if (structure.driven) {
    std::vector<double> field(work.point.size());
    system.field(1, work.point.data(), field.data());
    text += fmt::format("; the period should be a multiple of the drive's, {:.9g}",
                        2.0 * std::numbers::pi / field.back() * system.scales().time);
  }
  text += structure.dissipative
              ? "; give a state at which a trajectory has settled, or one to which it comes back nearer"
              : "; give a state to which the trajectory comes back nearer, or let starts.recurrences look for some";
  return text + " (docs/starts.md, \"How good a state must be\")";
}

}  // namespace

loop::Tangent along_last_scalar(const loop::Loop& base) {
  loop::Tangent direction{std::vector<double>(base.modes.size(), 0.0),
                          std::vector<double>(1 + base.parameters.size(), 0.0)};
  direction.scalars.back() = 1.0;
  return direction;
}

SweepOutcome given_start(const scene::Scene& scene, const std::shared_ptr<const systems::System>& system,
                         const SweepWork& work, core::Team* team) {
  SweepOutcome outcome;
  outcome.index = work.index;
  outcome.point = work.point;
  const Guess guess = guess_of(*system, work);
  const Correction correction = corrected(scene, system, work, guess.loop, team);
  if (!correction.orbit) {
    if (!work.given.front().is_return())
      throw core::NumericalError(correction.why + fastest_text(*system, work, guess.shot) +
                                 advice_for(*system, work, guess.shot && guess.shot->curve));
    outcome.rejected.push_back(correction.why);
    return outcome;
  }
  FoundMode found;
  found.base = at_reversor(system->structure(), once_around(correction.orbit->loop));
  found.isotropy = loop::find_isotropy(system->structure(), found.base, loop::symmetry_tolerance);
  if (!loop::is_invariant(found.base.time_map, found.isotropy)) {
    const bool has_pulse = found.base.time_map.kappa != 1.0;
    found.base = has_pulse ? loop::evenly_in_time(found.base)
                           : loop::with_time_map(found.base, loop::invariant(found.base.time_map, found.isotropy),
                                                 found.base.cutoff);
  }
  found.period = found.base.period;
  found.cutoff = found.base.cutoff;
  found.base_is_orbit = true;
  found.one_direction = false;
  found.direction = along_last_scalar(found.base);
  outcome.modes.push_back(std::move(found));
  outcome.families = 1;
  return outcome;
}

}  // namespace orbweaver::survey
