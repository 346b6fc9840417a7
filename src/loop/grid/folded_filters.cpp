#include "folded_filters.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <utility>

namespace orbweaver::loop {

namespace {

constexpr int lanes = 4;
using Lane = double __attribute__((vector_size(lanes * sizeof(double)), aligned(8)));

Lane load(const double* p) { return *reinterpret_cast<const Lane*>(p); }
void store(double* p, Lane v) { *reinterpret_cast<Lane*>(p) = v; }

/// out_c[r] = sum_j matrix(r, j) y_c[j] for `Count` vectors at once; blocks of two registers of rows.
template <int Count>
void product(int columns, int width, const double* matrix, const double* const* y, double* const* out) {
  for (int r = 0; r < width; r += 2 * lanes) {
    Lane low[Count] = {};
    Lane high[Count] = {};
    for (int j = 0; j < columns; ++j) {
      const Lane a = load(matrix + j * width + r);
      const Lane b = load(matrix + j * width + r + lanes);
      for (int c = 0; c < Count; ++c) {
        low[c] += a * y[c][j];
        high[c] += b * y[c][j];
      }
    }
    for (int c = 0; c < Count; ++c) {
      store(out[c] + r, low[c]);
      store(out[c] + r + lanes, high[c]);
    }
  }
}

}  // namespace

FoldedFilters::Matrix::Matrix(int row_count, int columns)
    : rows(row_count),
      width((row_count + 2 * lanes - 1) / (2 * lanes) * 2 * lanes),
      entries(static_cast<std::size_t>(width * columns), 0.0) {}

FoldedFilters::FoldedFilters(const FundamentalDomain& domain, int cells, int stride)
    : _dimension(static_cast<std::size_t>(domain.dimension())),
      _cells(cells),
      _stride(stride),
      _order(domain.order),
      _nodes(cells * domain.copies()),
      _mirrored(domain.reversor.has_value()) {
  for (int i = 0; i < domain.dimension(); ++i) {
    const double rotation = domain.generator(i, i);
    const double mirror = _mirrored ? (*domain.reversor)(i, i) : 1.0;
    Kind* found = nullptr;
    for (Kind& kind : _kinds)
      if (kind.rotation_sign == rotation && kind.mirror_sign == mirror) found = &kind;
    if (found == nullptr) {
      _kinds.push_back({rotation, mirror, {}, {}, {}, {}, {}, {}, {}});
      found = &_kinds.back();
    }
    found->coordinates.push_back(i);
  }
  Waves waves;
  for (int q = 0; q < 2 * _nodes; ++q) {
    waves.cosine.push_back(std::cos(std::numbers::pi * q / _nodes));
    waves.sine.push_back(std::sin(std::numbers::pi * q / _nodes));
  }
  std::size_t widest = 0;
  for (Kind& kind : _kinds) {
    fill(kind, waves);
    widest =
        std::max({widest, static_cast<std::size_t>(kind.node.width), static_cast<std::size_t>(kind.analysis.width)});
  }
  _work.resize(_dimension * widest);
}

namespace {

using Waves = FoldedFilters::Waves;

/// What unit values at node 0 and at its images under the generator give `e` half cells away, |e| <= `reach`.
class Response {
 public:
  /// `turn`: nodes of 1/order of the loop; `sign`: of the coordinate under the generator.
  Response(const std::vector<int>& harmonics, const Waves& waves, int nodes, int order, double sign, int reach)
      : _reach(reach), _value(size(2 * reach + 1)), _slope(size(2 * reach + 1)) {
    const int turn = nodes / order;
    std::vector<double> value(size(turn) + 1, 0.0);
    std::vector<double> slope(size(turn) + 1, 0.0);
    for (const int k : harmonics) {
      const double x = std::numbers::pi * k / nodes;
      const double weight = (k == 0 ? 1.0 : 2.0 * std::sin(x) / x) * order / nodes;
      int q = 0;
      for (int e = 0; e <= turn; ++e) {
        value[size(e)] += weight * waves.cosine[size(q)];
        slope[size(e)] -= weight * k * waves.sine[size(q)];
        q += k;
        if (q >= 2 * nodes) q -= 2 * nodes;
      }
    }
    // Even and odd in e, and periodic up to the sign.
    int at = -reach;
    double turned = 1.0;
    while (at < -turn) at += 2 * turn, turned *= sign;
    for (int e = -reach; e <= reach; ++e, ++at) {
      if (at > turn) at -= 2 * turn, turned *= sign;
      _value[size(e + reach)] = turned * value[size(std::abs(at))];
      _slope[size(e + reach)] = at < 0 ? -turned * slope[size(-at)] : turned * slope[size(at)];
    }
  }
  [[nodiscard]] double value(int e) const { return _value[size(e + _reach)]; }
  [[nodiscard]] double slope(int e) const { return _slope[size(e + _reach)]; }

