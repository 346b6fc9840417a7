#include "plot/figure.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "gnuplot.hpp"
#include "plot/label_places.hpp"

namespace orbweaver::report {

namespace {

constexpr double padding = 0.04;          // of a range, beyond its points
constexpr double points_an_inch = 72.0;   // of type
constexpr double inch = 2.54;             // cm
constexpr double dots_an_inch = 300.0;    // of bitmaps for print
constexpr double screen_dots = 96.0;      // an inch of SVG
constexpr double character_width = 0.58;  // of a sans serif in parts of its size, on average
constexpr double character_height = 1.25;

using Range = std::pair<double, double>;

/// cm and pt.
struct Page {
  double width;
  double height;
  double font;
  double line;  ///< width, in parts of gnuplot's
  double mark;  ///< size of points, in parts of gnuplot's
};

Page page_of(PlotStyle style) {
  switch (style) {
    case PlotStyle::paper: return {8.6, 6.8, 8.0, 1.0, 1.0};
    case PlotStyle::wide: return {17.8, 9.5, 8.0, 1.0, 1.0};
    case PlotStyle::slide: break;
  }
  return {25.4, 14.3, 18.0, 2.0, 2.2};
}

/// A slide has a title; a paper a caption.
bool is_for_paper(PlotStyle style) { return style != PlotStyle::slide; }

constexpr double tic_characters = 6.5;  // room for a number along an axis
constexpr double lines_a_tic = 2.2;
constexpr double line_of_legend = 0.35;    // cm, of a paper
constexpr double lower_with_panels = 1.6;  // cm, of a paper: two frames beside each other are lower

constexpr double small_letters = 0.85;  // names and legends, beside the numbers of the axes
constexpr double sample_characters = 6.0;

/// How many lines the legend takes, in columns as wide as its longest entry.
double lines_of_legend(const std::vector<Figure>& panels, const Page& page) {
  std::size_t entries = 0;
  std::size_t longest = 0;
  for (const Series& series : panels.front().series) {
    if (series.key.empty()) continue;
    ++entries;
    longest = std::max(longest, characters_of(series.key));
  }
  if (entries == 0) return 0.0;
  const double character = small_letters * character_width * page.font / points_an_inch * inch;
  const double columns = std::floor(page.width / (character * (static_cast<double>(longest) + sample_characters)));
  return std::ceil(static_cast<double>(entries) / std::max(1.0, columns));
}

/// cm.
struct Extent {
  double width;
  double height;
};

/// About what is left for the frame of a panel: some four fifths of its width and three fifths of its height.
Extent frame_of(const Page& page, const Figure& figure, std::size_t panels, const Range& xs, const Range& ys) {
  Extent frame{0.78 * page.width / static_cast<double>(panels), 0.62 * page.height};
  if (!figure.equal_scales) return frame;
  const double shape = (xs.second - xs.first) / (ys.second - ys.first);
  return {std::min(frame.width, frame.height * shape), std::min(frame.height, frame.width / shape)};
}

std::string terminal_of(const Page& page, PlotFormat format, double dots) {
  const auto in_dots = [](double cm, double density) { return std::lround(cm / inch * density); };
  switch (format) {
    case PlotFormat::svg:
      return fmt::format("svg size {},{} fixed font 'sans,{:.3g}' linewidth {:.3g} background 'white'",
                         in_dots(page.width, screen_dots), in_dots(page.height, screen_dots),
                         page.font * screen_dots / points_an_inch, page.line);
    case PlotFormat::pdf:
      return fmt::format("pdfcairo size {}cm,{}cm font 'sans,{}' fontscale 1 linewidth {:.3g}", page.width, page.height,
                         page.font, page.line);
    case PlotFormat::png:
      // gnuplot takes a bitmap to have screen_dots an inch.
      return fmt::format("pngcairo size {},{} font 'sans,{:.3g}' linewidth {:.3g} pointscale {:.3g}",
                         in_dots(page.width, dots), in_dots(page.height, dots), page.font * dots / screen_dots,
                         page.line * dots / screen_dots, dots / screen_dots);
  }
  return {};
}

template <class Coordinate>
Range range_of(const Figure& figure, const Axis& axis, const Coordinate& coordinate) {
  if (axis.range) return {placed(axis.scale, axis.range->first), placed(axis.scale, axis.range->second)};
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (const Series& series : figure.series)
    for (const PlotPoint& point : series.points) {
      const double value = placed(axis.scale, coordinate(point));
      if (!std::isfinite(value)) continue;
      low = std::min(low, value);
      high = std::max(high, value);
    }
  if (low > high) return {0.0, 1.0};
  const double least = 1e-9 * std::max({std::abs(low), std::abs(high), 1e-300});
  const double more = high - low > least ? padding * (high - low) : std::max(0.5 * std::abs(low), 0.5);
  return {low - more, high + more};
}

std::string superscript(int exponent) {
  static const std::vector<std::string> digits{"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string text = exponent < 0 ? "⁻" : "";
  for (const char c : std::to_string(std::abs(exponent))) text += digits[static_cast<std::size_t>(c - '0')];
  return text;
}

std::string logarithmic_tics(const Range& range) {
  const int first = static_cast<int>(std::ceil(range.first));
  const int last = static_cast<int>(std::floor(range.second));
  std::vector<std::string> tics;
  constexpr int most = 7;
  const int every = std::max(1, (last - first + most) / most);
  for (int exponent = first; exponent <= last; ++exponent)
    if (exponent % every == 0) tics.push_back(fmt::format("'10{}' {}", superscript(exponent), exponent));
  if (tics.size() < 2) {
    tics.clear();
    for (int exponent = first - 1; exponent <= last + 1; ++exponent)
      for (const int digit : {1, 2, 5})
        tics.push_back(fmt::format("'{:g}' {:.17g}", digit * std::pow(10.0, exponent),
                                   exponent + std::log10(static_cast<double>(digit))));
  }
  return fmt::format("({})", fmt::join(tics, ", "));
}

std::string squeezed_tics(const Range& range) {
  std::vector<std::string> tics{"'0' 0"};
  const double most = std::max(std::abs(range.first), std::abs(range.second));
  const int decades = static_cast<int>(std::floor(std::log10(std::max(1.0, 2.0 * std::sinh(most)))));
  const int every = std::max(1, (decades + 2) / 3);
  const auto add = [&](const std::string& text, double value) {
    const double at = placed(Scale::squeezed, value);
    tics.push_back(fmt::format("'{}' {:.17g}", text, at));
    tics.push_back(fmt::format("'−{}' {:.17g}", text, -at));
  };
  constexpr double room = 0.08;  // of the axis, for the tics at 2 and -2 beside that at 0
  if (placed(Scale::squeezed, 2.0) > room * (range.second - range.first)) add("2", 2.0);
  for (int decade = 1; decade <= decades; ++decade)
    if (decade % every == 0 || (every == 1))
      add(decade == 1 ? std::string("10") : fmt::format("10{}", superscript(decade)), std::pow(10.0, decade));
  return fmt::format("({})", fmt::join(tics, ", "));
}

/// Multiples of 1, 2 or 5 times a power of ten, at most so many.
std::string linear_tics(const Range& range, double most) {
  const double least = (range.second - range.first) / std::max(2.0, most);
  const double power = std::pow(10.0, std::floor(std::log10(least)));
  for (const double digit : {1.0, 2.0, 5.0})
    if (digit * power >= least) return fmt::format("{:.10g}", digit * power);
  return fmt::format("{:.10g}", 10.0 * power);
}

std::string tics_of(char name, const Axis& axis, const Range& range, double most) {
  switch (axis.scale) {
    case Scale::linear: return fmt::format("set {}tics {}\n", name, linear_tics(range, most));
    case Scale::logarithmic: return fmt::format("set {}tics {}\n", name, logarithmic_tics(range));
    case Scale::squeezed: return fmt::format("set {}tics {}\n", name, squeezed_tics(range));
  }
  return {};
}

std::string look_of(const Series& series, const Page& page) {
  const std::string colour = fmt::format("linecolor rgb '{}'", series.colour);
  switch (series.look) {
    case Look::solid: return fmt::format("with lines {} linewidth {:.3g}", colour, 1.3 * series.size);
    case Look::dashed: return fmt::format("with lines {} linewidth {:.3g} dashtype (8,5)", colour, series.size);
    case Look::dotted: return fmt::format("with lines {} linewidth {:.3g} dashtype (1.5,3)", colour, series.size);
    case Look::thin: return fmt::format("with lines {} linewidth {:.3g}", colour, 0.5 * series.size);
    case Look::impulses: return fmt::format("with impulses {} linewidth {:.3g}", colour, series.size);
    case Look::dots:
      return fmt::format("with points {} pointtype 7 pointsize {:.3g}", colour, 0.2 * page.mark * series.size);
    case Look::marks:
      return fmt::format("with points {} pointtype {} pointsize {:.3g} linewidth 1", colour, series.mark,
                         0.55 * page.mark * series.size);
  }
  return {};
}

std::string data_of(const Figure& figure, std::size_t panel) {
  std::string text;
  for (std::size_t n = 0; n < figure.series.size(); ++n) {
    text += fmt::format("$data{}_{} << END\n", panel, n);
    bool is_broken = true;
    for (const PlotPoint& point : figure.series[n].points) {
      const double x = placed(figure.x.scale, point.x);
      const double y = placed(figure.y.scale, point.y);
      const bool breaks = !std::isfinite(x) || !std::isfinite(y);
      if (breaks && is_broken) continue;
      text += breaks ? "\n" : fmt::format("{:.10g} {:.10g}\n", x, y);
      is_broken = breaks;
    }
    text += "END\n";
  }
  return text;
}

constexpr double top_of_panels = 0.97;  // of the page
constexpr double top_below_title = 0.88;

/// Parts of the page that the legend of several panels takes.
double height_of_legend(const std::vector<Figure>& panels, const Page& page) {
  return lines_of_legend(panels, page) * character_height * page.font / points_an_inch * inch / page.height;
}

/// One legend and one title for several panels.
std::string side_by_side(const std::vector<Figure>& panels, const Page& page, PlotStyle style) {
  const std::string title = style == PlotStyle::slide
                                ? fmt::format(" title {} noenhanced", gnuplot_text(panels.front().title))
                                : std::string();
  return fmt::format("set key at screen 0.5,{:.4f} center top vertical maxrows {:.0f}\nset multiplot{}\n",
                     height_of_legend(panels, page) + 0.01, lines_of_legend(panels, page), title);
}

std::string place_of_panel(std::size_t n, const std::vector<Figure>& panels, const Page& page, PlotStyle style) {
  const double width = 1.0 / static_cast<double>(panels.size());
  const double em = page.font / points_an_inch * inch;
  const double line = character_height * em / page.height;
  const double room = (tic_characters + 3.0) * character_width * em / page.width;  // for numbers and a title
  return fmt::format(
      "set lmargin at screen {:.4f}\nset rmargin at screen {:.4f}\nset bmargin at screen {:.4f}\nset tmargin at screen "
      "{:.4f}\n{}",
      static_cast<double>(n) * width + room, (static_cast<double>(n) + 0.97) * width,
      height_of_legend(panels, page) + 3.6 * line, style == PlotStyle::slide ? top_below_title : top_of_panels,
      n == 0 ? "" : "unset key\n");
}

/// Curves and points of a figure in parts of its frame.
std::vector<PlotPoint> in_frame(const std::vector<PlotPoint>& points, const Figure& figure, const Range& xs,
                                const Range& ys) {
  std::vector<PlotPoint> inside;
  for (const PlotPoint& point : points) {
    const double u = (placed(figure.x.scale, point.x) - xs.first) / (xs.second - xs.first);
    const double v = (placed(figure.y.scale, point.y) - ys.first) / (ys.second - ys.first);
    if (u >= 0.0 && u <= 1.0 && v >= 0.0 && v <= 1.0) inside.push_back({u, v});
  }
  return inside;
}

/// `font`: its size in the terminal's unit.
std::string labels_of(const Figure& figure, const Page& page, const Extent& frame, double font, const Range& xs,
                      const Range& ys) {
  if (figure.named.empty()) return {};
  std::vector<NamedCurve> curves = figure.named;
  for (NamedCurve& curve : curves) curve.points = in_frame(curve.points, figure, xs, ys);
  std::vector<PlotPoint> others;
  for (const Series& series : figure.series)
    if (series.look == Look::marks) {
      const std::vector<PlotPoint> marks = in_frame(series.points, figure, xs, ys);
      others.insert(others.end(), marks.begin(), marks.end());
    }
  const double em = page.font / points_an_inch * inch;
  const CharacterSize size{small_letters * character_width * em / frame.width,
                           small_letters * character_height * em / frame.height};
  std::string text;
  for (const PlotLabel& label : label_places(curves, others, size))
    text += fmt::format("set label {} at graph {:.4f},{:.4f} left noenhanced font ',{:.3g}' textcolor rgb '{}' front\n",
                        gnuplot_text(label.text), label.u, label.v, small_letters * font, label.colour);
  return text;
}

}  // namespace

double placed(Scale scale, double value) {
  switch (scale) {
    case Scale::linear: return value;
    case Scale::logarithmic: return value > 0.0 ? std::log10(value) : std::numeric_limits<double>::quiet_NaN();
    case Scale::squeezed: return std::asinh(0.5 * value);
  }
  return value;
}

std::string figure_script(const std::vector<Figure>& panels, PlotStyle style, PlotFormat format,
                          const std::string& output) {
  Page page = page_of(style);
  const double lines = lines_of_legend(panels, page);
  if (is_for_paper(style)) page.height += line_of_legend * std::max(0.0, lines - 2.0);
  if (is_for_paper(style) && panels.size() > 1) page.height -= lower_with_panels;
  const double dots = is_for_paper(style) ? dots_an_inch : 1920.0 / (page.width / inch);
  double font = page.font;
  if (format == PlotFormat::svg) font *= screen_dots / points_an_inch;
  if (format == PlotFormat::png) font *= dots / screen_dots;
  std::string script;
  for (std::size_t n = 0; n < panels.size(); ++n) script += data_of(panels[n], n);
  script += fmt::format(
      "set terminal {} noenhanced\nset output {}\nset encoding utf8\nset border 15 linewidth 0.7\n"
      "set minussign\nset tics nomirror scale 0.6\nset xlabel offset 0,0.3\n"
      "set key below center reverse Left horizontal noenhanced samplen 1.5 width -1 height 0.4 font ',{:.3g}'\n",
      terminal_of(page, format, dots), gnuplot_text(output), small_letters * font);
  if (panels.size() > 1) script += side_by_side(panels, page, style);
  for (std::size_t n = 0; n < panels.size(); ++n) {
    const Figure& figure = panels[n];
    const Range xs = range_of(figure, figure.x, [](const PlotPoint& p) { return p.x; });
    const Range ys = range_of(figure, figure.y, [](const PlotPoint& p) { return p.y; });
    script += fmt::format("unset label\nset xrange [{:.10g}:{:.10g}]\nset yrange [{:.10g}:{:.10g}]\n", xs.first,
                          xs.second, ys.first, ys.second);
    const Extent frame = frame_of(page, figure, panels.size(), xs, ys);
    const double em = page.font / points_an_inch * inch;
    script += tics_of('x', figure.x, xs, frame.width / (tic_characters * character_width * em)) +
              tics_of('y', figure.y, ys, frame.height / (lines_a_tic * character_height * em));
    script += fmt::format("set xlabel {} noenhanced\nset ylabel {} noenhanced\n", gnuplot_text(figure.x.title),
                          gnuplot_text(figure.y.title));
    if (panels.size() > 1) script += place_of_panel(n, panels, page, style);
    if (panels.size() == 1 && style == PlotStyle::slide)
      script += fmt::format("set title {} noenhanced\n", gnuplot_text(figure.title));
    script += figure.equal_scales ? "set size ratio -1\n" : "set size noratio\n";
    script += labels_of(figure, page, frame, font, xs, ys);
    const char* before = "plot ";
    for (std::size_t k = 0; k < figure.series.size(); ++k) {
      const Series& series = figure.series[k];
      if (series.points.empty()) continue;
      script +=
          fmt::format("{}$data{}_{} using 1:2 {} {}", before, n, k, look_of(series, page),
                      series.key.empty() ? std::string("notitle") : fmt::format("title {}", gnuplot_text(series.key)));
      before = ", \\\n     ";
    }
    script += "\n";
  }
  if (panels.size() > 1) script += "unset multiplot\n";
  return script + "unset output\n";
}

}  // namespace orbweaver::report
