#include "grid/scattered_sums.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "orbweaver/loop/grid/fourier.hpp"
#include "orbweaver/numerics/two_pi.hpp"

namespace orbweaver::loop {

namespace {

using numerics::two_pi;

// Parameters taken together: what they need stays in the first cache while all harmonics are added.
constexpr std::size_t block = 32;

// Harmonics are turned on by one multiplication a parameter.
std::vector<double> one_by_one(int cutoff, std::size_t d, const double* modes, std::span<const double> s) {
  const std::size_t n = s.size();
  std::vector<double> out(d * n), values(d * block);
  double first_cosine[block] = {}, first_sine[block] = {}, cosine[block], sine[block];
  for (std::size_t first = 0; first < n; first += block) {
    const std::size_t count = std::min(block, n - first);
    for (std::size_t j = 0; j < count; ++j) {
      first_cosine[j] = std::cos(s[first + j]);
      first_sine[j] = std::sin(s[first + j]);
    }
    std::copy_n(first_cosine, block, cosine);
    std::copy_n(first_sine, block, sine);
    for (std::size_t i = 0; i < d; ++i) std::fill_n(values.data() + i * block, block, modes[i]);
    for (int k = 1; k <= cutoff; ++k) {
      const double* row = modes + (2 * static_cast<std::size_t>(k) - 1) * d;
      for (std::size_t i = 0; i < d; ++i) {
        const double a = row[i];
        const double b = row[d + i];
        double* z = values.data() + i * block;
        for (std::size_t j = 0; j < block; ++j) z[j] += a * cosine[j] + b * sine[j];
      }
      for (std::size_t j = 0; j < block; ++j) {
        const double next = cosine[j] * first_cosine[j] - sine[j] * first_sine[j];
        sine[j] = sine[j] * first_cosine[j] + cosine[j] * first_sine[j];
        cosine[j] = next;
      }
    }
    for (std::size_t i = 0; i < d; ++i) std::copy_n(values.data() + i * block, count, out.data() + i * n + first);
  }
  return out;
}

// The other way: on an even grid twice as fine as the harmonics need, and from there by the weights of a window w, the
// sum over its `taps` nearest nodes; each harmonic is divided by what the window makes of it. The window is Kaiser and
// Bessel's, I_0(beta sqrt(1 - z^2)) for |z| < 1, whose transform is known; with 16 nodes what it lets in of other
// harmonics is rounding (A. H. Barnett, J. Magland and L. af Klinteberg, SIAM J. Sci. Comput. 41, 2019, C479).
constexpr std::size_t taps = 16;
constexpr std::size_t half = taps / 2;
constexpr double beta = 0.75 * std::numbers::pi * taps;  // pi taps (1 - 1/(2 x 2)), for a grid twice as fine
constexpr std::size_t order = 20;                        // of the window's polynomials over one cell: to rounding

constexpr double rest_of_two_pi = 2.4492935982947064e-16;  // 2 pi less the double next to it

// The weights of the nodes as polynomials in u, -1 to 1 across a cell. The window is even, so that a node and its
// mirror image have the same even part and opposite odd ones.
class Window {
 public:
  static const Window& get() {
    static const Window window;
    return window;
  }

  void weigh(double u, double* weights) const {
    double even[half], odd[half];
    std::copy_n(_even[0].data(), half, even);
    std::copy_n(_odd[0].data(), half, odd);
    const double square = u * u;
    for (std::size_t n = 1; n < order / 2; ++n)
      for (std::size_t m = 0; m < half; ++m) {
        even[m] = even[m] * square + _even[n][m];
        odd[m] = odd[m] * square + _odd[n][m];
      }
    for (std::size_t m = 0; m < half; ++m) {
      weights[m] = even[m] + u * odd[m];
      weights[taps - 1 - m] = even[m] - u * odd[m];
    }
  }

  /// What becomes of harmonic k on `nodes` nodes, 1 at k = 0 but for rounding.
  static double share(int k, int nodes) {
    const double xi = std::numbers::pi * taps * k / nodes;
    const double root = std::sqrt(beta * beta - xi * xi);
    return std::exp(root - beta) * beta / root;  // sinh is exp/2 here
  }

