#include "orbweaver/loss/assembled.hpp"

#include <cmath>
#include <numbers>
#include <vector>

#include "orbweaver/core/error.hpp"
#include "orbweaver/core/log/log_stage.hpp"
#include "orbweaver/core/petsc/check.hpp"
#include "orbweaver/loss/dense.hpp"

namespace orbweaver::loss {

namespace {

// A basis function of s: cos(k s) or sin(k s).
struct Wave {
  int k;
  bool sine;
};

Wave wave_of_row(int row) { return {(row + 1) / 2, row > 0 && row % 2 == 0}; }

// d/ds of cos(ks) is -k sin(ks), of sin(ks) is k cos(ks).
double slope_factor(Wave w) { return w.sine ? w.k : -w.k; }

// Fourier sums of one nodal function, sum_j g_j cos(m s_j) and sum_j g_j sin(m s_j), for -2K <= m <= 2K, so that
// products of two waves need no case for the sign of a difference.
class Sums {
 public:
  Sums() = default;
  Sums(const loop::FourierGrid& grid, const double* g, int highest)
      : _highest(highest), _c(2 * static_cast<std::size_t>(highest) + 1), _s(_c.size()) {
    double* c = _c.data() + highest;
    double* s = _s.data() + highest;
    grid.sums(g, highest, c, s);
    for (int m = 1; m <= highest; ++m) {
      c[-m] = c[m];
      s[-m] = -s[m];
    }
  }
  [[nodiscard]] const double* c() const { return _c.data() + _highest; }
  [[nodiscard]] const double* s() const { return _s.data() + _highest; }

 private:
  int _highest = 0;
  std::vector<double> _c;
  std::vector<double> _s;
};

// sum_j g_j P(s_j) Q(s_j) for P = cos or sin of p s and Q = cos or sin of q s, by the product formulas.
template <bool PSine, bool QSine>
double product_sum(const double* c, const double* s, int p, int q) {
  if constexpr (PSine && QSine) return 0.5 * (c[p - q] - c[p + q]);
  if constexpr (!PSine && !QSine) return 0.5 * (c[p - q] + c[p + q]);
  if constexpr (PSine && !QSine) return 0.5 * (s[p + q] + s[p - q]);
  return 0.5 * (s[p + q] - s[p - q]);
}

// The coefficients of all basis vectors that stand at one coordinate and are all cosines or all sines.
struct Term {
  int unknown;
  int k;
  double weight;
};
struct Group {
  int coordinate;
  bool sine;
  std::vector<Term> terms;
};

std::vector<Group> groups_of(const loop::Subspace& subspace) {
  std::vector<Group> groups;
  for (int i = 0; i < subspace.dimension(); ++i)
    for (const bool sine : {false, true}) groups.push_back({i, sine, {}});
  for (int n = 0; n < subspace.size(); ++n)
    for (const auto& e : subspace.basis(n)) {
      const Wave w = wave_of_row(e.row);
      groups[static_cast<std::size_t>(2 * e.coordinate + (w.sine ? 1 : 0))].terms.push_back({n, w.k, e.weight});
    }
  return groups;
}

void require_same_size(const Linearization& lin, const Unknowns& unknowns) {
  core::require(unknowns.subspace.cutoff() == lin.cutoff() && unknowns.subspace.dimension() == lin.dimension(),
                "the unknowns belong to loops of another size than the linearization");
}

class HessianAssembly {
 public:
  HessianAssembly(const Linearization& lin, const Unknowns& unknowns, Curvature curvature)
      : _lin(lin), _unknowns(unknowns), _curvature(curvature), _d(lin.dimension()) {
    const int highest = 2 * lin.cutoff();
    if (!lin.evenly_in_time()) {
      std::vector<double> inverse(static_cast<std::size_t>(lin.nodes()));
      for (std::size_t j = 0; j < inverse.size(); ++j) inverse[j] = 1.0 / lin.density()[j];
      _u = Sums(lin.grid(), inverse.data(), highest);
    }
    for (int i = 0; i < _d; ++i)
      for (int l = 0; l < _d; ++l) {
        _a.emplace_back(lin.grid(), lin.field_jacobian(i, l), highest);
        if (l < i) {
          _m.emplace_back();
        } else {
          _m.emplace_back(lin.grid(), value_block(i, l).data(), highest);
        }
      }
  }

