#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "orbweaver/archive/read/reader.hpp"
#include "orbweaver/loop/curve/loop.hpp"
#include "plot/figure.hpp"

namespace orbweaver::report {

// What pictures of orbits share: which orbit is asked for, and its path in a plane of two coordinates.

/// Orbits along a family, in one picture.
inline constexpr std::size_t orbits_shown = 5;
/// From dark to light, even to the eye and to those who see few colours (viridis).
inline constexpr std::array<const char*, orbits_shown> steps_of_colour{"#440154", "#3b528b", "#21918c", "#5ec962",
                                                                       "#e0c020"};

/// Rows of /families and /orbits.
struct OrbitChoice {
  std::size_t family;
  std::size_t orbit;
};
/// The one family that is asked for. Throws InputError where it is none or has no orbits.
[[nodiscard]] std::size_t chosen_family(const archive::Archive& atlas, const PlotRequest& request);
/// The step that was asked for, else the one in the middle of the family.
[[nodiscard]] OrbitChoice chosen_orbit(const archive::Archive& atlas, const PlotRequest& request);
/// Orbits of a family, evenly chosen by their steps: the first and the last among them.
[[nodiscard]] std::vector<std::size_t> orbits_along(const archive::Archive& atlas, std::size_t family);

/// What tells an orbit from the others of its family, in short.
[[nodiscard]] std::string short_text(const archive::Archive& atlas, std::size_t orbit);
[[nodiscard]] std::string title_of(const archive::Archive& atlas, std::size_t family);

/// Two coordinates.
using Plane = std::pair<std::size_t, std::size_t>;
/// Planes for the panels: of the first two coordinates; of three the first with each other.
[[nodiscard]] std::vector<Plane> planes_of(const archive::Header& header);
/// An angle within half a turn of 0.
[[nodiscard]] double turned_back(double angle);
/// A path in a plane; angles that turn over come back at the other side.
[[nodiscard]] std::vector<PlotPoint> path_of(const loop::Loop& loop, Plane plane);
/// Two coordinates as axes, of one scale where both are lengths or both angles.
[[nodiscard]] Figure empty_panel(const archive::Archive& atlas, std::size_t family, Plane plane);
/// Equilibria, and the bodies of a restricted problem, where they lie in the picture. In the legend with `keys`.
void add_fixed_places(Figure& figure, const archive::Archive& atlas, Plane plane, bool keys);

}  // namespace orbweaver::report
