#include "equilibrium_end.hpp"

#include <fmt/format.h>

#include "orbweaver/loop/curve/measures.hpp"
#include "orbweaver/loop/curve/system_at.hpp"
#include "orbweaver/starts/fixed_points.hpp"
#include "orbweaver/survey/tree/naming.hpp"

namespace orbweaver::survey {

EquilibriumEnd equilibrium_end(const scene::Scene& scene, const systems::System& system, const loop::Loop& last) {
  const std::span<const double> mean(last.modes.data(), static_cast<std::size_t>(last.dimension));
  const std::shared_ptr<const systems::System> here = loop::system_at(system, last);
  const auto point = starts::fixed_point_near(*here, mean, loop::rms_amplitude(last));
  if (!point) return {-1, fmt::format("no equilibrium found near {}", point_text(system, {mean.begin(), mean.end()}))};
  const std::string place = point_text(system, *point);
  const auto known = starts::find_fixed_points(system, scene.fixed_points.grid);
  for (std::size_t n = 0; n < known.size(); ++n)
    if (starts::is_same_fixed_point(known[n], *point))
      return {static_cast<int>(n), fmt::format("{}, {}", equilibrium_name(static_cast<int>(n)), place)};
  // The survey's equilibria have the scene's parameters: where one has moved they lie elsewhere on their curves.
  const std::vector<std::string>& free = system.family_scalars().free;
  if (!free.empty())
    return {-1, fmt::format("{} at {} = {:.9g}", place, free.front(), here->parameters().at(free.front()))};
  return {-1, fmt::format("{}, an equilibrium that starts.fixed_points.grid does not lead to", place)};
}

}  // namespace orbweaver::survey
