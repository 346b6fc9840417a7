#include "orbweaver/systems/scaled_system.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "graph_system.hpp"
#include "orbweaver/core/error.hpp"

namespace orbweaver::systems {

namespace {

Structure scaled_structure(Structure structure, const Scales& scales) {
  const auto scale = [&](std::vector<Symmetry>& symmetries) {
    for (Symmetry& symmetry : symmetries)
      for (Eigen::Index i = 0; i < symmetry.map.offset.size(); ++i)  // matrices mix equal scales only
        symmetry.map.offset(i) /= scales.coordinate(static_cast<std::size_t>(i));
  };
  scale(structure.equivariances);
  scale(structure.reversors);
  return structure;
}

void check(const System& system, const Scales& scales) {
  const auto d = static_cast<std::size_t>(system.dimension());
  core::require(system.scales().are_one(), "a system is scaled once");
  core::require(scales.coordinates.empty() || scales.coordinates.size() == d, "one scale a coordinate");
  core::require(scales.parameters.empty() || scales.parameters.size() == system.family_scalars().free.size(),
                "one scale a parameter that moves");
  core::require(scales.conserved.empty() || scales.conserved.size() == system.structure().conserved.size(),
                "one scale a conserved quantity");
  const auto is_scale = [](double scale) { return std::isfinite(scale) && scale > 0.0; };
  core::require(is_scale(scales.time) && std::all_of(scales.coordinates.begin(), scales.coordinates.end(), is_scale) &&
                    std::all_of(scales.conserved.begin(), scales.conserved.end(), is_scale) &&
                    std::all_of(scales.parameters.begin(), scales.parameters.end(), is_scale),
                "scales are positive");
  const std::vector<std::size_t> first = mixed_coordinates(system.structure());
  for (std::size_t i = 0; i < d; ++i) {
    core::require(!system.structure().is_angle(i) || scales.coordinate(i) == 1.0, "angles have the scale 1");
    core::require(scales.coordinate(i) == scales.coordinate(first[i]),
                  "coordinates that a symmetry mixes have one scale");
  }
}

}  // namespace

std::vector<std::size_t> mixed_coordinates(const Structure& structure) {
  std::vector<std::size_t> first(static_cast<std::size_t>(structure.dimension));
  for (std::size_t i = 0; i < first.size(); ++i) first[i] = i;
  for (const std::vector<Symmetry>* symmetries : {&structure.equivariances, &structure.reversors})
    for (const Symmetry& symmetry : *symmetries)
      for (std::size_t i = 0; i < first.size(); ++i)
        for (std::size_t l = 0; l < first.size(); ++l) {
          if (symmetry.map.matrix(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(l)) == 0.0) continue;
          const auto [lower, upper] = std::minmax(first[i], first[l]);
          if (lower != upper) std::replace(first.begin(), first.end(), std::size_t{upper}, std::size_t{lower});
        }
  return first;
}

std::shared_ptr<const System> scaled(std::shared_ptr<const System> system, const Scales& scales) {
  check(*system, scales);
  if (scales.are_one()) return system;
  const std::shared_ptr<const GraphSystem> plain = graph_system(system);
  const auto frame_of = [scales](const std::shared_ptr<const GraphSystem>& whole) {
    return Frame{whole->info(), scaled_structure(whole->structure(), scales), scales, {}, whole->frame().has_action};
  };
  return std::make_shared<const GraphSystem>(plain, plain->equations(), std::vector<double>{}, plain->family_scalars(),
                                             frame_of);
}

}  // namespace orbweaver::systems
