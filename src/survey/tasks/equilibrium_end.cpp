#include "equilibrium_end.hpp"

#include <fmt/format.h>

#include "orbweaver/loop/curve/measures.hpp"
#include "orbweaver/starts/fixed_points.hpp"
#include "orbweaver/survey/tree/naming.hpp"

namespace orbweaver::survey {

EquilibriumEnd equilibrium_end(const scene::Scene& scene, const systems::System& system, const loop::Loop& last) {
  const std::span<const double> mean(last.modes.data(), static_cast<std::size_t>(last.dimension));
  const auto point = starts::fixed_point_near(system, mean, loop::rms_amplitude(last));
  if (!point) return {-1, fmt::format("no equilibrium found near {}", point_text(system, {mean.begin(), mean.end()}))};
  const std::string place = point_text(system, *point);
  const auto known = starts::find_fixed_points(system, scene.fixed_points.grid);
  for (std::size_t n = 0; n < known.size(); ++n)
    if (starts::is_same_fixed_point(known[n], *point))
      return {static_cast<int>(n), fmt::format("{}, {}", equilibrium_name(static_cast<int>(n)), place)};
  return {-1, fmt::format("{}, an equilibrium that starts.fixed_points.grid does not lead to", place)};
}

}  // namespace orbweaver::survey
