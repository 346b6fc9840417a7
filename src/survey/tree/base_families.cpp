#include "base_families.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "end_text.hpp"
#include "given_starts.hpp"
#include "numbered_starts.hpp"
#include "orbweaver/bifurcation/small_oscillations.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/core/log/log.hpp"
#include "orbweaver/loop/curve/measures.hpp"
#include "orbweaver/starts/fixed_points.hpp"
#include "orbweaver/starts/linear_modes.hpp"
#include "orbweaver/survey/tree/expected_starts.hpp"
#include "orbweaver/survey/tree/naming.hpp"
#include "orbweaver/survey/tree/undeclared.hpp"
#include "orbweaver/systems/identities.hpp"
#include "tasks/equilibrium_places.hpp"
#include "tasks/payload/keys.hpp"
#include "tasks/payload/work.hpp"

namespace orbweaver::survey {

namespace {

/// Dips of the Hessian's smallest eigenvalue that a note tells: `orbweaver sweep` lists all.
constexpr std::size_t most_dips = 3;

void check_names(const scene::Scene& scene, const systems::System& system, const SweepOutcome& found) {
  const std::size_t given = names_given(scene, system, found.point);
  if (found.families == bifurcation::not_counted) return;  // names of families that are left out may be any
  if (given > static_cast<std::size_t>(found.families))
    throw core::InputError(fmt::format(
        "starts.fixed_points.names: expected at most {} for the equilibrium at {}, a name for each family of small "
        "oscillations, got {}; remove those that name none",
        found.families, point_text(system, found.point), given));
}

/// Small oscillations about one equilibrium of which no family was begun, in one note.
std::string left_out_text(const scene::Scene& scene, const systems::System& system, const SweepOutcome& found) {
  const double unit = system.scales().time;
  std::vector<std::string> modes;
  for (const LeftOutMode& mode : found.left_out) {
    std::vector<std::string> names;
    for (int n = 0; n < mode.families; ++n)
      names.push_back(base_family_name(scene, system, found.point, found.index, mode.place + n));
    const std::string who =
        mode.families == bifurcation::not_counted ? "oscillations" : fmt::to_string(fmt::join(names, ", "));
    modes.push_back(fmt::format("{} with T = {:.9g}", who, mode.period * unit));
  }
  return fmt::format("left out at {}: {}, outside starts.sweep.period [{:g}, {:g}]", point_text(system, found.point),
                     fmt::join(modes, "; "), found.period_from * unit, found.period_to * unit);
}

/// Oscillations that are taken together although their periods are not quite in ratio: what they do nearer to the
/// equilibrium depends on where their families start.
void remark_resonances(const systems::System& system, const SweepOutcome& found, Summary& summary) {
  for (const KernelRecord& kernel : found.kernels)
    if (kernel.detuning > 0.0)
      summary.remarks.push_back(fmt::format(
          "a resonance at {}: {} oscillations share T = {:.9g} but for {:.2g} of it, which counts as none at the first "
          "orbits; a smaller continuation.start may tell them apart, with what is born nearer to the equilibrium",
          point_text(system, found.point), kernel.dimension, kernel.period * system.scales().time, kernel.detuning));
}

/// The equilibria that the grid leads to.
std::vector<std::vector<double>> remark_grid(const scene::Scene& scene, const systems::System& system,
                                             Summary& summary) {
  if (scene.fixed_points.grid.empty()) return {};
  std::vector<std::vector<double>> passed_over;
  std::vector<std::vector<double>> found = starts::find_fixed_points(system, scene.fixed_points.grid, &passed_over);
  if (!passed_over.empty())
    summary.remarks.push_back(
        fmt::format("points of starts.fixed_points.grid passed over, where the field or a derivative of it is not "
                    "finite: {}, the first {}",
                    passed_over.size(), point_text(system, passed_over.front())));
  return found;
}

/// Crossings that an undeclared symmetry forces look like accidents, and its circles are traced twice; without a
/// symplectic form whole kinds of crossings are not looked for.
void remark_undeclared(const systems::System& system, const Undeclared& undeclared, Summary& summary) {
  for (const std::string& symmetry : undeclared.symmetries)
    summary.remarks.push_back(
        fmt::format("the field has {}, which the system does not declare: with it the survey is faster, and says which "
                    "crossings it forces",
                    symmetry));
  if (!undeclared.translated.empty())
    summary.remarks.push_back(
        fmt::format("the field stays the same along translations of {}: declare the momentum that is conserved with "
                    "them, without which orbits and crossings are not isolated (docs/your_own_system.md, \"More "
                    "conserved quantities\")",
                    fmt::join(undeclared.translated, ", ")));
  if (!undeclared.turned.empty())
    summary.remarks.push_back(fmt::format(
        "the field stays the same under turns of {}: with them an angular momentum is conserved, and "
        "orbits and crossings are not isolated: take coordinates in which it is one (docs/your_own_system.md, "
        "\"More conserved quantities\")",
        fmt::join(undeclared.turned, ", ")));
  if (undeclared.may_be_symplectic)
    summary.remarks.push_back(fmt::format(
        "the eigenvalues at every equilibrium come in pairs +-lambda, as those of Hamiltonian systems do: if this is "
        "one, declare {}, without which its period doublings and subharmonics are not found",
        system.structure().conservative() ? "`symplectic`" : "its energy (`conserved`) and `symplectic`"));
}

/// Of an equilibrium without small oscillations: whether something may oscillate there that the linear field does not
/// show, and what to do then. Empty where it shows all.
std::string leaves_open(const systems::System& system, const std::vector<double>& point) {
  starts::LinearStability stability = starts::LinearStability::undecided;
  try {
    stability = starts::linear_modes(system, point).stability;
  } catch (const core::NumericalError&) {  // undecided
  }
  if (stability != starts::LinearStability::neutral && stability != starts::LinearStability::undecided) return "";
  return ": eigenvalues are 0 there, or not told from 0, so that what oscillates (as x'' = -x^3 does) has no period at "
         "rest; give an orbit of it with starts.states";
}

/// The first coordinate that changes at one rate wherever it is: none rests. -1: there is none.
int steady_coordinate(const systems::System& system, const std::vector<std::vector<double>>& grid) {
  const auto d = static_cast<std::size_t>(system.dimension());
  std::vector<double> state(d, 0.0);
  for (std::size_t i = 0; i < grid.size(); ++i) state[i] = grid[i].empty() ? 0.0 : grid[i].front();
  std::vector<double> field(d);
  std::vector<double> jacobian(d * d);
  std::vector<double> before;
  std::vector<bool> steady(d, true);
  for (int probe = 0; probe < 3; ++probe) {  // anywhere, each coordinate by another way
    for (std::size_t i = 0; i < d; ++i) state[i] += probe * std::sin(static_cast<double>(i) + probe);
    system.field_jacobian(1, state.data(), field.data(), jacobian.data());
    for (std::size_t i = 0; i < d; ++i)
      steady[i] = steady[i] && field[i] != 0.0 && (before.empty() || field[i] == before[i]) &&
                  std::all_of(jacobian.begin() + static_cast<std::ptrdiff_t>(i * d),
                              jacobian.begin() + static_cast<std::ptrdiff_t>((i + 1) * d),
                              [](double slope) { return slope == 0.0; });
    before = field;
  }
  const auto found = std::find(steady.begin(), steady.end(), true);
  return found == steady.end() ? -1 : static_cast<int>(found - steady.begin());
}

/// What to do where the grid leads to no equilibrium.
std::string no_equilibrium_advice(const systems::System& system, const std::vector<std::vector<double>>& grid) {
  if (system.structure().driven)
    return "nothing rests at every phase of the drive near starts.fixed_points.grid: give the drive the amplitude 0 "
           "and "
           "let it move (continuation.free), or an orbit with starts.states";
  if (const int steady = steady_coordinate(system, grid); steady >= 0)
    return fmt::format(
        "starts.fixed_points.grid leads to no equilibrium, and there is none: {} changes at the same rate everywhere. "
        "If "
        "it is the phase of a drive, let it be the last coordinate, an angle, and declare `structure.driven = true` "
        "(docs/your_own_system.md); else give an orbit with starts.states",
        system.info().state_names[static_cast<std::size_t>(steady)]);
  return "Newton's method finds no equilibrium from starts.fixed_points.grid: give start values nearer to one";
}

/// What to do where a survey has found no family at all.
std::string nothing_found_advice(const systems::System& system, const std::vector<SweepOutcome>& sweeps) {
  const auto any = [&](const auto& has) { return std::any_of(sweeps.begin(), sweeps.end(), has); };
  if (any([](const SweepOutcome& found) { return !found.left_out.empty(); }))
    return "all their periods lie outside starts.sweep.period: make it wider, or `auto`";
  if (!system.family_scalars().free.empty() &&
      any([](const SweepOutcome& found) { return !found.without_family.empty(); }))
    return "equilibria on the curves are centres, and no Hopf points: the notes say what to do";
  if (any([](const SweepOutcome& found) { return is_undecided(found.equilibria); }))
    return "whether the curves of equilibria have a Hopf point is not told everywhere: the findings say where and why";
  if (!system.family_scalars().free.empty())
    return "no curve of equilibria has a Hopf point within limits.parameter: widen it, or give an orbit with "
           "starts.states";
  if (any([](const SweepOutcome& found) { return !found.without_family.empty(); }))
    return "which families leave the equilibria is not known: the notes and findings say why";
  if (!system.structure().conservative())
    return "the system conserves nothing: its families are curves in a parameter, with `continuation: {free: ...}`";
  return "none of the equilibria has small oscillations: let starts.fixed_points.grid lead to others, or give an orbit "
         "with starts.states";
}

}  // namespace

namespace {

/// Families in T begin at equilibria; those of a system that conserves nothing at Hopf points, or where it rests until
/// the drive is raised. A conservative family in a parameter has no small orbits.
bool has_equilibrium_families(const systems::System& system) {
  return system.family_scalars().free.empty() || !system.structure().conservative();
}

std::string name_of_start(const scene::Scene& scene, const systems::System& system, const SweepOutcome& found,
                          const FoundMode& mode) {
  if (mode.base.modes.empty()) return base_family_name(scene, system, found.point, found.index, mode.place);
  const std::size_t given = names_given(scene, system, found.point);
  return static_cast<std::size_t>(mode.place) < given
             ? base_family_name(scene, system, found.point, found.index, mode.place)
         : mode.base_is_orbit ? equilibrium_name(found.index)
                              : fmt::format("{}, Hopf point {}", equilibrium_name(found.index), mode.place + 1);
}

/// Several equilibria may lie on one curve, and its Hopf points are found from each. They count as those of the nearest
/// along the curve.
bool is_same_start(const FoundMode& a, const FoundMode& b) {
  constexpr double same = 1e-8;  // Hopf points are located to 1e-12 in parts of a step
  if (a.base.modes.empty() || b.base.modes.empty() || a.base_is_orbit || b.base_is_orbit) return false;
  return std::abs(a.period - b.period) < same * a.period && loop::mean_distance(a.base, b.base) < same &&
         std::abs(a.base.parameters.front() - b.base.parameters.front()) < same;
}

bool is_of_another(const FoundMode& mode, const SweepOutcome& of, const std::vector<SweepOutcome>& sweeps) {
  return std::any_of(sweeps.begin(), sweeps.end(), [&](const SweepOutcome& other) {
    return other.index != of.index && std::any_of(other.modes.begin(), other.modes.end(), [&](const FoundMode& same) {
             return is_same_start(mode, same) &&
                    std::pair(same.distance, other.index) < std::pair(mode.distance, of.index);
           });
  });
}

/// A family is followed to one side or, as one family or as two, to both.
void add_tasks(const std::string& name, const std::string& branch_key, const std::vector<double>& point,
               const FoundMode& mode, BaseFamilies& families) {
  std::vector<queue::Task>& tasks = families.tasks;
  BranchWork work;
  work.key = work.lineage.family = branch_key;
  work.name = name;
  work.direction = mode.direction;
  work.isotropy = mode.isotropy;
  work.amplitude = mode.amplitude;
  work.base = mode.base.modes.empty() ? loop::constant_loop(point, mode.period, mode.cutoff) : mode.base;
  work.base_is_orbit = mode.base_is_orbit;
  const auto add = [&] {
    tasks.push_back(task_of(work));
    if (!mode.base_is_orbit)
      families.given.small.push_back({work.lineage.family, work.name, work.base, work.direction});
  };
  if (mode.one_direction) return add();
  if (mode.base_is_orbit) {  // two sides of one family
    work.key = branch_key + "+";
    add();
    work.key = branch_key + "-";
    work.lineage.side = -1;
    work.direction *= -1.0;
    return add();
  }
  work.key = work.lineage.family = branch_key + "+";
  add();
  work.key = work.lineage.family = branch_key + "-";
  work.name += " (other side)";
  work.direction *= -1.0;
  add();
}

}  // namespace

namespace {

/// Where a survey would begin.
struct Starts {
  std::vector<std::vector<double>> equilibria;  ///< also those that no family of the system begins at
  std::vector<SweepWork> given;
  std::vector<std::vector<double>> states;  ///< that the scene gives
};

/// Throws InputError for whatever a survey is refused for before its first task.
Starts starts_of(const scene::Scene& scene, const systems::System& system) {
  Starts starts;
  if (!scene.fixed_points.grid.empty()) starts.equilibria = starts::find_fixed_points(system, scene.fixed_points.grid);
  starts.given = given_starts(scene, system);
  for (const SweepWork& work : starts.given)
    if (!work.given.front().is_return()) starts.states.push_back(work.point);
  if (scene.recurrences) starts.states.push_back(scene.recurrences->state);
  systems::require_identities(system, starts.equilibria, starts.states);
  const bool begins_at_equilibria = has_equilibrium_families(system);
  if (!starts.given.empty() || (begins_at_equilibria && !starts.equilibria.empty())) {
    require_named(scene, system, starts.equilibria);
    return starts;
  }
  if (scene.recurrences)
    throw core::InputError(
        "starts.recurrences: the trajectory has no return: give it more time, longer periods or a "
        "larger tolerance");
  if (!begins_at_equilibria)
    throw core::InputError("a conservative family in a parameter starts at an orbit: give one with starts.states");
  if (scene.fixed_points.grid.empty())
    throw core::InputError(
        "starts: no start is given: give starts.fixed_points.grid, values of each coordinate near an equilibrium, or "
        "an orbit with starts.states");
  throw core::InputError(no_equilibrium_advice(system, scene.fixed_points.grid));
}

ExpectedEquilibrium expected_equilibrium(const systems::System& system, const std::vector<double>& point) {
  ExpectedEquilibrium found;
  found.text = point_text(system, point);
  found.energy = system.structure().conservative() ? system.conserved(0, point) * system.scales().energy()
                                                   : std::numeric_limits<double>::quiet_NaN();
  try {
    const starts::LinearModes modes = starts::linear_modes(system, point);
    for (const starts::Oscillation& oscillation : modes.oscillations)
      found.periods.insert(found.periods.end(), static_cast<std::size_t>(oscillation.multiplicity()),
                           oscillation.period * system.scales().time);
    found.stability = starts::to_text(modes.stability);
  } catch (const core::NumericalError&) {  // the survey's sweep says more
    found.stability = starts::to_text(starts::LinearStability::undecided);
  }
  return found;
}

}  // namespace

ExpectedStarts expected_starts(const scene::Scene& scene, const systems::System& system) {
  ExpectedStarts expected;
  const Starts starts = starts_of(scene, system);
  if (has_equilibrium_families(system)) expected.equilibria = starts.equilibria.size();
  if (!system.structure().driven)
    for (const std::vector<double>& point : starts.equilibria)
      expected.resting.push_back(expected_equilibrium(system, point));
  expected.undeclared = undeclared(system, starts.equilibria, starts.states);
  for (const SweepWork& work : starts.given) {
    const GivenStart& given = work.given.front();
    if (given.is_return()) ++expected.near_returns;
    if (given.from == GivenStart::From::archive) expected.orbits.push_back(given.told);
  }
  return expected;
}

std::vector<queue::Task> sweep_tasks(const scene::Scene& scene, const systems::System& system) {
  Starts starts = starts_of(scene, system);
  std::vector<queue::Task> tasks;
  if (has_equilibrium_families(system))
    for (const std::vector<double>& point : starts.equilibria)
      tasks.push_back(task_of(SweepWork{static_cast<int>(tasks.size()), point}));
  const std::size_t equilibria = tasks.size();
  std::size_t returns = 0;
  for (SweepWork& work : starts.given) {
    work.index = static_cast<int>(tasks.size());
    returns += work.given.front().is_return() ? 1 : 0;
    tasks.push_back(task_of(work));
  }
  const std::string range = scene.sweep.period
                                ? fmt::format("from {:g} to {:g}", scene.sweep.period->from * system.scales().time,
                                              scene.sweep.period->to * system.scales().time)
                                : "over all oscillations";
  const std::string look = system.family_scalars().free.empty()
                               ? fmt::format("sweeping the period {} at each", range)
                               : fmt::format("{} each in {}", system.structure().driven ? "driving" : "following",
                                             system.family_scalars().free.front());
  if (equilibria > 0) core::log_info(fmt::format("{} equilibria; {}", equilibria, look));
  if (starts.given.size() > returns) core::log_info(fmt::format("{} given orbits", starts.given.size() - returns));
  if (scene.recurrences) core::log_info(fmt::format("{} returns of the trajectory", returns));
  return tasks;
}

BaseFamilies base_families(const scene::Scene& scene, const systems::System& system, const SweepsEnded& sweeps,
                           Summary& summary) {
  BaseFamilies families;
  std::vector<queue::Task>& tasks = families.tasks;
  const std::vector<std::vector<double>> equilibria_of_grid = remark_grid(scene, system, summary);
  std::vector<std::vector<double>> states;
  std::vector<SweepOutcome> all;
  std::vector<FoundStart> given;
  int equilibria = 0;
  for (const auto& [key, ended] : sweeps) {
    SweepWork work = unpack_sweep_work(ended.first.payload);
    equilibria += work.given.empty() ? 1 : 0;
    if (!work.given.empty() && !work.given.front().is_return()) states.push_back(work.point);
    if (ended.second.failed) continue;  // gather_failed_sweeps
    SweepOutcome outcome = unpack_sweep_outcome(ended.second.payload);
    if (work.given.empty())
      all.push_back(std::move(outcome));
    else
      given.push_back({std::move(work.given.front()), std::move(outcome)});
  }
  if (scene.recurrences) states.push_back(scene.recurrences->state);
  remark_undeclared(system, undeclared(system, equilibria_of_grid, states), summary);
  for (const SweepOutcome& found : all) {
    check_names(scene, system, found);
    const bool found_nothing = found.modes.empty() && found.rejected.empty() && found.without_family.empty() &&
                               !is_undecided(found.equilibria);
    if (found_nothing && !system.family_scalars().free.empty()) {
      summary.remarks.push_back(
          fmt::format("no Hopf point on the curve of equilibria through {}", point_text(system, found.point)));
    } else if (found_nothing) {
      const std::string range = scene.sweep.period
                                    ? fmt::format(" for T in [{:g}, {:g}]", found.period_from * system.scales().time,
                                                  found.period_to * system.scales().time)
                                    : "";
      summary.remarks.push_back(fmt::format("no small oscillations around {}{}{}", point_text(system, found.point),
                                            range, leaves_open(system, found.point)));
    }
    if (!found.left_out.empty()) summary.remarks.push_back(left_out_text(scene, system, found));
    remark_resonances(system, found, summary);
    if (!found.without_family.empty())
      summary.remarks.push_back(
          fmt::format("at {}: {}", point_text(system, found.point), fmt::join(found.without_family, "; ")));
    if (!found.rejected.empty()) {
      const auto end = found.rejected.begin() + static_cast<std::ptrdiff_t>(std::min(found.rejected.size(), most_dips));
      const auto untold = found.rejected.end() - end;
      summary.passed_over.push_back(fmt::format("dips passed over at {}: {}{}", point_text(system, found.point),
                                                fmt::join(found.rejected.begin(), end, "; "),
                                                untold > 0 ? fmt::format("; and {} more", untold) : ""));
    }
    for (const FoundMode& mode : found.modes) {
      if (is_of_another(mode, found, all)) continue;
      const std::string name = name_of_start(scene, system, found, mode);
      add_tasks(name, base_key(found.index, mode.place), found.point, mode, families);
    }
  }
  for (const NumberedStart& start : numbered_starts(scene, system, std::move(given), summary.remarks)) {
    const std::string key = base_key(equilibria + start.number, 0);
    add_tasks(start.name, key, {}, start.mode, families);
    families.given.all.push_back({key, start.name, start.told, start.mode.base});
  }
  const auto allowed = static_cast<std::size_t>(scene.limits.families);
  if (tasks.size() > allowed) {
    summary.remarks.push_back(fmt::format("{} families found, {} followed (limits.families)", tasks.size(), allowed));
    tasks.resize(allowed);
  }
  return families;
}

void require_families(const systems::System& system, const SweepsEnded& sweeps, Summary& summary) {
  if (summary.stopped_early) return;
  const bool followed_none =
      std::all_of(summary.families.begin(), summary.families.end(),
                  [](const FamilySummary& family) { return family.orbits == 0 && !family.failed; });
  if (!summary.families.empty() && followed_none)
    summary.remarks.push_back(
        "no orbit was stored: every family begins beyond the scene's limits (\"ended by\" says which); give wider "
        "ones, "
        "and go on with --resume");
  if (!summary.families.empty()) return;
  std::vector<SweepOutcome> ended_well;
  for (const auto& [key, ended] : sweeps)
    if (!ended.second.failed) ended_well.push_back(unpack_sweep_outcome(ended.second.payload));
  summary.failed_tasks.push_back(
      fmt::format("no family found, and the archive is empty: {}", nothing_found_advice(system, ended_well)));
}

void gather_failed_sweeps(const systems::System& system, const SweepsEnded& sweeps, Summary& summary,
                          archive::Records& tables) {
  for (const auto& [key, ended] : sweeps) {
    const auto& [task, outcome] = ended;
    if (!outcome.failed) continue;
    const SweepWork work = unpack_sweep_work(task.payload);
    archive::FamilyRecord record;
    record.key = equilibrium_key(work.index);
    if (work.given.empty()) {
      record.name = equilibrium_name(work.index);
      record.end_reason =
          limited(failure_text(fmt::format("the sweep at {}: {}", point_text(system, work.point), outcome.reason)));
    } else {
      const GivenStart& given = work.given.front();
      record.name = given.name.empty() ? given.told : given.name;
      record.end_reason = limited(failure_text(fmt::format("{}: {}", given.told, outcome.reason)));
    }
    summary.families.push_back({record.key, record.name, "", 0, 0.0, 0.0, 0.0, 0.0, record.end_reason, true});
    summary.failed_tasks.push_back(fmt::format("{}: {}", record.name, outcome.reason));
    tables.families.push_back(std::move(record));
  }
}

}  // namespace orbweaver::survey
