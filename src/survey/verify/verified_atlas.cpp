#include "verify/verified_atlas.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "orbweaver/archive/read/loop_of.hpp"
#include "orbweaver/continuation/orbit.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/loop/curve/in_units.hpp"
#include "orbweaver/loop/symmetry/alignment.hpp"
#include "orbweaver/loop/symmetry/isotropy_text.hpp"
#include "orbweaver/scene/in_scales.hpp"
#include "orbweaver/survey/atlas/stored_orbits.hpp"
#include "orbweaver/survey/run/scaled_scene.hpp"
#include "orbweaver/systems/registry.hpp"
#include "orbweaver/systems/scaled_system.hpp"
#include "tasks/certified.hpp"
#include "witness/tolerance.hpp"

namespace orbweaver::survey {

namespace {

/// Relative: an orbit at a period or an energy that the scene asks for is solved for at it.
constexpr double at_request = 1e-9;
/// Of a way: a loop so far from its neighbour was begun as that was.
constexpr double as_it_is = 1e-9;

/// Archives from before there were scales have none.
void require_scales(const archive::Header& header, const systems::System& system) {
  const std::size_t wanted = 1 + static_cast<std::size_t>(system.dimension()) + system.structure().conserved.size() +
                             system.family_scalars().free.size();
  if (!header.scales.empty() && header.scales.size() != wanted)
    throw core::InputError(fmt::format("the archive has {} scales; its system {} asks for {}", header.scales.size(),
                                       system.info().name, wanted));
}

std::shared_ptr<const systems::System> system_of(const archive::Header& header, const scene::Scene& scene) {
  auto system = scene::bound_system(scene.system);
  const bool fits =
      header.state_names == system->info().state_names && header.winding_names == system->winding_names() &&
      (header.winding_coordinates.empty() || header.winding_coordinates == system->structure().angles) &&
      header.pairs == system->structure().pairs() &&
      archive::has_complex_stability(header) == (!system->structure().symplectic || system->structure().pairs() > 1);
  if (!fits)
    throw core::InputError(fmt::format(
        "the archive's columns are not those of the system {} that its scene names: it was written by another version, "
        "or changed",
        scene.system.name));
  require_scales(header, *system);
  const systems::Scales scales = scales_of(header, *system);
  return scales.are_one() ? system : systems::scaled(system, scales);
}

}  // namespace

VerifiedAtlas::VerifiedAtlas(const std::filesystem::path& path) : VerifiedAtlas(archive::Archive(path)) {}

VerifiedAtlas::VerifiedAtlas(archive::Archive&& open)
    : _archive(std::make_unique<archive::Archive>(std::move(open))),
      _scene(scene_of(*_archive)),
      _system(system_of(_archive->header(), _scene)),
      _tree(std::make_unique<AtlasTree>(*_archive, witness_tolerance)) {
  for (const TreeFamily& family : _tree->families)
    _isotropies.push_back(loop::isotropy_of(_system->structure(), family.isotropy));
}

loop::Loop VerifiedAtlas::loop(std::size_t orbit) const {
  loop::Loop found = archive::loop_of(*_archive, orbit, _system->structure().angles);
  const bool moves = !_system->family_scalars().free.empty();
  if (moves && found.parameters.empty())
    throw core::InputError(fmt::format("{}: row {} of /orbits: `parameter` is not a number, though families move in it",
                                       _archive->path().string(), orbit));
  if (!moves) found.parameters.clear();  // which the checks of the columns object to
  return loop::in_scales(std::move(found), _system->scales());
}

bool VerifiedAtlas::has_reversor(std::size_t family) const {
  return std::any_of(_isotropies[family].begin(), _isotropies[family].end(),
                     [](const loop::SymmetryElement& element) { return element.reversing; });
}

loop::Loop VerifiedAtlas::begun_as(std::size_t family, const loop::Loop& loop, const loop::Loop& neighbour,
                                   double way) const {
  const systems::Structure& system = _system->structure();
  if (has_reversor(family)) {
    const auto off = [&](const loop::Loop& one) {
      return std::abs(continuation::arclength_in_units(*_system, neighbour, one) - way);
    };
    if (off(loop) <= as_it_is * way) return loop;
    loop::Loop other = loop::aligned(loop, loop::align(system, loop, neighbour));
    return off(other) < off(loop) ? other : loop;
  }
  // Neighbours differ by where they begin, not by a symmetry: only shifts are looked through.
  return loop::aligned(loop, loop::align_in_time(system, loop, neighbour));
}

bool VerifiedAtlas::is_requested(std::size_t orbit) const {
  const auto near = [](double value) {
    return [value](double wanted) { return std::abs(value - wanted) <= at_request * std::abs(wanted); };
  };
  const auto& events = _scene.events;
  return std::any_of(events.periods.begin(), events.periods.end(), near(_archive->orbits().reals("period")[orbit])) ||
         std::any_of(events.energies.begin(), events.energies.end(), near(_archive->orbits().reals("energy")[orbit]));
}

scene::Section VerifiedAtlas::section() const {
  if (_archive->format_minor() < archive::sections_since) return {};
  return scene::in_scales(_scene, *_system, _system->scales()).section;
}

certificate::Level VerifiedAtlas::certificate_level() const {
  return std::max(survey::certificate_level(_scene), certificate::Level::closure);
}

bool VerifiedAtlas::claims_certificates() const {
  return _archive->format_minor() >= archive::certificates_since && is_certified_by_branches(_scene);
}

certificate::Evidence stored_evidence(const VerifiedAtlas& atlas, std::size_t orbit, const loop::Loop& loop) {
  const archive::Table& orbits = atlas.archive().orbits();
  const archive::Header& header = atlas.archive().header();
  const std::size_t width = archive::stability_width(header);
  return evidence_of(loop, orbits.reals("loss_rms")[orbit],
                     std::span(orbits.reals("stability")).subspan(orbit * width, width),
                     archive::has_complex_stability(header), orbits.reals("stability_error")[orbit]);
}

}  // namespace orbweaver::survey
