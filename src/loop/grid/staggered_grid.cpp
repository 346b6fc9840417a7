#include "orbweaver/loop/grid/staggered_grid.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>

#include <fftw3.h>

#include "folded_filters.hpp"
#include "grid/known_plans.hpp"
#include "grid/long_transform.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/core/interruption.hpp"

namespace orbweaver::loop {

namespace {

/// Dense filters are faster up to 96 cells, times sqrt(copies) (measured: docs/performance.md).
constexpr int most_dense_cells = 96;
/// Entries of symmetry matrices: exact up to products of a few rounded sines and cosines.
constexpr double same_entry = 1e-12;
/// Nodal arrays are padded to whole vector registers of four doubles.
constexpr int padding = 4;

bool matrices_are_faster(int cells, int copies) {
  return std::int64_t{cells} * cells <= std::int64_t{most_dense_cells} * most_dense_cells * copies;
}

bool is_diagonal_of_signs(const Eigen::MatrixXd& matrix) {
  return matrix.isDiagonal(same_entry) && (matrix.diagonal().cwiseAbs().array() - 1.0).abs().maxCoeff() < same_entry;
}

int padded(int count) { return (count + padding - 1) / padding * padding; }

}  // namespace

struct StaggeredGrid::Transforms {
  int nodes;
  int dimension;
  double* real;
  fftw_complex* complex;
  fftw_plan forward;
  fftw_plan backward;

