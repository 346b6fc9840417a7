#include "family_row.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "orbweaver/core/command_line.hpp"

namespace orbweaver::report {

std::size_t family_row(const archive::Archive& atlas, const std::string& name) {
  const std::vector<std::string>& names = atlas.families().texts("name");
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end())
    throw core::InputError(fmt::format("no family `{}` in {}: `{}` lists them", name, atlas.path().string(),
                                       core::command_line({"show", atlas.path().string(), "families"})));
  return static_cast<std::size_t>(found - names.begin());
}

OrbitRange orbits_of(const archive::Archive& atlas, std::size_t family) {
  const auto count =
      static_cast<std::size_t>(std::max<std::int64_t>(0, atlas.families().integers("orbit_count")[family]));
  if (count == 0) return {};
  return {static_cast<std::size_t>(atlas.families().integers("first_orbit")[family]), count};
}

std::size_t orbit_row(const archive::Archive& atlas, std::size_t family, int step) {
  const auto [first, count] = orbits_of(atlas, family);
  const std::string& name = atlas.families().texts("name")[family];
  if (count == 0) throw core::InputError(fmt::format("{} has no orbits", name));
  const std::vector<std::int64_t>& steps = atlas.orbits().integers("step");
  const auto begin = steps.begin() + static_cast<std::ptrdiff_t>(first);
  const auto end = begin + static_cast<std::ptrdiff_t>(count);
  const auto found = std::find(begin, end, step);
  if (found == end)
    throw core::InputError(fmt::format("{} has the steps {} to {}, and no step {}", name, *begin, *(end - 1), step));
  return static_cast<std::size_t>(found - steps.begin());
}

}  // namespace orbweaver::report