 private:
  Window() {
    // sum of the weights: (taps/2) times the integral 2 sinh(beta)/beta, so that `share` is 1 at k = 0
    const double unit = taps * std::sinh(beta) / beta;
    for (std::size_t m = 0; m < half; ++m) {
      // Newton's divided differences through Chebyshev's points, expanded into powers of u.
      std::array<long double, order> points{}, values{}, powers{};
      for (std::size_t n = 0; n < order; ++n) {
        points[n] = std::cos(std::numbers::pi_v<long double> * (2 * n + 1) / (2 * order));
        // node m lies (m - taps/2 + 1) nodes from the cell's left end
        const long double z =
            (static_cast<long double>(m) - taps / 2.0L + 1.0L - 0.5L * (points[n] + 1.0L)) / (taps / 2.0L);
        values[n] = std::cyl_bessel_il(0.0L, beta * std::sqrt(std::max(0.0L, 1.0L - z * z))) / unit;
      }
      for (std::size_t step = 1; step < order; ++step)
        for (std::size_t n = order - 1; n >= step; --n)
          values[n] = (values[n] - values[n - 1]) / (points[n] - points[n - step]);
      for (std::size_t n = order; n-- > 0;) {  // powers <- powers (u - points[n]) + values[n]
        for (std::size_t p = order - 1; p > 0; --p) powers[p] = powers[p - 1] - points[n] * powers[p];
        powers[0] = values[n] - points[n] * powers[0];
      }
      for (std::size_t n = 0; n < order / 2; ++n) {  // highest power first
        _even[order / 2 - 1 - n][m] = static_cast<double>(powers[2 * n]);
        _odd[order / 2 - 1 - n][m] = static_cast<double>(powers[2 * n + 1]);
      }
    }
  }

  std::array<std::array<double, half>, order / 2> _even;
  std::array<std::array<double, half>, order / 2> _odd;
};

std::vector<double> by_transform(int cutoff, std::size_t d, const double* modes, std::span<const double> s) {
  const int nodes = FourierGrid::nodes_at_least(2 * (2 * cutoff + 1));
  const auto n = static_cast<std::size_t>(nodes);
  std::vector<double> raised(modes, modes + (2 * static_cast<std::size_t>(cutoff) + 1) * d);
  for (int k = 1; k <= cutoff; ++k) {
    const double share = Window::share(k, nodes);
    double* row = raised.data() + (2 * static_cast<std::size_t>(k) - 1) * d;
    for (std::size_t i = 0; i < 2 * d; ++i) row[i] /= share;
  }
  std::vector<double> nodal(d * n);
  FourierGrid::of_size(nodes).synthesize(cutoff, static_cast<int>(d), raised.data(), nodal.data());
  // A period with the nodes before it and behind it that windows reach.
  const std::size_t stride = n + taps;
  std::vector<double> around(d * stride);
  constexpr std::size_t before = taps / 2 - 1;
  for (std::size_t i = 0; i < d; ++i) {
    double* row = around.data() + i * stride;
    std::copy_n(nodal.data() + i * n, n, row + before);
    std::copy_n(nodal.data() + (i + 1) * n - before, before, row);
    std::copy_n(nodal.data() + i * n, taps - before, row + before + n);
  }
  const Window& window = Window::get();
  std::vector<double> out(d * s.size());
  double weights[taps];
  const double spacing = two_pi / nodes;
  const double left_out = rest_of_two_pi / nodes - std::fma(spacing, nodes, -two_pi) / nodes;  // 2 pi/nodes - spacing
  for (std::size_t j = 0; j < s.size(); ++j) {
    // Parameters keep all their digits: what a node's place loses counts k times in harmonic k.
    const double turns = std::floor(s[j] / two_pi);
    const double reduced = std::fma(-turns, two_pi, s[j]) - turns * rest_of_two_pi;
    const double cell = std::clamp(std::floor(reduced / spacing), 0.0, nodes - 1.0);
    const double within = std::fma(-cell, spacing, reduced) - cell * left_out;
    window.weigh(2.0 * within / spacing - 1.0, weights);
    for (std::size_t i = 0; i < d; ++i) {
      const double* z = around.data() + i * stride + static_cast<std::size_t>(cell);
      double sum[4] = {};
      for (std::size_t m = 0; m < taps; m += 4)
        for (std::size_t l = 0; l < 4; ++l) sum[l] += weights[m + l] * z[m + l];
      out[i * s.size() + j] = (sum[0] + sum[1]) + (sum[2] + sum[3]);
    }
  }
  return out;
}

// Where the transform pays. Measured for four coordinates: one by one 0.5 ns a harmonic and parameter, by the transform
// 35 ns a parameter and 160 ns a harmonic.
constexpr int cutoff_by_transform = 96;
constexpr std::size_t parameters_by_transform = 80;  // a coordinate

}  // namespace

std::vector<double> scattered_sums(int cutoff, int dimension, const double* modes, std::span<const double> s) {
  const auto d = static_cast<std::size_t>(dimension);
  return cutoff < cutoff_by_transform || s.size() < d * parameters_by_transform ? one_by_one(cutoff, d, modes, s)
                                                                                : by_transform(cutoff, d, modes, s);
}

}  // namespace orbweaver::loop