 private:
  static std::size_t size(int n) { return static_cast<std::size_t>(n); }
  int _reach;
  std::vector<double> _value;
  std::vector<double> _slope;
};

}  // namespace

void FoldedFilters::fill(Kind& kind, const Waves& waves) const {
  const int first = kind.rotation_sign > 0.0 ? 0 : _order / 2;
  std::vector<int> harmonics;  // that the generator allows, Nyquist's left out
  for (int k = first; 2 * k < _nodes; k += _order) harmonics.push_back(k);
  const Response response(harmonics, waves, _nodes, _order, kind.rotation_sign, 4 * _cells + 1);

  const int columns = _cells + 1;
  const int last = _mirrored ? _cells : _cells - 1;  // node `cells` is an image of node 0 otherwise
  kind.midpoint = Matrix(_cells, columns);
  kind.node = Matrix(columns, columns);
  kind.slope = Matrix(columns, columns);
  for (int j = 0; j <= last; ++j) {
    const bool doubled = _mirrored && j > 0 && j < _cells;
    for (int i = 0; i <= _cells; ++i) {
      if (i < _cells) kind.midpoint.at(i, j) = response.value(2 * (i - j) + 1);
      kind.node.at(i, j) = response.value(2 * (i - j));
      kind.slope.at(i, j) = response.slope(2 * (i - j));
      if (!doubled) continue;
      if (i < _cells) kind.midpoint.at(i, j) += kind.mirror_sign * response.value(2 * (i + j) + 1);
      kind.node.at(i, j) += kind.mirror_sign * response.value(2 * (i + j));
      kind.slope.at(i, j) += kind.mirror_sign * response.slope(2 * (i + j));
    }
  }

  struct Row {
    int k;
    bool sine;
  };
  std::vector<Row> rows;
  for (const int k : harmonics) {
    if (!_mirrored || kind.mirror_sign > 0.0) rows.push_back({k, false});
    if (k > 0 && (!_mirrored || kind.mirror_sign < 0.0)) rows.push_back({k, true});
  }
  kind.analysis = Matrix(static_cast<int>(rows.size()), columns);
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const auto [k, sine] = rows[r];
    kind.analysed_rows.push_back(k == 0 ? 0 : 2 * k - (sine ? 0 : 1));
    const double x = std::numbers::pi * k / _nodes;
    const double filter = k == 0 ? 1.0 : std::sin(x) / x;
    const double weight = (k == 0 ? 1.0 : 2.0) * filter * _order / _nodes;
    kind.synthesis_weights.push_back(1.0 / (filter * weight));
    const std::vector<double>& wave = sine ? waves.sine : waves.cosine;
    std::size_t q = 0;  // 2 k j half cells around
    for (int j = 0; j <= last; ++j) {
      const double copies = _mirrored && j > 0 && j < _cells ? 2.0 : 1.0;
      kind.analysis.at(static_cast<int>(r), j) = copies * weight * wave[q];
      q += static_cast<std::size_t>(2 * k);
      if (q >= wave.size()) q -= wave.size();
    }
  }
}