  /// `h` must be zero.
  void fill(DenseMap h) const {
    const std::vector<Group> groups = groups_of(_unknowns.subspace);
    for (const Group& columns : groups)
      for (const Group& rows : groups) {
        if (columns.sine)
          rows.sine ? add_pair<true, true>(columns, rows, h) : add_pair<true, false>(columns, rows, h);
        else
          rows.sine ? add_pair<false, true>(columns, rows, h) : add_pair<false, false>(columns, rows, h);
      }
    h.triangularView<Eigen::StrictlyUpper>() = h.transpose();
    for (std::size_t n = 0; n < _unknowns.scalars.size(); ++n)
      fill_scalar(_unknowns.subspace.size() + static_cast<int>(n), h);
  }

 private:
  // (A'A)_il, less sum_m r_m d2f_m/dz_i dz_l where the full curvature is wanted, times the density w.
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
    if (!_lin.evenly_in_time())
      for (std::size_t j = 0; j < nodes; ++j) block[j] *= _lin.density()[j];
    return block;
  }

  // The lower triangle's share of all products of a coefficient of `columns` (P, coordinate i) with one of `rows` (Q,
  // l):
  //   (2/N) sum_j [ rate^2 P'Q' delta_il / w - rate P' A_il Q - rate P A_li Q' + w P M_il Q ].
  template <bool PSine, bool QSine>
  void add_pair(const Group& columns, const Group& rows, DenseMap h) const {
    const int i = columns.coordinate;
    const int l = rows.coordinate;
    const auto at = [this](int a, int b) { return static_cast<std::size_t>(a * _d + b); };
    const Sums& m = i <= l ? _m[at(i, l)] : _m[at(l, i)];
    const Sums& a = _a[at(i, l)];
    const Sums& b = _a[at(l, i)];
    const double *mc = m.c(), *ms = m.s(), *ac = a.c(), *as = a.s(), *bc = b.c(), *bs = b.s();
    const double rate = _lin.rate();
    const double scale = 2.0 / _lin.nodes();
    const bool mapped = !_lin.evenly_in_time();
    for (const Term& p : columns.terms) {
      const double p_slope = rate * slope_factor({p.k, PSine});
      double* column = &h(0, p.unknown);
      for (const Term& q : rows.terms) {
        if (q.unknown < p.unknown) continue;
        const double q_slope = rate * slope_factor({q.k, QSine});
        double sum = product_sum<PSine, QSine>(mc, ms, p.k, q.k);
        sum -= p_slope * product_sum<!PSine, QSine>(ac, as, p.k, q.k);
        sum -= q_slope * product_sum<PSine, !QSine>(bc, bs, p.k, q.k);
        if (mapped) {
          if (i == l) sum += p_slope * q_slope * product_sum<!PSine, !QSine>(_u.c(), _u.s(), p.k, q.k);
        } else if (PSine == QSine && i == l && p.k == q.k) {
          sum += 0.5 * _lin.nodes() * p_slope * q_slope;
        }
        column[q.unknown] += scale * p.weight * q.weight * sum;
      }
    }
  }

  void fill_scalar(int at, DenseMap h) const {
    // The column is H applied to the scalar alone, which the matrix-free form gives in O(N log N).
    std::vector<double> unit(static_cast<std::size_t>(_unknowns.size()), 0.0);
    unit[static_cast<std::size_t>(at)] = 1.0;
    const std::vector<double> column = _lin.apply_hessian(_unknowns, unit, _curvature);
    for (int row = 0; row < _unknowns.size(); ++row) h(row, at) = h(at, row) = column[static_cast<std::size_t>(row)];
  }

