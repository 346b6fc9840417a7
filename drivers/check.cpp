#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <memory>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include <unistd.h>

#include <fmt/format.h>

#include "command.hpp"
#include "common_options.hpp"
#include "failure.hpp"
#include "orbweaver/core/address_space.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/core/terminal.hpp"
#include "orbweaver/core/text.hpp"
#include "orbweaver/scene/in_scales.hpp"
#include "orbweaver/starts/fixed_points.hpp"
#include "orbweaver/survey/run/expected_work.hpp"
#include "orbweaver/survey/run/scaled_scene.hpp"
#include "orbweaver/survey/tree/expected_starts.hpp"
#include "orbweaver/systems/field_cost.hpp"
#include "orbweaver/systems/registry.hpp"
#include "orbweaver/systems/system.hpp"
#include "structure_text.hpp"

namespace orbweaver::drivers {

namespace {

using Lines = std::vector<std::pair<std::string, std::string>>;

void print_group(const std::string& title, const Lines& lines) {
  fmt::print("\n{}\n", title);
  for (const auto& [label, text] : lines) fmt::print("  {:<14}{}\n", label, text);
}

std::string in_degrees(double radians) { return fmt::format("{:.6g} deg", radians / std::numbers::pi * 180.0); }

std::string length_text(const systems::System& system, double length) {
  return system.structure().has_angles() ? in_degrees(length) : fmt::format("{:.6g}", length);
}

std::string value_text(const systems::System& system, std::size_t coordinate, double value) {
  return system.structure().is_angle(coordinate) ? in_degrees(value) : fmt::format("{:.6g}", value);
}

std::string value_of_parameter(const systems::System& system, const std::string& name, double value) {
  std::vector<systems::Parameter> known = system.info().parameters;
  for (const systems::Effect& effect : system.info().effects)
    known.insert(known.end(), effect.parameters.begin(), effect.parameters.end());
  const auto found =
      std::find_if(known.begin(), known.end(), [&](const systems::Parameter& p) { return p.name == name; });
  return found == known.end() ? fmt::format("{} = {}", name, value) : parameter_text(*found, value);
}

std::string scales_text(const systems::System& system, const systems::Scales& scales) {
  std::vector<std::string> texts{fmt::format("time {:.6g}", scales.time)};
  for (std::size_t i = 0; i < system.info().state_names.size(); ++i)
    if (!system.structure().is_angle(i))
      texts.push_back(fmt::format("{} {:.6g}", system.info().state_names[i], scales.coordinate(i)));
  for (std::size_t k = 0; k < system.structure().conserved.size(); ++k)
    texts.push_back(fmt::format("{} {:.6g}", system.structure().conserved[k],
                                scales.conserved.empty() ? 1.0 : scales.conserved[k]));
  return fmt::format("{}", fmt::join(texts, ", "));
}

void print_system(const scene::Scene& scene, const systems::System& system, const systems::Scales& scales) {
  std::vector<std::string> coordinates, parameters;
  for (std::size_t i = 0; i < system.info().state_names.size(); ++i)
    coordinates.push_back(system.info().state_names[i] + (system.structure().is_angle(i) ? " (angle)" : ""));
  Lines lines{{"coordinates", fmt::format("{}", fmt::join(coordinates, ", "))}};
  for (const auto& [name, value] : system.parameters())
    lines.emplace_back(lines.size() == 1 ? "parameters" : "", value_of_parameter(system, name, value));
  const auto& effects = scene.system.effects;
  lines.emplace_back("effects", effects.empty() ? "none" : fmt::format("{}", fmt::join(effects, ", ")));
  lines.emplace_back("scales", scales_text(system, scales));
  print_group(fmt::format("System: {} ({})", system.info().title, system.info().name), lines);
}

/// The system without effects, with the values of the parameters that it then has.
std::shared_ptr<const systems::System> ideal_of(const systems::System& system) {
  std::map<std::string, double> parameters;
  for (const systems::Parameter& parameter : system.info().parameters)
    parameters[parameter.name] = system.parameters().at(parameter.name);
  return systems::make_system(system.info().name, parameters);
}

/// Equilibria of the system or, since nothing driven stands still, of the ideal one, with the phase 0.
std::vector<std::vector<double>> resting_points(const scene::Scene& scene, const systems::System& system) {
  if (!system.structure().driven) return starts::find_fixed_points(system, scene.fixed_points.grid);
  const auto ideal = ideal_of(system);
  std::vector<std::vector<double>> grid = scene.fixed_points.grid;
  if (grid.size() > static_cast<std::size_t>(ideal->dimension()))
    grid.resize(static_cast<std::size_t>(ideal->dimension()));
  std::vector<std::vector<double>> points = starts::find_fixed_points(*ideal, grid);
  for (std::vector<double>& point : points) point.resize(static_cast<std::size_t>(system.dimension()), 0.0);
  return points;
}

/// Of the system's field beside the ideal one's.
std::string price_text(const systems::System& system, std::vector<double> point) {
  const systems::FieldCost cost = systems::field_cost(system, point);
  const auto ideal = ideal_of(system);
  point.resize(static_cast<std::size_t>(ideal->dimension()));
  const systems::FieldCost least = systems::field_cost(*ideal, point);
  return fmt::format("field {:.2g} ns a node, with its Jacobian {:.2g}; the ideal system {:.2g} and {:.2g}", cost.field,
                     cost.field_and_jacobian, least.field, least.field_and_jacobian);
}

/// What moves along the scene's families, and what is held.
std::string families_text(const systems::System& system) {
  const systems::FamilyScalars& moving = system.family_scalars();
  const std::string kind = family_kind_text(system.structure());
  if (moving.free.empty()) return kind;
  if (moving.hold == systems::FamilyScalars::Hold::nothing) return fmt::format("{}: {}", kind, moving.free.front());
  const bool holds_energy = moving.hold == systems::FamilyScalars::Hold::energy;
  return fmt::format("conservative, in a parameter: {} and {} move along a family of one {}",
                     holds_energy ? "the period" : "the energy", moving.free.front(),
                     holds_energy ? "energy" : "period");
}

void print_simulated(const scene::Scene& scene, const systems::System& system,
                     const std::vector<std::vector<double>>& points, const survey::Undeclared& undeclared) {
  Lines lines{{"terms", system.info().meaning}};
  for (const systems::Effect& effect : system.info().effects)
    if (std::count(scene.system.effects.begin(), scene.system.effects.end(), effect.name) > 0)
      lines.emplace_back("", fmt::format("{}: {}", effect.name, effect.meaning));
  lines.emplace_back("dimension", fmt::format("{} coordinates", system.dimension()));
  const Lines holds = structure_lines(system.info(), system.structure(), families_text(system));
  lines.insert(lines.end(), holds.begin(), holds.end());
  for (const std::string& symmetry : undeclared.symmetries) lines.emplace_back("not declared", symmetry);
  if (!undeclared.translated.empty())
    lines.emplace_back("not declared",
                       fmt::format("perhaps a momentum: the field stays the same along translations of {}",
                                   fmt::join(undeclared.translated, ", ")));
  if (!undeclared.turned.empty())
    lines.emplace_back("not declared",
                       fmt::format("perhaps an angular momentum: the field stays the same under turns of {}",
                                   fmt::join(undeclared.turned, ", ")));
  if (undeclared.may_be_symplectic)
    lines.emplace_back(
        "not declared",
        fmt::format("perhaps {}: eigenvalues at every equilibrium come in pairs +-lambda",
                    system.structure().conservative() ? "`symplectic`" : "an energy (`conserved`) and `symplectic`"));
  if (!points.empty()) lines.emplace_back("price", price_text(system, points.front()));
  print_group("Simulated", lines);
}

std::string name_list(const scene::FixedPoints& points, const std::vector<std::string>& names) {
  std::vector<std::string> texts;
  for (const std::string& name : names) {
    const auto letters = points.letters.find(name);
    texts.push_back(letters == points.letters.end() ? name : fmt::format("{} (branches: {})", name, letters->second));
  }
  return fmt::format("{}", fmt::join(texts, ", "));
}

std::string sweep_text(const scene::Sweep& sweep) {
  const std::string range = sweep.period
                                ? fmt::format("with periods from {} to {}", sweep.period->from, sweep.period->to)
                                : "of every period";
  const std::string step = sweep.step     ? fmt::format("in steps of {}", *sweep.step)
                           : sweep.period ? fmt::format("in steps of {}", scene::Sweep::standard_step)
                                          : "in a thousand steps";
  return fmt::format("small oscillations {}; smallest eigenvalue {}", range, step);
}

/// Equilibria that are listed.
constexpr std::size_t most_resting = 12;

/// Where an equilibrium is and how it oscillates, which tells what periods the survey begins with.
std::string resting_text(const survey::ExpectedEquilibrium& found, double period_limit) {
  std::vector<std::string> periods;
  for (const double period : found.periods)
    periods.push_back(fmt::format("{:.6g}{}", period, period > period_limit ? " (beyond limits.period)" : ""));
  const std::string oscillations =
      periods.empty() ? "no small oscillations" : fmt::format("small oscillations of T = {}", fmt::join(periods, ", "));
  return fmt::format("at {}: {}; {}", found.text, oscillations, found.stability);
}

std::string named(const std::string& name) { return name.empty() ? "" : ", " + name; }

void print_starts(const scene::Scene& scene, const systems::System& system, const survey::ExpectedStarts& expected) {
  const scene::FixedPoints& points = scene.fixed_points;
  std::size_t count = 1;
  std::vector<std::string> axes;
  for (std::size_t i = 0; i < system.info().state_names.size(); ++i) {
    const std::vector<double> values = i < points.grid.size() ? points.grid[i] : std::vector<double>{0.0};
    std::vector<std::string> texts;
    for (const double value : values) texts.push_back(value_text(system, i, value));
    axes.push_back(fmt::format("{} = {}", system.info().state_names[i], fmt::join(texts, ", ")));
    count *= values.size();
  }
  const std::string grid = fmt::format("Newton's method from {} point{}", count, count == 1 ? "" : "s");
  std::string sought = "not sought: starts.fixed_points.grid is not given";
  if (system.structure().driven)
    sought = expected.equilibria == 0
                 ? "none: the phase of the drive never stands still"
                 : fmt::format("{} that rest at every phase of the drive, by {}", expected.equilibria, grid);
  else if (!points.grid.empty())
    sought = fmt::format("{}: {}", grid, fmt::join(axes, "; "));
  Lines lines{{"equilibria", sought}};
  for (std::size_t n = 0; n < std::min(most_resting, expected.resting.size()); ++n)
    lines.emplace_back(n == 0 ? "found" : "", resting_text(expected.resting[n], scene.limits.period));
  if (expected.resting.size() > most_resting)
    lines.emplace_back("", fmt::format("and {} more", expected.resting.size() - most_resting));
  const std::size_t unnamed = lines.size();
  for (const scene::FixedPoints::Names& named : points.names) {
    std::vector<std::string> texts;
    for (std::size_t i = 0; i < named.point.size(); ++i) texts.push_back(value_text(system, i, named.point[i]));
    lines.emplace_back(lines.size() == unnamed ? "names" : "",
                       fmt::format("at ({}): {}", fmt::join(texts, ", "), name_list(points, named.names)));
  }
  lines.emplace_back("sweep", sweep_text(scene.sweep));
  for (const scene::StateStart& start : scene.states)
    lines.emplace_back("state", fmt::format("T = {:g}{}", start.period, named(start.name)));
  for (const scene::LoopStart& start : scene.loops)
    lines.emplace_back("loop", fmt::format("{}, {} samples, T = {:g}{}", core::printable(start.file.path),
                                           start.samples.times.size(), start.period, named(start.name)));
  for (std::size_t n = 0; n < expected.orbits.size(); ++n)
    lines.emplace_back("orbit", core::printable(expected.orbits[n]) + named(scene.orbits[n].name));
  if (scene.recurrences)
    lines.emplace_back("recurrences",
                       fmt::format("{} returns to {:g} within T = {:g}, each a guess to correct; at most {} orbits "
                                   "are followed",
                                   expected.near_returns, scene.recurrences->tolerance, scene.recurrences->time,
                                   scene.recurrences->most));
  print_group("Starts", lines);
}

/// A length that the scene gives; where its unit is not the scales', what it is in them too.
std::string given_length(const systems::System& system, const systems::Scales& scales, double length) {
  const double unit = scene::scale_of_lengths(system, scales);
  const std::string in_scales = unit == 1.0 ? "" : fmt::format(" ({:.3g} of the scales)", length / unit);
  return length_text(system, length) + in_scales;
}

void print_continuation(const scene::Scene& scene, const systems::System& system, const systems::Scales& scales) {
  const scene::Continuation& c = scene.continuation;
  const bool is_in_scales = !c.start_is_given && !system.structure().has_angles();
  const std::string start = is_in_scales ? length_text(system, c.start_amplitude) + " of the scales"
                                         : given_length(system, scales, c.start_amplitude);
  const std::string step = c.fixed_step ? "fixed, " + given_length(system, scales, *c.fixed_step) : "adaptive";
  print_group("Continuation", {{"first orbit", start + " from its equilibrium"},
                               {"step", step},
                               {"tolerance", fmt::format("sqrt(loss) < {:g} * min(1, rms |dz/dt|)", c.tolerance)},
                               {"harmonics", fmt::format("K from {} to {}", c.cutoff_from, c.cutoff_to)},
                               {"corrector", c.corrector}});
}

std::string depth_text(int depth) {
  if (depth == 0) return "the base families only";
  if (depth == 1) return "the base families and their branches";
  if (depth == 2) return "the base families, their branches, and the branches of these";
  return fmt::format("the base families and {} generations of branches", depth);
}

std::string certificate_text(scene::Certificate certificate) {
  switch (certificate) {
    case scene::Certificate::automatic: return "closure of every orbit, as it is found";
    case scene::Certificate::none: return "none (closure: 2 to 16 orbits an orbit; full: 4 to 21)";
    case scene::Certificate::closure: return "closure of every orbit, when all families are known";
    case scene::Certificate::full: break;
  }
  return "closure of every orbit, its distance to the true one and its multipliers, when all families are known";
}

/// What is off says what it would cost, in times of an orbit of its branch (the ladder `features` of `orbweaver cost`,
/// docs/accuracy.md).
std::string stability_text(bool on) {
  return on ? "multipliers of every orbit"
            : "off: no crossings but folds are looked for (on: 0.4 to 3 orbits an orbit)";
}

void print_survey(const scene::Scene& scene) {
  const scene::Survey& survey = scene.survey;
  const bool all = survey.spectrum == scene::Spectrum::all;
  print_group("Survey",
              {{"depth", fmt::format("{}: {}", survey.depth, depth_text(survey.depth))},
               {"subharmonics", fmt::format("branches that close after up to {} period{}", survey.subharmonics,
                                            survey.subharmonics == 1 ? "" : "s")},
               {"spectrum", all ? "at every orbit" : "at events (at every orbit: 10 to 160 orbits an orbit)"},
               {"stability", stability_text(scene.compute.stability)},
               {"certificate", certificate_text(scene.compute.certificate)},
               {"team size", fmt::format("{} rank{} a task", survey.team_size, survey.team_size == 1 ? "" : "s")}});
}

bool has_given_orbits(const scene::Scene& scene) {
  return !scene.states.empty() || !scene.orbits.empty() || !scene.loops.empty() || scene.recurrences;
}

/// Whether every family would begin at an equilibrium of which `is_beyond` holds.
template <class Beyond>
bool all_begin(const scene::Scene& scene, const survey::ExpectedStarts& expected, const Beyond& is_beyond) {
  return scene.system.moving.free.empty() && !has_given_orbits(scene) && !expected.resting.empty() &&
         std::all_of(expected.resting.begin(), expected.resting.end(), is_beyond);
}

/// Behind a limit that leaves all families out.
std::string leaves_all_out(bool does, const std::string& what) {
  return does ? fmt::format("; {}, and nothing is followed: make it wider", what) : "";
}

std::string period_text(const scene::Scene& scene, const survey::ExpectedStarts& expected) {
  const double limit = scene.limits.period;
  if (std::isinf(limit)) return "any";
  const bool any_oscillates = std::any_of(expected.resting.begin(), expected.resting.end(),
                                          [](const auto& found) { return !found.periods.empty(); });
  const bool all_beyond =
      any_oscillates && all_begin(scene, expected, [&](const survey::ExpectedEquilibrium& found) {
        return std::all_of(found.periods.begin(), found.periods.end(), [&](double period) { return period > limit; });
      });
  return fmt::format("up to {}{}", limit, leaves_all_out(all_beyond, "all small oscillations take longer"));
}

std::string energy_range(const scene::Limits& limits) {
  if (std::isinf(limits.energy_from) && std::isinf(limits.energy_to)) return "any";
  return fmt::format("from {} to {}", limits.energy_from, limits.energy_to);
}

std::string energy_text(const scene::Scene& scene, const survey::ExpectedStarts& expected) {
  const bool all_beyond = all_begin(scene, expected, [&](const survey::ExpectedEquilibrium& found) {
    return found.energy < scene.limits.energy_from || found.energy > scene.limits.energy_to;
  });
  return energy_range(scene.limits) + leaves_all_out(all_beyond, "all equilibria lie outside");
}

std::string guards_text(const scene::Limits& limits, const systems::Structure& structure) {
  std::string text;
  for (const systems::Guard& guard : structure.guards) {
    const auto least = limits.guards.find(guard.name);
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", guard.name,
                        least == limits.guards.end() ? "any" : fmt::format("from {}", least->second));
  }
  return text.empty() ? "none in this system" : text;
}

std::string time_text(double seconds) {
  return std::isinf(seconds) ? "any" : fmt::format("the whole survey stops after {} s", seconds);
}

std::string task_time_text(double seconds) {
  return std::isinf(seconds) ? "any" : fmt::format("tasks that take more than {} s are put aside", seconds);
}

std::string parameter_range_text(const scene::Limits& limits, const systems::System& system) {
  const std::vector<std::string>& free = system.family_scalars().free;
  if (free.empty()) return "none moves";
  const double here = system.parameters().at(free.front());
  const bool any = std::isinf(limits.parameter_from) && std::isinf(limits.parameter_to);
  const bool outside = here < limits.parameter_from || here > limits.parameter_to;
  return any ? fmt::format("{} any", free.front())
             : fmt::format(
                   "{} from {} to {}{}", free.front(), limits.parameter_from, limits.parameter_to,
                   outside ? fmt::format("; {} = {} of system.parameters lies outside", free.front(), here) : "");
}

void print_limits(const scene::Scene& scene, const systems::System& system, const survey::ExpectedStarts& expected) {
  const scene::Limits& limits = scene.limits;
  print_group("Limits", {{"period", period_text(scene, expected)},
                         {"energy", energy_text(scene, expected)},
                         {"parameter", parameter_range_text(limits, system)},
                         {"guards", guards_text(limits, system.structure())},
                         {"families", fmt::format("at most {}", limits.families)},
                         {"steps", fmt::format("at most {} a family", limits.steps)},
                         {"time", time_text(limits.time)},
                         {"task time", task_time_text(limits.task_time)}});
}

std::string value_list(const std::string& quantity, const std::vector<double>& values) {
  return values.empty() ? "none" : fmt::format("the orbits with {} = {}", quantity, fmt::join(values, ", "));
}

std::string loci_text(const scene::Scene& scene) {
  if (scene.loci.empty()) return "none";
  std::vector<std::string> texts;
  for (const scene::Loci& loci : scene.loci) {
    std::vector<std::string> kinds;
    for (const scene::Loci::Of of : loci.of) kinds.push_back(scene::name_of(of));
    const std::string first = scene.system.moving.free.empty() ? "T" : scene.system.moving.free.front();
    texts.push_back(
        fmt::format("{} in {} and {} from {:g} to {:g}", fmt::join(kinds, ", "), first, loci.free, loci.from, loci.to));
  }
  return fmt::format("{}", fmt::join(texts, "; "));
}

void print_events(const scene::Scene& scene) {
  print_group("Located on every family, besides its crossings", {{"periods", value_list("T", scene.events.periods)},
                                                                 {"energies", value_list("E", scene.events.energies)},
                                                                 {"loci", loci_text(scene)}});
}

std::string section_text(const scene::Scene& scene, const systems::System& system) {
  if (scene.section.coordinate.empty()) return "none (with one: 0.05 to 0.6 orbits an orbit)";
  const auto place =
      std::find(system.info().state_names.begin(), system.info().state_names.end(), scene.section.coordinate);
  const auto index = static_cast<std::size_t>(place - system.info().state_names.begin());
  return fmt::format("{} = {}", scene.section.coordinate, value_text(system, index, scene.section.value));
}

void print_outputs(const scene::Scene& scene, const systems::System& system) {
  print_group(
      "Output",
      {{"section", section_text(scene, system)},
       {"flush", fmt::format("every {} s or {} orbits", scene.output.flush_seconds, scene.output.flush_orbits)}});
}

std::string bytes_text(double bytes) {
  constexpr double kibi = 1024.0;
  if (bytes < kibi * kibi) return fmt::format("{:.3g} KiB", bytes / kibi);
  if (bytes < kibi * kibi * kibi) return fmt::format("{:.3g} MiB", bytes / (kibi * kibi));
  return fmt::format("{:.3g} GiB", bytes / (kibi * kibi * kibi));
}

std::string orbit_cost_text(const survey::OrbitCost& cost) {
  constexpr double measured_from = 0.01;  // less is not proportional to the unknowns any more
  const std::string time = cost.seconds_to < measured_from
                               ? "some milliseconds"
                               : fmt::format("{:.2g} to {:.2g} s", cost.seconds_from, cost.seconds_to);
  return fmt::format("{:.0f} unknowns, {} an orbit, {} of memory a rank, {} an orbit in the archive", cost.unknowns,
                     time, bytes_text(cost.memory_bytes), bytes_text(cost.archive_bytes));
}

void print_cost(const survey::ExpectedWork& work) {
  const core::AddressSpace space = core::space_of_a_rank();
  print_group("Cost, about", {{"sweep", fmt::format("{:.0f} periods at each equilibrium, {:.2g} s at most",
                                                    work.sweep_periods, work.sweep_seconds)},
                              {fmt::format("K = {}", work.least.cutoff), orbit_cost_text(work.least)},
                              {fmt::format("K = {}", work.most.cutoff), orbit_cost_text(work.most)},
                              {"addresses", fmt::format("{} a rank, {} of them data, before its first orbit (`ulimit "
                                                        "-v`, `-d`); more where there are several ranks",
                                                        bytes_text(space.addresses), bytes_text(space.data))}});
}

/// Says what is worked at, which takes seconds where there are many coordinates: on a terminal that redraws only, until
/// the next is said or all is done.
class AtWork {
 public:
  AtWork() = default;
  AtWork(const AtWork&) = delete;
  AtWork& operator=(const AtWork&) = delete;
  ~AtWork() { say(""); }