void FoldedFilters::multiply(const Matrix& matrix, const Kind& kind, const double* y) const {
  const auto width = static_cast<std::size_t>(matrix.width);
  for (std::size_t c = 0; c < kind.coordinates.size(); c += 4) {
    const std::size_t count = std::min<std::size_t>(4, kind.coordinates.size() - c);
    const double* in[4];
    double* out[4];
    for (std::size_t n = 0; n < count; ++n) {
      in[n] = y + static_cast<std::ptrdiff_t>(kind.coordinates[c + n]) * _stride;
      out[n] = _work.data() + (c + n) * width;
    }
    switch (count) {
      case 1: product<1>(_cells + 1, matrix.width, matrix.entries.data(), in, out); break;
      case 2: product<2>(_cells + 1, matrix.width, matrix.entries.data(), in, out); break;
      case 3: product<3>(_cells + 1, matrix.width, matrix.entries.data(), in, out); break;
      default: product<4>(_cells + 1, matrix.width, matrix.entries.data(), in, out); break;
    }
  }
}

void FoldedFilters::apply(Matrix Kind::*matrix, const double* y, double* out, int out_stride) const {
  for (const Kind& kind : _kinds) {
    multiply(kind.*matrix, kind, y);
    for (std::size_t c = 0; c < kind.coordinates.size(); ++c)
      std::copy_n(_work.data() + c * static_cast<std::size_t>((kind.*matrix).width), (kind.*matrix).rows,
                  out + static_cast<std::ptrdiff_t>(kind.coordinates[c]) * out_stride);
  }
}

void FoldedFilters::to_midpoints(const double* y, double* z) const { apply(&Kind::midpoint, y, z, _cells); }

void FoldedFilters::at_nodes(const double* y, double* z, double* slope) const {
  apply(&Kind::node, y, z, _stride);
  apply(&Kind::slope, y, slope, _stride);
}

void FoldedFilters::to_modes(const double* y, double* modes) const {
  const std::size_t d = _dimension;
  for (const Kind& kind : _kinds) {
    multiply(kind.analysis, kind, y);
    for (std::size_t c = 0; c < kind.coordinates.size(); ++c) {
      const double* values = _work.data() + c * static_cast<std::size_t>(kind.analysis.width);
      for (std::size_t r = 0; r < kind.analysed_rows.size(); ++r)
        modes[static_cast<std::size_t>(kind.analysed_rows[r]) * d + static_cast<std::size_t>(kind.coordinates[c])] =
            values[r];
    }
  }
}

void FoldedFilters::from_modes(int cutoff, const double* modes, double* y) const {
  for (const Kind& kind : _kinds) {
    const auto width = static_cast<std::size_t>(kind.analysis.width);
    for (const int coordinate : kind.coordinates) {
      std::fill_n(_work.begin(), width, 0.0);
      for (std::size_t r = 0; r < kind.analysed_rows.size(); ++r) {
        const int row = kind.analysed_rows[r];
        if (row > 2 * cutoff) break;
        _work[r] = kind.synthesis_weights[r] *
                   modes[static_cast<std::size_t>(row) * _dimension + static_cast<std::size_t>(coordinate)];
      }
      double* out = y + static_cast<std::ptrdiff_t>(coordinate) * _stride;
      const int last = _mirrored ? _cells : _cells - 1;
      for (int j = 0; j <= last; ++j) {
        const double* column = kind.analysis.entries.data() + static_cast<std::size_t>(j) * width;
        Lane sum[2] = {};
        for (std::size_t r = 0; r < width; r += 2 * lanes) {
          sum[0] += load(column + r) * load(_work.data() + r);
          sum[1] += load(column + r + lanes) * load(_work.data() + r + lanes);
        }
        const Lane both = sum[0] + sum[1];
        double total = 0.0;
        for (int l = 0; l < lanes; ++l) total += both[l];
        out[j] = _mirrored && j > 0 && j < _cells ? 0.5 * total : total;
      }
      if (!_mirrored) out[_cells] = kind.rotation_sign * out[0];
    }
  }
}

}  // namespace orbweaver::loop