  const Linearization& _lin;
  const Unknowns& _unknowns;
  Curvature _curvature;
  int _d;
  std::vector<Sums> _a;
  std::vector<Sums> _m;
  Sums _u;  // of 1/w, where w is not 1
};

}  // namespace

core::Handle<Mat> assemble_jacobian(const Linearization& lin, const Unknowns& unknowns) {
  const core::LogEvent event(core::Event::assembly);
  core::require(lin.order() != Linearization::Order::residual, "a Jacobian needs a linearization of order jacobian");
  require_same_size(lin, unknowns);
  const int nodes = lin.nodes();
  const int d = lin.dimension();
  std::vector<double> cosine(static_cast<std::size_t>(nodes));
  std::vector<double> sine(cosine.size());
  std::vector<double> scale(cosine.size());
  const double* density = lin.density().data();
  for (int j = 0; j < nodes; ++j) {
    scale[static_cast<std::size_t>(j)] = std::sqrt(density[j] / nodes);
    cosine[static_cast<std::size_t>(j)] = std::cos(2.0 * std::numbers::pi * j / nodes);
    sine[static_cast<std::size_t>(j)] = std::sin(2.0 * std::numbers::pi * j / nodes);
  }
  core::Handle<Mat> matrix = create_dense(lin.rows(), unknowns.size());
  with_dense_array(matrix, [&](DenseMap j_matrix) {
    j_matrix.setZero();
    for (int n = 0; n < unknowns.subspace.size(); ++n)
      for (const auto& e : unknowns.subspace.basis(n)) {
        const Wave w = wave_of_row(e.row);
        for (int i = 0; i < d; ++i) {
          const double* a = lin.field_jacobian(i, e.coordinate);
          double* out = &j_matrix(static_cast<Eigen::Index>(i) * nodes, n);
          const double slope = i == e.coordinate && w.k > 0 ? lin.rate() * slope_factor(w) : 0.0;
          const double* value = w.sine ? sine.data() : cosine.data();
          const double* other = w.sine ? cosine.data() : sine.data();
          int at = 0;
          for (int j = 0; j < nodes; ++j) {
            out[j] +=
                e.weight * scale[static_cast<std::size_t>(j)] * (slope / density[j] * other[at] - a[j] * value[at]);
            at += w.k;
            if (at >= nodes) at -= nodes;
          }
        }
      }
    int at = unknowns.subspace.size();
    for (const Scalar& scalar : unknowns.scalars) {
      const double* column = scalar.kind == Scalar::Kind::period ? nullptr : lin.column(scalar).data();
      for (int i = 0; i < d; ++i)
        for (int j = 0; j < nodes; ++j)
          j_matrix(static_cast<Eigen::Index>(i) * nodes + j, at) =
              column == nullptr ? -scale[static_cast<std::size_t>(j)] * lin.rate() / lin.period() * lin.slope(i)[j]
                                : -scale[static_cast<std::size_t>(j)] * column[i * nodes + j];
      ++at;
    }
  });
  return matrix;
}

core::Handle<Mat> assemble_hessian(const Linearization& lin, const Unknowns& unknowns, Curvature curvature) {
  const core::LogEvent event(core::Event::assembly);
  core::require(lin.order() != Linearization::Order::residual, "a Hessian needs a linearization of order jacobian");
  core::require(curvature == Curvature::gauss_newton || lin.order() == Linearization::Order::second,
                "the full curvature needs a linearization of order second");
  require_same_size(lin, unknowns);
  core::Handle<Mat> matrix = create_dense(unknowns.size(), unknowns.size());
  const HessianAssembly assembly(lin, unknowns, curvature);
  with_dense_array(matrix, [&](DenseMap h) { assembly.fill(h); });
  core::check(MatSetOption(matrix.get(), MAT_SYMMETRIC, PETSC_TRUE), "MatSetOption");
  return matrix;
}

}  // namespace orbweaver::loss
