#include "orbweaver/survey/atlas/stored_orbits.hpp"

#include "orbweaver/archive/read/loop_of.hpp"
#include "orbweaver/loop/curve/in_units.hpp"
#include "orbweaver/loop/curve/measures.hpp"
#include "orbweaver/loop/symmetry/alignment.hpp"
#include "orbweaver/systems/registry.hpp"
#include "orbweaver/systems/scaled_system.hpp"

namespace orbweaver::survey {

std::shared_ptr<const systems::System> system_of(const scene::Scene& scene) {
  return scene::bound_system(scene.system);
}

scene::Scene scene_of(const archive::Archive& atlas) {
  return scene::parse(atlas.header().scene, atlas.path().string(), {}, atlas.header().model);
}

systems::Scales scales_of(const archive::Header& header, const systems::System& system) {
  systems::Scales scales;
  const auto coordinates = static_cast<std::ptrdiff_t>(system.dimension());
  const auto conserved = static_cast<std::ptrdiff_t>(system.structure().conserved.size());
  const std::size_t free = system.family_scalars().free.size();
  if (header.scales.size() != static_cast<std::size_t>(1 + coordinates + conserved) + free) return scales;
  scales.time = header.scales.front();
  scales.coordinates.assign(header.scales.begin() + 1, header.scales.begin() + 1 + coordinates);
  const auto quantities = header.scales.begin() + 1 + coordinates;
  scales.conserved.assign(quantities, quantities + conserved);
  scales.parameters.assign(quantities + conserved, header.scales.end());
  return scales;
}

std::shared_ptr<const systems::System> scaled_system_of(const archive::Archive& atlas) {
  const auto system = system_of(scene_of(atlas));
  return systems::scaled(system, scales_of(atlas.header(), *system));
}

loop::Loop stored_loop(const archive::Archive& atlas, std::size_t orbit, const systems::System& system) {
  return loop::in_scales(archive::loop_of(atlas, orbit, system.structure().angles), system.scales());
}

loop::Loop started_as(const systems::Structure& system, const loop::Loop& loop, const loop::Loop& neighbour) {
  constexpr double nearer = 0.5;
  const loop::Alignment alignment = loop::align(system, loop, neighbour);
  return alignment.distance < nearer * loop::mean_distance(loop, neighbour) ? loop::aligned(loop, alignment) : loop;
}

}  // namespace orbweaver::survey
