#include "orbweaver/loop/symmetry/shift_search.hpp"

#include <algorithm>
#include <cmath>

#include "orbweaver/core/error.hpp"
#include "orbweaver/loop/curve/measures.hpp"
#include "orbweaver/loop/grid/fourier.hpp"
#include "orbweaver/numerics/two_pi.hpp"

namespace orbweaver::loop {

namespace {

using numerics::two_pi;

constexpr double settled = 1e-15;   // a step in the shift that no longer changes it
constexpr int most_steps = 30;      // of Newton's method from a grid finer than the harmonics: it needs three or four
constexpr double deep_share = 0.1;  // of the range of D^2: shallower minima are no candidates for the closest
constexpr double largest_move = 0.05;  // of a period: how far the minimum near a given shift may lie

// D^2 as a function of theta = 2 pi psi with its first two derivatives.
class Correlation {
 public:
  Correlation(const Loop& y, const Loop& x, const std::vector<int>& angles)
      : _cutoff(std::min(y.cutoff, x.cutoff)), _modes(2 * static_cast<std::size_t>(_cutoff) + 1, 0.0) {
    core::require(y.dimension == x.dimension, "loops of different dimension cannot be aligned");
    for (int i = 0; i < y.dimension; ++i) {
      _gap.push_back(y.cosine(0, i) - x.cosine(0, i));
      _winding.push_back(y.winding[static_cast<std::size_t>(i)]);
      _is_angle.push_back(std::find(angles.begin(), angles.end(), i) != angles.end());
      for (int k = 1; k <= _cutoff; ++k) {
        const auto row = 2 * static_cast<std::size_t>(k);
        _modes[row - 1] += y.cosine(k, i) * x.cosine(k, i) + y.sine(k, i) * x.sine(k, i);
        _modes[row] += y.sine(k, i) * x.cosine(k, i) - y.cosine(k, i) * x.sine(k, i);
      }
    }
    _squares = std::pow(rms_amplitude(y), 2) + std::pow(rms_amplitude(x), 2);
  }

  [[nodiscard]] std::vector<double> at_nodes(int nodes) const {
    std::vector<double> out(static_cast<std::size_t>(nodes));
    FourierGrid::of_size(nodes).synthesize(_cutoff, 1, _modes.data(), out.data());
    for (std::size_t j = 0; j < out.size(); ++j)
      out[j] = _squares - out[j] + means(two_pi * static_cast<double>(j) / nodes);
    return out;
  }

  struct Values {
    double value;
    double slope;
    double curvature;
  };
  [[nodiscard]] Values at(double theta) const {
    Values out{_squares + means(theta), 0.0, 0.0};
    for (std::size_t i = 0; i < _gap.size(); ++i) {
      out.slope += 2.0 * _winding[i] * gap_at(i, theta);
      out.curvature += 2.0 * _winding[i] * _winding[i];
    }
    const double first_cosine = std::cos(theta);
    const double first_sine = std::sin(theta);
    double c = 1.0;
    double s = 0.0;
    for (int k = 1; k <= _cutoff; ++k) {
      const double next = c * first_cosine - s * first_sine;
      s = s * first_cosine + c * first_sine;
      c = next;
      const double even = _modes[2 * static_cast<std::size_t>(k) - 1];
      const double odd = _modes[2 * static_cast<std::size_t>(k)];
      out.value -= even * c + odd * s;
      out.slope += k * (even * s - odd * c);
      out.curvature += k * k * (even * c + odd * s);
    }
    return out;
  }

  [[nodiscard]] int cutoff() const { return _cutoff; }

 private:
  [[nodiscard]] double gap_at(std::size_t i, double theta) const {
    const double gap = _gap[i] + _winding[i] * theta;
    return _is_angle[i] ? gap - two_pi * std::round(gap / two_pi) : gap;
  }
  [[nodiscard]] double means(double theta) const {
    double sum = 0.0;
    for (std::size_t i = 0; i < _gap.size(); ++i) sum += gap_at(i, theta) * gap_at(i, theta);
    return sum;
  }

  int _cutoff;
  std::vector<double> _modes;
  std::vector<double> _gap;
  std::vector<double> _winding;
  std::vector<bool> _is_angle;
  double _squares = 0.0;
};

// `reach`: how far the minimum may be from `theta`. Without curvature there is nothing to refine.
ShiftMinimum refined(const Correlation& correlation, double theta, double reach) {
  const double low = theta - reach;
  const double high = theta + reach;
  Correlation::Values here = correlation.at(theta);
  for (int n = 0; n < most_steps && here.curvature != 0.0; ++n) {
    // Against the slope even where the minimum's curvature is not reached yet.
    const double next = std::clamp(theta - here.slope / std::abs(here.curvature), low, high);
    const double step = std::abs(next - theta);
    theta = next;
    here = correlation.at(theta);
    if (step < settled) break;
  }
  return {theta / two_pi, std::max(0.0, here.value)};
}

}  // namespace

std::vector<ShiftMinimum> shift_minima(const Loop& y, const Loop& x, const std::vector<int>& angles) {
  const Correlation correlation(y, x, angles);
  const int nodes = FourierGrid::nodes_at_least(std::max(240, 4 * correlation.cutoff() + 2));
  const std::vector<double> coarse = correlation.at_nodes(nodes);
  const auto n = coarse.size();
  const auto lowest = static_cast<std::size_t>(std::min_element(coarse.begin(), coarse.end()) - coarse.begin());
  const double highest = *std::max_element(coarse.begin(), coarse.end());
  std::vector<ShiftMinimum> minima;
  for (std::size_t j = 0; j < n; ++j) {
    const bool is_minimum = coarse[j] <= coarse[(j + n - 1) % n] && coarse[j] < coarse[(j + 1) % n];
    const bool is_deep = coarse[j] <= coarse[lowest] + deep_share * (highest - coarse[lowest]);
    if (j == lowest || (is_minimum && is_deep))
      minima.push_back(refined(correlation, two_pi * static_cast<double>(j) / nodes, two_pi / nodes));
  }
  std::stable_sort(minima.begin(), minima.end(),
                   [](const ShiftMinimum& a, const ShiftMinimum& b) { return a.square < b.square; });
  return minima;
}

ShiftMinimum shift_minimum_near(const Loop& y, const Loop& x, const std::vector<int>& angles, double shift) {
  return refined(Correlation(y, x, angles), two_pi * shift, largest_move * two_pi);
}

Loop difference_at(const Loop& y, const Loop& x, const std::vector<int>& angles, double shift,
                   std::vector<double>* turns) {
  Loop out = with_cutoff(parameter_shifted(y, shift), std::max(y.cutoff, x.cutoff));
  for (std::size_t n = 0; n < x.modes.size(); ++n) out.modes[n] -= x.modes[n];
  std::fill(out.winding.begin(), out.winding.end(), 0.0);
  if (turns != nullptr) turns->assign(out.winding.size(), 0.0);
  for (const int i : angles) {
    const double whole = -std::round(out.cosine(0, i) / two_pi);
    out.cosine(0, i) += two_pi * whole;
    if (turns != nullptr) (*turns)[static_cast<std::size_t>(i)] = whole;
  }
  return out;
}

}  // namespace orbweaver::loop
