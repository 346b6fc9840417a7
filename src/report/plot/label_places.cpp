#include "plot/label_places.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "text_grid.hpp"

namespace orbweaver::report {

namespace {

constexpr long most_covered = 3;  // points of curves below a name
constexpr std::array<double, 9> places_along{1.0, 0.0, 0.85, 0.7, 0.55, 0.4, 0.25, 0.95, 0.1};

struct Box {
  double left, low, right, high;

  /// Nearer than `gap` beside each other, or at one place.
  [[nodiscard]] bool meets(const Box& other, double gap) const {
    return left < other.right + gap && other.left < right + gap && low < other.high && other.low < high;
  }
  [[nodiscard]] bool holds(const PlotPoint& p) const { return p.x > left && p.x < right && p.y > low && p.y < high; }
  [[nodiscard]] bool is_inside() const { return left >= 0.0 && low >= 0.0 && right <= 1.0 && high <= 1.0; }
};

/// Boxes beside a point: right, left, above, below, and the four corners.
std::array<Box, 8> boxes_at(const PlotPoint& p, double width, const CharacterSize& size) {
  const double gap = 0.6 * size.width;
  const double half = 0.5 * size.height;
  const auto from = [&](double left, double middle) { return Box{left, middle - half, left + width, middle + half}; };
  const double right = p.x + gap;
  const double left = p.x - gap - width;
  const double centre = p.x - 0.5 * width;
  const double above = p.y + 1.1 * size.height;
  const double below = p.y - 1.1 * size.height;
  return {from(right, p.y),   from(left, p.y),   from(centre, above), from(centre, below),
          from(right, above), from(left, above), from(right, below),  from(left, below)};
}

}  // namespace

std::size_t characters_of(const std::string& text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
}

std::vector<PlotLabel> label_places(const std::vector<NamedCurve>& curves, const std::vector<PlotPoint>& others,
                                    CharacterSize size) {
  std::vector<PlotPoint> all = others;
  for (const NamedCurve& curve : curves) all.insert(all.end(), curve.points.begin(), curve.points.end());
  std::vector<Box> taken;
  std::vector<PlotLabel> labels;
  for (const NamedCurve& curve : curves) {
    if (curve.points.empty() || curve.name.empty()) continue;
    const std::string name = cut(curve.name, longest_plot_name);
    const double width = static_cast<double>(characters_of(name)) * size.width;
    std::optional<Box> best;
    long least = most_covered + 1;
    for (const double along : places_along) {
      const auto at = static_cast<std::size_t>(std::lround(along * static_cast<double>(curve.points.size() - 1)));
      for (const Box& box : boxes_at(curve.points[at], width, size)) {
        if (!box.is_inside() ||
            std::any_of(taken.begin(), taken.end(), [&](const Box& b) { return b.meets(box, size.width); }))
          continue;
        const long covered = std::count_if(all.begin(), all.end(), [&](const PlotPoint& p) { return box.holds(p); });
        if (covered < least) {
          least = covered;
          best = box;
        }
      }
      if (least == 0) break;
    }
    if (!best) continue;
    taken.push_back(*best);
    labels.push_back({name, curve.colour, best->left, 0.5 * (best->low + best->high)});
  }
  return labels;
}

}  // namespace orbweaver::report
