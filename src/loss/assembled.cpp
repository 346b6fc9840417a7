#include <cmath>
#include <cstdlib>
#include <numbers>
#include <vector>

#include "orbweaver/core/check.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/loss/dense.hpp"
#include "orbweaver/loss/matrices.hpp"

namespace orbweaver::loss {

namespace {

// sum_j g_j cos(m s_j) and sum_j g_j sin(m s_j), m = 0 .. 2K, of one nodal function.
struct Sums {
  std::vector<double> c;
  std::vector<double> s;
};

Sums sums_of(const loop::FourierGrid& grid, const double* g, int highest) {
  Sums out{std::vector<double>(static_cast<std::size_t>(highest) + 1), std::vector<double>(static_cast<std::size_t>(highest) + 1)};
  grid.sums(g, highest, out.c.data(), out.s.data());
  return out;
}

// A basis function of s: cos(k s) or sin(k s).
struct Wave {
  int k;
  bool sine;
};

Wave wave_of_row(int row) { return {(row + 1) / 2, row > 0 && row % 2 == 0}; }

// d/ds of cos(ks) is -k sin(ks), of sin(ks) is k cos(ks).
double slope_factor(Wave w) { return w.sine ? w.k : -w.k; }
Wave slope_wave(Wave w) { return {w.k, !w.sine}; }

// sum_j g_j P(s_j) Q(s_j) by the product formulas of cosine and sine.
double product_sum(const Sums& g, Wave p, Wave q) {
  const auto plus = static_cast<std::size_t>(p.k + q.k);
  const int difference = p.k - q.k;
  const auto minus = static_cast<std::size_t>(std::abs(difference));
  if (p.sine == q.sine) return 0.5 * (g.c[minus] + (p.sine ? -g.c[plus] : g.c[plus]));
  const double s_minus = difference >= 0 ? g.s[minus] : -g.s[minus];
  return 0.5 * (g.s[plus] + (p.sine ? s_minus : -s_minus));
}

class HessianAssembly {
 public:
  HessianAssembly(const Linearization& lin, const Unknowns& unknowns, Curvature curvature)
      : _lin(lin), _unknowns(unknowns), _curvature(curvature), _d(lin.dimension()) {
    const int highest = 2 * lin.cutoff();
    for (int i = 0; i < _d; ++i)
      for (int l = 0; l < _d; ++l) {
        _a.push_back(sums_of(lin.grid(), lin.field_jacobian(i, l), highest));
        _m.push_back(l < i ? Sums{} : sums_of(lin.grid(), value_block(i, l).data(), highest));
      }
  }

  void fill(DenseMap h) const {
    const double scale = 2.0 / _lin.nodes();
    const int n = _unknowns.subspace.size();
    for (int col = 0; col < n; ++col)
      for (int row = col; row < n; ++row) {
        double sum = 0.0;
        for (const auto& p : _unknowns.subspace.basis(row))
          for (const auto& q : _unknowns.subspace.basis(col)) sum += p.weight * q.weight * entry(p, q);
        h(row, col) = h(col, row) = scale * sum;
      }
    if (_unknowns.period) fill_period(h);
  }

 private:
  // (A'A)_il, less sum_m r_m d2f_m/dz_i dz_l where the full curvature is wanted.
  [[nodiscard]] std::vector<double> value_block(int i, int l) const {
    const auto nodes = static_cast<std::size_t>(_lin.nodes());
    std::vector<double> block(nodes, 0.0);
    for (int m = 0; m < _d; ++m) {
      const double* left = _lin.field_jacobian(m, i);
      const double* right = _lin.field_jacobian(m, l);
      for (std::size_t j = 0; j < nodes; ++j) block[j] += left[j] * right[j];
    }
    if (_curvature == Curvature::full) {
      const double* second = _lin.contracted(i, l);
      for (std::size_t j = 0; j < nodes; ++j) block[j] -= second[j];
    }
    return block;
  }

