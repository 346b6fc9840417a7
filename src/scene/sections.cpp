#include "sections.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "fields.hpp"
#include "orbweaver/systems/registry.hpp"
#include "system_section.hpp"

namespace orbweaver::scene {

void read_sweep(const Field& field, Sweep& sweep) {
  const Keys keys(field, names_of_keys(field.path()), "sweep: {period: [1, 12], step: 0.01}");
  const auto step = keys.find("step");
  if (step && step->plain_scalar() != "auto")
    sweep.step = step->number({.lower = 0, .lower_open = true, .example = "0.01"});
  const auto period = keys.find("period");
  if (!period || period->plain_scalar() == "auto") return;
  const auto [from, to] = period->range({.lower = 0, .lower_open = true, .example = "[1, 12]"});
  sweep.period = {from, to};
  const double width = to - from;
  const double length = sweep.step.value_or(Sweep::standard_step);
  if (length > width || width / length > Sweep::most_steps)
    step.value_or(field).fail(fmt::format("a step from {:g} to {:g}, the width of the sweep over [{}, {}]",
                                          width / Sweep::most_steps, width, from, to),
                              fmt::format("{:g}", length), "change the step or the periods");
}

void read_continuation(const Field& field, const systems::System& system, Continuation& continuation) {
  const bool angles = system.structure().has_angles();
  const Keys keys(field, names_of_keys(field.path()), "continuation: {step: adaptive}");
  if (const auto step = keys.find("step"); step && step->plain_scalar() != "adaptive")
    continuation.fixed_step = step->length(angles, "`adaptive` or ");
  if (const auto start = keys.find("start"); start && start->plain_scalar() != "auto") {
    continuation.start_amplitude = start->length(angles);
    continuation.start_is_given = true;
  }
  if (const auto tolerance = keys.find("tolerance"))
    continuation.tolerance = tolerance->number({.lower = 1e-14, .upper = 1e-3, .example = "1e-10"});
  if (const auto cutoff = keys.find("cutoff")) {
    const std::vector<Field> ends = cutoff->list("[8, 4096]");
    if (ends.size() != 2) cutoff->fail("a list of two integers, from and to", cutoff->got(), "for example [8, 4096]");
    continuation.cutoff_from = ends[0].integer({.lower = 1, .upper = 1000000, .example = "8"});
    continuation.cutoff_to = ends[1].integer({.lower = 1, .upper = 1000000, .example = "4096"});
    if (continuation.cutoff_from > continuation.cutoff_to)
      cutoff->fail("from <= to", cutoff->got(), "give the smaller number first");
  }
  if (const auto corrector = keys.find("corrector"))
    continuation.corrector = corrector->choice(
        {"automatic", "collocation", "newton-krylov", "brgn", "nls", "ntr", "lmvm", "rprop", "rprop-extrapolated"});
}

namespace {

std::vector<std::string> names_of(const std::vector<systems::Parameter>& parameters) {
  std::vector<std::string> names;
  for (const systems::Parameter& parameter : parameters) names.push_back(parameter.name);
  return names;
}

}  // namespace

void read_family_scalars(const std::optional<Field>& field, SystemChoice& choice) {
  using Hold = systems::FamilyScalars::Hold;
  const bool conservative = bound_system(choice)->structure().conservative();
  const std::vector<std::string> names = names_of(known_parameters(info_of(choice), choice));
  std::optional<Field> free;
  std::optional<Field> hold;
  if (field) {
    const Keys keys(*field, names_of_keys(field->path()), "continuation: {free: m2, hold: energy}");
    free = keys.find("free");
    hold = keys.find("hold");
  }
  if (free) {
    choice.moving.free = {free->choice(names)};
    ask_system(*free, choice);
  }
  if (hold && (!free || !conservative))
    hold->fail(free ? "no such key, as the system conserves nothing" : "no such key without `free`", hold->got(),
               "leave it out");
  if (free && conservative)
    choice.moving.hold = hold && hold->choice({"energy", "period"}) == "period" ? Hold::period : Hold::energy;
}

void read_survey(const Field& field, Survey& survey) {
  const Keys keys(field, names_of_keys(field.path()), "survey: {depth: 2, subharmonics: 4}");
  if (const auto depth = keys.find("depth")) survey.depth = depth->integer({.lower = 0, .upper = 16, .example = "2"});
  if (const auto most = keys.find("subharmonics"))
    survey.subharmonics = most->integer({.lower = 1, .upper = 16, .example = "4"});
  if (const auto spectrum = keys.find("spectrum"))
    survey.spectrum = spectrum->choice({"all", "events"}) == "all" ? Spectrum::all : Spectrum::events;
  if (const auto team = keys.find("team_size"))
    survey.team_size = team->integer({.lower = 1, .upper = 1000000, .example = "1"});
}

void read_compute(const Field& field, Compute& compute) {
  const Keys keys(field, names_of_keys(field.path()), "compute: {certificate: full}");
  if (const auto stability = keys.find("stability")) compute.stability = stability->choice({"true", "false"}) == "true";
  if (const auto certificate = keys.find("certificate")) {
    const std::string level = certificate->choice({"automatic", "none", "closure", "full"});
    compute.certificate = level == "automatic" ? Certificate::automatic
                          : level == "none"    ? Certificate::none
                          : level == "closure" ? Certificate::closure
                                               : Certificate::full;
  }
}

namespace {

void read_guards(const Field& field, const systems::System& system, std::map<std::string, double>& guards) {
  const std::vector<std::string> names = system.structure().guard_names();
  if (names.empty())
    field.fail(fmt::format("no such key, as {} names no guards", system.info().name), field.got(), "leave it out");
  const Keys keys(field, names, fmt::format("guards: {{{}: 0.01}}", names.front()));
  for (const std::string& name : names)
    if (const auto least = keys.find(name))
      guards[name] = least->number({.lower = 0, .lower_open = true, .example = "0.01"});
}

}  // namespace

void keep_to_model(const SystemChoice& choice, const systems::System& system, Limits& limits) {
  if (system.family_scalars().free.empty()) return;
  for (const systems::Parameter& parameter : known_parameters(info_of(choice), choice))
    if (parameter.name == system.family_scalars().free.front())
      std::tie(limits.parameter_from, limits.parameter_to) = std::pair(parameter.lower, parameter.upper);
}

namespace {

/// Of a key that holds energies.
void require_energy(const Field& field, const systems::System& system) {
  if (system.structure().conservative()) return;
  const bool loses_it = system.structure().dissipative || system.structure().driven;
  field.fail(fmt::format("no energies, as {} conserves none", system.info().title), field.got(),
             loses_it ? "leave it out" : "leave it out, or name the energy in the model's structure.conserved");
}

}  // namespace

void read_limits(const Field& field, const systems::System& system, Limits& limits) {
  const Keys keys(field, names_of_keys(field.path()), "limits: {period: 30}");
  if (const auto period = keys.find("period"))
    limits.period = period->number({.lower = 0, .lower_open = true, .infinite = true, .example = "30"});
  if (const auto energy = keys.find("energy")) {
    std::tie(limits.energy_from, limits.energy_to) = energy->range({.infinite = true, .example = "[-.inf, .inf]"});
    if (std::isfinite(limits.energy_from) || std::isfinite(limits.energy_to)) require_energy(*energy, system);
  }
  if (const auto parameter = keys.find("parameter")) {
    if (system.family_scalars().free.empty())
      parameter->fail("no such key, as no parameter moves", parameter->got(),
                      "name one with `continuation: {free: ...}`");
    const auto [from, to] = parameter->range({.infinite = true, .example = "[0, 0.5]"});
    const bool is_within = !(std::isfinite(from) && from < limits.parameter_from) &&
                           !(std::isfinite(to) && to > limits.parameter_to) && to > limits.parameter_from &&
                           from < limits.parameter_to;
    if (!is_within)
      parameter->fail(fmt::format("a range within [{:g}, {:g}], the values that {} may have", limits.parameter_from,
                                  limits.parameter_to, system.family_scalars().free.front()),
                      parameter->got(), "change the range");
    limits.parameter_from = std::max(limits.parameter_from, from);
    limits.parameter_to = std::min(limits.parameter_to, to);
  }
  if (const auto guards = keys.find("guards")) read_guards(*guards, system, limits.guards);
  if (const auto families = keys.find("families")) limits.families = families->integer({.lower = 1, .example = "1000"});
  if (const auto steps = keys.find("steps")) limits.steps = steps->integer({.lower = 1, .example = "5000"});
  if (const auto time = keys.find("time"))
    limits.time = time->number({.lower = 0, .lower_open = true, .infinite = true, .example = "300"});
  if (const auto time = keys.find("task_time"))
    limits.task_time = time->number({.lower = 0, .lower_open = true, .infinite = true, .example = "3600"});
}

void read_events(const Field& field, const systems::System& system, Events& events) {
  const Keys keys(field, names_of_keys(field.path()), "events: {periods: [10], energies: [0]}");
  if (const auto periods = keys.find("periods"))
    events.periods = periods->numbers({.lower = 0, .lower_open = true, .example = "10"});
  if (const auto energies = keys.find("energies")) {
    events.energies = energies->numbers({.example = "0.5"});
    if (!events.energies.empty()) require_energy(*energies, system);
  }
}

void read_section(const Field& field, const systems::System& system, Section& section) {
  const Keys keys(field, names_of_keys(field.path()), "section: {coordinate: w1, value: 0}");
  const std::vector<std::string>& names = system.info().state_names;
  const auto coordinate = keys.find("coordinate");
  if (!coordinate)
    field.fail("the section's `coordinate`", "a section without it", "name one of the system's coordinates");
  section.coordinate = coordinate->choice(names);
  const auto value = keys.find("value");
  if (!value) return;
  section.value = value->number({.example = "0"});
  const auto place = std::find(names.begin(), names.end(), section.coordinate);
  if (system.structure().is_angle(static_cast<std::size_t>(place - names.begin())))
    section.value = radians(section.value);
}

std::string name_of(Loci::Of of) {
  switch (of) {
    case Loci::Of::fold_period: return "fold-period";
    case Loci::Of::fold_energy: return "fold-energy";
    case Loci::Of::fold_parameter: return "fold-parameter";
    case Loci::Of::period_doubling: return "period-doubling";
    case Loci::Of::branch_point: return "branch-point";
    case Loci::Of::torus: break;
  }
  return "torus";
}

namespace {

/// Why the families have no such loci, and what to do; empty where they may have some.
std::pair<std::string, std::string> obstacle_of(Loci::Of of, const systems::System& system) {
  const systems::Structure& structure = system.structure();
  const bool moves = !system.family_scalars().free.empty();
  switch (of) {
    case Loci::Of::fold_period:
    case Loci::Of::fold_energy:
      if (moves)
        return {fmt::format("families in {} fold in it", system.family_scalars().free.front()), "say fold-parameter"};
      if (of == Loci::Of::fold_energy && !structure.conservative())
        return {fmt::format("{} conserves no energy", system.info().title), "leave it out"};
      break;
    case Loci::Of::fold_parameter:
      if (!moves) return {"no parameter moves along the families", "say fold-period or fold-energy"};
      break;
    case Loci::Of::period_doubling: break;
    case Loci::Of::branch_point:
      if (structure.equivariances.empty() && structure.reversors.empty())
        return {fmt::format("{} has no symmetry that could enforce branch points, and those that none enforces have "
                            "codimension two: in two parameters they are points",
                            system.info().title),
                "leave it out"};
      break;
    case Loci::Of::torus:
      if (structure.symplectic || structure.conservative())
        return {fmt::format("multipliers of {} do not leave the unit circle as torus points have them",
                            system.info().title),
                "leave it out"};
      break;
  }
  return {};
}

}  // namespace

void read_loci(const Field& field, Scene& scene, const systems::System& system) {
  constexpr std::string_view example = "[{of: [period-doubling], free: [m2], range: [0.5, 2]}]";
  if (!scene.compute.stability)
    field.fail("`compute.stability: true`, as loci begin at crossings", "false", "leave one of them out");
  const std::vector<systems::Parameter> parameters = known_parameters(info_of(scene.system), scene.system);
  const std::vector<std::string>& moving = system.family_scalars().free;
  std::vector<std::string> names;
  for (const systems::Parameter& parameter : parameters)
    if (std::find(moving.begin(), moving.end(), parameter.name) == moving.end()) names.push_back(parameter.name);
  std::vector<std::string> kinds;
  for (int n = 0; n <= static_cast<int>(last_of(Loci::Of{})); ++n) kinds.push_back(name_of(static_cast<Loci::Of>(n)));
  for (const Field& entry : field.list(example)) {
    const Keys keys(entry, names_of_keys(entry.path()), example);
    const auto of = keys.find("of");
    const auto free = keys.find("free");
    if (!of || !free) entry.fail("an `of` and a `free`", entry.got(), fmt::format("for example {}", example));
    Loci loci;
    for (const Field& kind : of->list("[period-doubling]")) {
      const std::string name = kind.choice(kinds);
      const auto place = std::find(kinds.begin(), kinds.end(), name) - kinds.begin();
      loci.of.push_back(static_cast<Loci::Of>(place));
      const auto [problem, advice] = obstacle_of(loci.of.back(), system);
      if (!problem.empty()) kind.fail(fmt::format("loci that can be had: {}", problem), kind.got(), advice);
    }
    const std::vector<Field> second = free->list("[m2]");
    if (second.size() != 1) free->fail("one parameter", free->got(), "a locus has one besides that of the families");
    loci.free = second.front().choice(names);
    SystemChoice moved = scene.system;
    moved.moving.free.push_back(loci.free);
    ask_system(second.front(), moved);
    const auto parameter = std::find_if(parameters.begin(), parameters.end(),
                                        [&](const systems::Parameter& p) { return p.name == loci.free; });
    loci.from = parameter->lower;
    loci.to = parameter->upper;
    if (const auto range = keys.find("range")) std::tie(loci.from, loci.to) = range->range({.example = "[0.5, 2]"});
    const double here = system.parameters().at(loci.free);
    if (loci.from < parameter->lower || loci.to > parameter->upper || here < loci.from || here > loci.to)
      keys.find("range").value_or(entry).fail(fmt::format("a range within [{:g}, {:g}] that has the scene's {} = {:g}",
                                                          parameter->lower, parameter->upper, loci.free, here),
                                              fmt::format("`[{:g}, {:g}]`", loci.from, loci.to), "change the range");
    scene.loci.push_back(std::move(loci));
  }
}

void read_output(const Field& field, Output& output) {
  const Keys keys(field, names_of_keys(field.path()), "output: {flush_seconds: 5}");
  if (const auto seconds = keys.find("flush_seconds"))
    output.flush_seconds = seconds->number({.lower = 0, .lower_open = true, .example = "5"});
  if (const auto orbits = keys.find("flush_orbits"))
    output.flush_orbits = orbits->integer({.lower = 1, .example = "5000"});
}

}  // namespace orbweaver::scene
