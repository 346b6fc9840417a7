#pragma once

#include <cstddef>
#include <vector>

#include "plot/figure.hpp"

namespace orbweaver::report {

/// Characters of a name in a picture; what is longer is cut.
inline constexpr std::size_t longest_plot_name = 24;

/// Of a text in UTF-8.
[[nodiscard]] std::size_t characters_of(const std::string& text);

/// A character's size in parts of the frame.
struct CharacterSize {
  double width;
  double height;
};

/// Places for the names of curves, in parts of the frame: near their ends, else along them, where a name covers no
/// other name and few points of curves. What finds no place is left out; curves without a name are only not to be
/// covered. `curves`: in parts of the frame. Deterministic.
[[nodiscard]] std::vector<PlotLabel> label_places(const std::vector<NamedCurve>& curves,
                                                  const std::vector<PlotPoint>& others, CharacterSize size);

}  // namespace orbweaver::report