  [[nodiscard]] double entry(const loop::Subspace::Entry& pe, const loop::Subspace::Entry& qe) const {
    const Wave p = wave_of_row(pe.row);
    const Wave q = wave_of_row(qe.row);
    const int i = pe.coordinate;
    const int l = qe.coordinate;
    const double rate = _lin.rate();
    const auto at = [this](int a, int b) { return static_cast<std::size_t>(a * _d + b); };
    double sum = i <= l ? product_sum(_m[at(i, l)], p, q) : product_sum(_m[at(l, i)], p, q);
    if (p.k > 0) sum -= rate * slope_factor(p) * product_sum(_a[at(i, l)], slope_wave(p), q);
    if (q.k > 0) sum -= rate * slope_factor(q) * product_sum(_a[at(l, i)], p, slope_wave(q));
    if (i == l && p.k == q.k && p.sine == q.sine && p.k > 0) sum += rate * rate * p.k * p.k * 0.5 * _lin.nodes();
    return sum;
  }

  void fill_period(DenseMap h) const {
    // The last column is H applied to the period alone, which the matrix-free form gives in O(N log N).
    std::vector<double> unit(static_cast<std::size_t>(_unknowns.size()), 0.0);
    unit.back() = 1.0;
    const std::vector<double> column = _lin.apply_hessian(_unknowns, unit, _curvature);
    const int last = _unknowns.size() - 1;
    for (int row = 0; row <= last; ++row) h(row, last) = h(last, row) = column[static_cast<std::size_t>(row)];
  }

  const Linearization& _lin;
  const Unknowns& _unknowns;
  Curvature _curvature;
  int _d;
  std::vector<Sums> _a;
  std::vector<Sums> _m;
};

}  // namespace

core::Handle<Mat> assemble_jacobian(const Linearization& lin, const Unknowns& unknowns) {
  core::require(lin.order() != Linearization::Order::residual, "a Jacobian needs a linearization of order jacobian");
  const int nodes = lin.nodes();
  const int d = lin.dimension();
  const double scale = 1.0 / std::sqrt(static_cast<double>(nodes));
  std::vector<double> cosine(static_cast<std::size_t>(nodes));
  std::vector<double> sine(cosine.size());
  for (int j = 0; j < nodes; ++j) {
    cosine[static_cast<std::size_t>(j)] = std::cos(2.0 * std::numbers::pi * j / nodes);
    sine[static_cast<std::size_t>(j)] = std::sin(2.0 * std::numbers::pi * j / nodes);
  }
  core::Handle<Mat> matrix = create_dense(lin.rows(), unknowns.size());
  with_dense_array(matrix, [&](DenseMap j_matrix) {
    j_matrix.setZero();
    for (int n = 0; n < unknowns.subspace.size(); ++n)
      for (const auto& e : unknowns.subspace.basis(n)) {
        const Wave w = wave_of_row(e.row);
        const double weight = scale * e.weight;
        for (int i = 0; i < d; ++i) {
          const double* a = lin.field_jacobian(i, e.coordinate);
          double* out = &j_matrix(static_cast<Eigen::Index>(i) * nodes, n);
          const double slope = i == e.coordinate && w.k > 0 ? lin.rate() * slope_factor(w) : 0.0;
          const double* value = w.sine ? sine.data() : cosine.data();
          const double* other = w.sine ? cosine.data() : sine.data();
          int at = 0;
          for (int j = 0; j < nodes; ++j) {
            out[j] += weight * (slope * other[at] - a[j] * value[at]);
            at += w.k;
            if (at >= nodes) at -= nodes;
          }
        }
      }
    if (!unknowns.period) return;
    for (int i = 0; i < d; ++i)
      for (int j = 0; j < nodes; ++j)
        j_matrix(static_cast<Eigen::Index>(i) * nodes + j, unknowns.size() - 1) =
            -scale * lin.rate() / lin.period() * lin.slope(i)[j];
  });
  return matrix;
}

core::Handle<Mat> assemble_hessian(const Linearization& lin, const Unknowns& unknowns, Curvature curvature) {
  core::require(lin.order() != Linearization::Order::residual, "a Hessian needs a linearization of order jacobian");
  core::require(curvature == Curvature::gauss_newton || lin.order() == Linearization::Order::second,
                "the full curvature needs a linearization of order second");
  core::Handle<Mat> matrix = create_dense(unknowns.size(), unknowns.size());
  const HessianAssembly assembly(lin, unknowns, curvature);
  with_dense_array(matrix, [&](DenseMap h) { assembly.fill(h); });
  core::check(MatSetOption(matrix.get(), MAT_SYMMETRIC, PETSC_TRUE), "MatSetOption");
  return matrix;
}

}  // namespace orbweaver::loss
