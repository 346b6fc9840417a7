#include "given_starts.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "orbweaver/archive/read/loop_of.hpp"
#include "orbweaver/archive/read/reader.hpp"
#include "orbweaver/core/command_line.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/core/text.hpp"
#include "orbweaver/loop/curve/in_units.hpp"
#include "orbweaver/starts/loop_guess.hpp"
#include "orbweaver/starts/near_returns.hpp"

namespace orbweaver::survey {

namespace {

using From = GivenStart::From;

std::string entry_text(const char* key, std::size_t n) { return fmt::format("starts.{}, entry {}", key, n + 1); }

void require_same_system(const archive::Archive& atlas, const scene::Scene& scene, const systems::System& system) {
  const archive::Header& header = atlas.header();
  const std::set<std::string> effects(scene.system.effects.begin(), scene.system.effects.end());
  const std::set<std::string> there(header.effects.begin(), header.effects.end());
  const auto text = [](const std::string& name, const std::set<std::string>& with) {
    return with.empty() ? core::printable(name)
                        : fmt::format("{} with {}", core::printable(name),
                                      core::printable(fmt::format("{}", fmt::join(with, ", "))));
  };
  if (header.system != system.info().name || there != effects || header.state_names != system.info().state_names)
    throw core::InputError(fmt::format("expected an archive of {}, got one of {}; its orbits are none of this system",
                                       text(system.info().name, effects),
                                       header.system.empty() ? "an unnamed system" : text(header.system, there)));
}

std::size_t family_row(const archive::Archive& atlas, const std::string& family) {
  const std::vector<std::string>& names = atlas.families().texts("name");
  const auto found = std::find(names.begin(), names.end(), family);
  if (found == names.end())
    throw core::InputError(fmt::format("expected a family of {}, got `{}`; `{}` lists them", atlas.path().string(),
                                       family, core::command_line({"show", atlas.path().string(), "families"})));
  return static_cast<std::size_t>(found - names.begin());
}

/// The row of /orbits that is nearest, of the family's.
std::size_t orbit_row(const archive::Archive& atlas, const scene::OrbitStart& start) {
  const std::size_t family = family_row(atlas, start.family);
  const auto first = static_cast<std::size_t>(atlas.families().integers("first_orbit")[family]);
  const auto count = static_cast<std::size_t>(atlas.families().integers("orbit_count")[family]);
  if (count == 0) throw core::InputError(fmt::format("{} has no orbits of `{}`", atlas.path().string(), start.family));
  const auto value = [&](std::size_t row) {
    switch (start.near) {
      case scene::OrbitStart::Near::period: return atlas.orbits().reals("period")[row];
      case scene::OrbitStart::Near::energy: return atlas.orbits().reals("energy")[row];
      case scene::OrbitStart::Near::step: break;
    }
    return static_cast<double>(atlas.orbits().integers("step")[row]);
  };
  std::size_t nearest = first;
  for (std::size_t row = first; row < first + count; ++row)
    if (std::abs(value(row) - start.value) < std::abs(value(nearest) - start.value)) nearest = row;
  if (std::isnan(value(nearest)))
    throw core::InputError(
        fmt::format("the orbits of `{}` have no {}; give another of `near`", start.family, name_of(start.near)));
  return nearest;
}

SweepWork work_of(const scene::OrbitStart& start, std::size_t n, const scene::Scene& scene,
                  const systems::System& system) {
  SweepWork work;
  GivenStart& given = work.given.emplace_back();
  given.name = start.name;
  given.from = From::archive;
  given.told = entry_text("orbits", n);
  try {
    if (start.archive.file.empty()) throw core::InputError("a stored scene does not hold it; survey the scene's file");
    const archive::Archive atlas(start.archive.file);
    require_same_system(atlas, scene, system);
    const std::size_t row = orbit_row(atlas, start);
    given.guess = loop::in_scales(archive::loop_of(atlas, row, system.structure().angles), system.scales());
    std::string differing;
    const archive::Header& header = atlas.header();
    for (std::size_t k = 0; k < header.parameter_names.size(); ++k) {
      const auto here = system.parameters().find(header.parameter_names[k]);
      if (here != system.parameters().end() && here->second != header.parameter_values[k])
        differing += fmt::format(", there with {} = {:g}", here->first, header.parameter_values[k]);
    }
    given.told += fmt::format(": {}, step {}, T = {:.9g}{}", start.family, atlas.orbits().integers("step")[row],
                              atlas.orbits().reals("period")[row], differing);
  } catch (const core::InputError& error) {
    throw core::InputError(fmt::format("{}: {}", given.told, error.what()));
  }
  given.guess.parameters.clear();  // those of the scene
  given.period = given.guess.period;
  work.point = loop::state_at(given.guess, 0.0);
  return work;
}

SweepWork work_of(const scene::LoopStart& start, std::size_t n, const systems::System& system) {
  SweepWork work;
  GivenStart& given = work.given.emplace_back();
  given.name = start.name;
  given.from = From::loop;
  given.told = entry_text("loops", n);
  if (start.samples.times.empty())
    throw core::InputError(given.told + ": a stored scene does not hold it; survey the scene's file");
  try {
    given.guess = starts::loop_through(
        system.structure(), starts::curve_through(system, start.samples.times, start.samples.states, start.period));
  } catch (const core::InputError& error) {
    throw core::InputError(fmt::format("{}: {}", given.told, error.what()));
  }
  given.period = start.period;
  work.point = start.samples.states.front();
  return work;
}

}  // namespace

std::vector<SweepWork> given_starts(const scene::Scene& scene, const systems::System& system) {
  std::vector<SweepWork> works;
  for (std::size_t n = 0; n < scene.states.size(); ++n) {
    const scene::StateStart& start = scene.states[n];
    works.push_back({0, start.state, {{From::state, start.name, entry_text("states", n), start.period, 0, 1, {}}}});
  }
  for (std::size_t n = 0; n < scene.orbits.size(); ++n) works.push_back(work_of(scene.orbits[n], n, scene, system));
  for (std::size_t n = 0; n < scene.loops.size(); ++n) works.push_back(work_of(scene.loops[n], n, system));
  if (!scene.recurrences) return works;
  const scene::Recurrences& given = *scene.recurrences;
  for (const starts::NearReturn& found :
       starts::near_returns(system, given.state, {given.time, given.period_from, given.period_to, given.tolerance}))
    works.push_back(
        {0, found.state, {{From::trajectory, "", "starts.recurrences", found.time, found.symmetry, found.order, {}}}});
  return works;
}

}  // namespace orbweaver::survey
