#include "stability_line.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <optional>

namespace orbweaver::report {

namespace {

/// Of the largest multiplier's decimal logarithm, between the heights of unstable orbits.
constexpr std::array steps{0.25, 0.5, 1.0, 2.0, 3.0, 4.0};
constexpr std::array blocks{"\u2581", "\u2582", "\u2583", "\u2584", "\u2585", "\u2586", "\u2587", "\u2588"};
constexpr std::array plain_signs{"_", ".", ":", "-", "=", "+", "*", "#"};
static_assert(blocks.size() == steps.size() + 2 && plain_signs.size() == blocks.size());

std::optional<std::size_t> height_of(const OrbitStability& stability, std::size_t orbit) {
  const std::optional<bool> is_stable = stability.of(orbit);
  if (!is_stable) return std::nullopt;
  if (*is_stable) return 0;
  const double growth = stability.log10_growth(orbit);
  return 1 +
         static_cast<std::size_t>(std::distance(steps.begin(), std::upper_bound(steps.begin(), steps.end(), growth)));
}

}  // namespace

std::string stability_line(const archive::Archive& atlas, const OrbitStability& stability, std::size_t family,
                           std::size_t cells, bool unicode) {
  const auto first = static_cast<std::size_t>(atlas.families().integers("first_orbit")[family]);
  const auto count = static_cast<std::size_t>(atlas.families().integers("orbit_count")[family]);
  const std::size_t pieces = std::min(cells, count);
  std::string line;
  bool any = false;
  for (std::size_t piece = 0; piece < pieces; ++piece) {
    std::optional<std::size_t> height;
    for (std::size_t orbit = first + piece * count / pieces; orbit < first + (piece + 1) * count / pieces; ++orbit)
      if (const auto here = height_of(stability, orbit); here && (!height || *here > *height)) height = here;
    any = any || height.has_value();
    line += height ? (unicode ? blocks : plain_signs)[*height] : "?";
  }
  return any ? line : "";
}

}  // namespace orbweaver::report