  Transforms(int n, int d) : nodes(n), dimension(d) {
    const int half = n / 2 + 1;
    real = fftw_alloc_real(static_cast<std::size_t>(n) * static_cast<std::size_t>(d));
    complex = fftw_alloc_complex(static_cast<std::size_t>(half) * static_cast<std::size_t>(d));
    recall_plans(n);
    forward = fftw_plan_many_dft_r2c(1, &nodes, d, real, nullptr, 1, n, complex, nullptr, 1, half, FFTW_ESTIMATE);
    backward = fftw_plan_many_dft_c2r(1, &nodes, d, complex, nullptr, 1, half, real, nullptr, 1, n, FFTW_ESTIMATE);
  }
  ~Transforms() {
    fftw_destroy_plan(forward);
    fftw_destroy_plan(backward);
    fftw_free(real);
    fftw_free(complex);
  }
  Transforms(const Transforms&) = delete;
  Transforms& operator=(const Transforms&) = delete;
};

StaggeredGrid::StaggeredGrid(const FundamentalDomain& domain, int cells)
    : _domain(domain), _cells(cells), _stride(padded(cells + 1)) {
  core::require(cells >= 2, "a staggered grid needs at least two cells");
  const Eigen::Index d = domain.generator.rows();
  _images.resize(static_cast<std::size_t>(nodes()));
  Eigen::MatrixXd power = Eigen::MatrixXd::Identity(d, d);
  const int turn = nodes() / domain.order;
  for (int r = 0; r < domain.order; ++r) {
    _elements.push_back(power);
    const int direct = static_cast<int>(_elements.size()) - 1;
    if (domain.reversor) _elements.push_back(power * *domain.reversor);
    const int first = domain.reversor ? 1 - cells : 0;
    const int last = domain.reversor ? cells : cells - 1;
    for (int l = first; l <= last; ++l)
      _images[static_cast<std::size_t>((r * turn + l + nodes()) % nodes())] = {std::abs(l), direct + (l < 0 ? 1 : 0)};
    power = domain.generator * power;
  }
  for (int k = 0; k <= cutoff(); ++k) {
    const double x = std::numbers::pi * k / nodes();
    _unfilter.push_back(k == 0 ? 1.0 : x / std::sin(x));
  }
  for (int k = 0; 2 * k <= nodes(); ++k) {
    const double x = std::numbers::pi * k / nodes();
    const double weight = 2 * k >= nodes() ? 0.0 : (k == 0 ? 1.0 : std::sin(x) / x) / nodes();
    _midpoint_real.push_back(weight * std::cos(x));
    _midpoint_imaginary.push_back(weight * std::sin(x));
    _node.push_back(weight);
    _slope.push_back(weight * k);
    _zero.push_back(0.0);
  }
  _diagonal = std::all_of(_elements.begin(), _elements.end(), is_diagonal_of_signs);
  if (_diagonal && matrices_are_faster(cells, domain.copies()))
    _filters = std::make_unique<FoldedFilters>(domain, cells, _stride);
  else
    _transforms = std::make_unique<Transforms>(nodes(), dimension());
}

StaggeredGrid::~StaggeredGrid() = default;

const StaggeredGrid& StaggeredGrid::shared(const FundamentalDomain& domain, int cells) {
  static std::map<std::vector<double>, std::unique_ptr<StaggeredGrid>> grids;
  std::vector<double> key{static_cast<double>(cells), static_cast<double>(domain.order)};
  key.insert(key.end(), domain.generator.data(), domain.generator.data() + domain.generator.size());
  if (domain.reversor)
    key.insert(key.end(), domain.reversor->data(), domain.reversor->data() + domain.reversor->size());
  std::unique_ptr<StaggeredGrid>& grid = grids[key];
  if (!grid) grid = std::make_unique<StaggeredGrid>(domain, cells);
  return *grid;
}

double StaggeredGrid::spacing() const { return 2.0 * std::numbers::pi / nodes(); }

void StaggeredGrid::expand(const double* y, double* full) const {
  const int n = nodes();
  const int d = dimension();
  if (_diagonal) {
    const int turn = n / _domain.order;
    const int last = _domain.reversor ? _cells : _cells - 1;
    for (int i = 0; i < d; ++i) {
      const double* from = y + i * _stride;
      double* to = full + i * n;
      double sign = 1.0;
      for (int r = 0; r < _domain.order; ++r) {
        for (int j = 0; j <= last; ++j) to[r * turn + j] = sign * from[j];
        if (_domain.reversor) {
          const double mirrored = sign * (*_domain.reversor)(i, i);
          for (int j = 1; j < _cells; ++j) to[(r == 0 ? n : r * turn) - j] = mirrored * from[j];
        }
        sign *= _domain.generator(i, i);
      }
    }
    return;
  }
  for (int q = 0; q < n; ++q) {
    const Image image = _images[static_cast<std::size_t>(q)];
    const Eigen::MatrixXd& g = _elements[static_cast<std::size_t>(image.element)];
    for (int i = 0; i < d; ++i) {
      double sum = 0.0;
      for (int l = 0; l < d; ++l) sum += g(i, l) * y[l * _stride + image.node];
      full[i * n + q] = sum;
    }
  }
}

void StaggeredGrid::apply_by_fft(const std::vector<double>& real, const std::vector<double>& imaginary, const double* y,
                                 double* out, int count, int out_stride) const {
  const int n = nodes();
  const int half = n / 2 + 1;
  if (n >= long_transform) core::interruption_point();
  expand(y, _transforms->real);
  fftw_execute(_transforms->forward);
  for (int i = 0; i < dimension(); ++i) {
    auto* c = reinterpret_cast<double*>(_transforms->complex + static_cast<std::ptrdiff_t>(i) * half);
    for (std::size_t k = 0; k < static_cast<std::size_t>(half); ++k) {
      const double a = c[2 * k];
      const double b = c[2 * k + 1];
      c[2 * k] = a * real[k] - b * imaginary[k];
      c[2 * k + 1] = a * imaginary[k] + b * real[k];
    }
  }
  fftw_execute(_transforms->backward);
  for (int i = 0; i < dimension(); ++i)
    for (int j = 0; j < count; ++j) out[i * out_stride + j] = _transforms->real[i * n + j % n];
}

void StaggeredGrid::to_midpoints(const double* y, double* z) const {
  if (_filters)
    _filters->to_midpoints(y, z);
  else
    apply_by_fft(_midpoint_real, _midpoint_imaginary, y, z, _cells, _cells);
}

void StaggeredGrid::at_nodes(const double* y, double* z, double* slope) const {
  if (_filters) {
    _filters->at_nodes(y, z, slope);
  } else {
    apply_by_fft(_node, _zero, y, z, _cells + 1, _stride);
    apply_by_fft(_zero, _slope, y, slope, _cells + 1, _stride);
  }
}

void StaggeredGrid::to_modes(const double* y, double* modes) const {
  const int d = dimension();
  std::fill_n(modes, static_cast<std::size_t>(2 * cutoff() + 1) * static_cast<std::size_t>(d), 0.0);
  if (_filters) {
    _filters->to_modes(y, modes);
    return;
  }
  const int n = nodes();
  const int half = n / 2 + 1;
  expand(y, _transforms->real);
  fftw_execute(_transforms->forward);
  for (int i = 0; i < d; ++i) {
    const fftw_complex* c = _transforms->complex + static_cast<std::ptrdiff_t>(i) * half;
    // What signs forbid is exactly 0, not rounding.
    const bool odd_turn = _diagonal && _domain.generator(i, i) < 0.0;
    const bool odd = _diagonal && _domain.reversor && (*_domain.reversor)(i, i) < 0.0;
    const bool even = _diagonal && _domain.reversor && !odd;
    if (!odd && !odd_turn) modes[i] = c[0][0] / n;
    for (int k = 1; k <= cutoff(); ++k) {
      if (_diagonal && k % _domain.order != (odd_turn ? _domain.order / 2 : 0)) continue;
      const double weight = 2.0 / (_unfilter[static_cast<std::size_t>(k)] * n);
      if (!odd) modes[(2 * k - 1) * d + i] = weight * c[k][0];
      if (!even) modes[2 * k * d + i] = -weight * c[k][1];
    }
  }
}

void StaggeredGrid::from_modes(int modes_cutoff, const double* modes, double* y) const {
  const int d = dimension();
  std::fill_n(y, static_cast<std::size_t>(_stride) * static_cast<std::size_t>(d), 0.0);
  const int highest = std::min(modes_cutoff, cutoff());
  if (_filters) {
    _filters->from_modes(highest, modes, y);
    return;
  }
  const int n = nodes();
  const int half = n / 2 + 1;
  for (int i = 0; i < d; ++i) {
    auto* c = reinterpret_cast<double*>(_transforms->complex + static_cast<std::ptrdiff_t>(i) * half);
    std::fill_n(c, 2 * static_cast<std::size_t>(half), 0.0);
    c[0] = modes[i];
    for (int k = 1; k <= highest; ++k) {
      const double scale = 0.5 * _unfilter[static_cast<std::size_t>(k)];
      c[2 * k] = scale * modes[(2 * k - 1) * d + i];
      c[2 * k + 1] = -scale * modes[2 * k * d + i];
    }
  }
  fftw_execute(_transforms->backward);
  for (int i = 0; i < d; ++i)
    for (int j = 0; j <= _cells; ++j) y[i * _stride + j] = _transforms->real[i * n + j % n];
}

void StaggeredGrid::from_nodal(const double* z, double* y) const {
  // z at the nodes is analysed as if it were y; what that takes off is put back twice over.
  std::vector<double> modes(static_cast<std::size_t>(2 * cutoff() + 1) * static_cast<std::size_t>(dimension()));
  to_modes(z, modes.data());
  for (int k = 1; k <= cutoff(); ++k) {
    for (int i = 0; i < 2 * dimension(); ++i)
      modes[static_cast<std::size_t>((2 * k - 1) * dimension() + i)] *= _unfilter[static_cast<std::size_t>(k)];
  }
  from_modes(cutoff(), modes.data(), y);
}

}  // namespace orbweaver::loop
