#pragma once

#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "orbweaver/report/plot/plot.hpp"

namespace orbweaver::report {

constexpr double no_value = std::numeric_limits<double>::quiet_NaN();

/// In the axes' coordinates; no_value: the line is broken.
struct PlotPoint {
  double x;
  double y;
};

enum class Look { solid, dashed, dotted, thin, impulses, dots, marks };

/// Colour of what belongs to no family.
constexpr const char* ink = "#000000";
/// Colour of what is there for comparison.
constexpr const char* soft = "#888888";

/// One entry of a picture.
struct Series {
  std::string key;  ///< in the legend; empty: not there
  Look look = Look::solid;
  std::string colour;  ///< "#0072B2"
  std::vector<PlotPoint> points;
  int mark = 7;       ///< gnuplot's point type
  double size = 1.0;  ///< of marks; of lines their width
};

/// How numbers lie along an axis. The picture has them transformed: gnuplot draws linear axes with our tics.
enum class Scale { linear, logarithmic, squeezed };

struct Axis {
  std::string title;
  Scale scale = Scale::linear;
  std::optional<std::pair<double, double>> range{};  ///< none: that of the points, and a little more
};

/// Text at a place of the frame, from 0 to 1.
struct PlotLabel {
  std::string text;
  std::string colour;
  double u;
  double v;
};

/// A curve that wants its name beside it.
struct NamedCurve {
  std::string name;
  std::string colour;
  std::vector<PlotPoint> points;
};

struct Figure {
  std::string title;  ///< of a slide; a paper has a caption
  Axis x;
  Axis y;
  bool equal_scales = false;
  std::vector<Series> series{};
  std::vector<NamedCurve> named{};  ///< the first have the first choice of places; without a name: not to be covered
};

/// A number as the axis has it. NaN where it has no place there.
[[nodiscard]] double placed(Scale scale, double value);

/// gnuplot's script for panels side by side; the legend is that of all.
[[nodiscard]] std::string figure_script(const std::vector<Figure>& panels, PlotStyle style, PlotFormat format,
                                        const std::string& output);

}  // namespace orbweaver::report