  void say(const char* work) const {
    if (!_redraws) return;
    std::fprintf(stderr, "\r\x1b[K%s", work);
    std::fflush(stderr);
  }

 private:
  bool _redraws = core::terminal_of(STDERR_FILENO).redraws;
};

int check(const SceneOptions& options, const Invocation& invocation) {
  if (!invocation.petsc_options.empty())
    throw core::InputError(
        fmt::format("check: expected no PETSc options, got `{}`; it follows no family, so drop `--` and what follows",
                    fmt::join(invocation.petsc_options, " ")));
  const scene::Scene scene = options.load();
  const AtWork at_work;
  at_work.say("checking what the system says of itself ...");
  const auto bound = scene::bound_system(scene.system);
  const systems::System& system = *bound;
  const survey::ExpectedWork work = survey::expected_work(scene, system);
  survey::require_memory(work);
  at_work.say("looking for the scales of the coordinates ...");
  const survey::ScaledScene scaled(scene, bound);
  at_work.say("looking for equilibria, their oscillations and symmetries ...");
  const survey::ExpectedStarts expected = survey::expected_starts(scaled.scene(), *scaled.system());
  const std::vector<std::vector<double>> points = resting_points(scene, system);
  at_work.say("");
  fmt::print("{}: a valid scene, \"{}\"\n", core::printable(options.file.string()), scene.name);
  print_system(scene, system, scaled.system()->scales());
  print_simulated(scene, system, points, expected.undeclared);
  print_starts(scene, system, expected);
  print_continuation(scene, system, scaled.system()->scales());
  print_survey(scene);
  print_limits(scene, system, expected);
  print_events(scene);
  print_outputs(scene, system);
  print_cost(work);
  print_result("");  // throws if what was printed cannot be written
  return 0;
}

}  // namespace

Command make_check_command(CLI::App& program) {
  CLI::App* parser = program.add_subcommand("check", "Validate a scene and say what would be simulated");
  auto options = std::make_shared<SceneOptions>();
  add_scene_options(*parser, *options);
  add_examples(*parser, {"orbweaver check drivers/scenes/double_pendulum.yaml",
                         "orbweaver check drivers/scenes/double_pendulum.yaml --set limits.period=20"});
  return {parser, [options](const Invocation& invocation) { return check(*options, invocation); }};
}

}  // namespace orbweaver::drivers
