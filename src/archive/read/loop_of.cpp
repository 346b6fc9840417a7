#include "orbweaver/archive/read/loop_of.hpp"

#include <cmath>

#include <fmt/format.h>

#include "orbweaver/core/error.hpp"

namespace orbweaver::archive {

loop::Loop loop_of(const Archive& atlas, std::size_t orbit, const std::vector<int>& angles) {
  const Header& header = atlas.header();
  core::require(orbit < atlas.orbits().rows(), "the archive has no such orbit");
  core::require(angles.size() == header.winding_names.size(),
                "an archive's loop needs one coordinate a winding number");
  loop::Loop loop;
  loop.dimension = static_cast<int>(header.state_names.size());
  loop.cutoff = static_cast<int>(atlas.orbits().integers("cutoff")[orbit]);
  loop.period = atlas.orbits().reals("period")[orbit];
  loop.modes = atlas.modes(orbit);
  loop.winding.assign(header.state_names.size(), 0.0);
  for (std::size_t n = 0; n < angles.size(); ++n)
    loop.winding.at(static_cast<std::size_t>(angles[n])) = atlas.orbits().reals("winding")[orbit * angles.size() + n];
  if (const double parameter = atlas.orbits().reals("parameter")[orbit]; !std::isnan(parameter))
    loop.parameters = {parameter};
  try {
    loop.time_map = loop::time_map_of(atlas.time_map(orbit));
    loop::validate(loop);
  } catch (const core::MisuseError& error) {
    throw core::InputError(fmt::format("row {} of /orbits of {} holds no loop: {}; was the file changed?", orbit,
                                       atlas.path().string(), error.what()));
  }
  return loop;
}

loop::Loop loop_of(const Archive& atlas, std::size_t orbit) {
  const Header& header = atlas.header();
  if (header.winding_coordinates.size() != header.winding_names.size())
    throw core::InputError(fmt::format(
        "{} does not say which coordinates wind: it is of format_minor {}, before 11. Give them from its system",
        atlas.path().string(), atlas.format_minor()));
  return loop_of(atlas, orbit, header.winding_coordinates);
}

}  // namespace orbweaver::archive
