#include "reduced_field.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <optional>
#include <utility>

#include "lyapunov_schmidt.hpp"
#include "orbweaver/numerics/decompositions.hpp"
#include "search.hpp"

namespace orbweaver::bifurcation {

namespace {

using Complex = std::complex<double>;

/// Highest order of the terms for two, three and more oscillations: those of one period have 20, 60, and for four 40,
/// coefficients an oscillation then.
constexpr int orders[] = {7, 5, 3};
constexpr int samples_a_coefficient = 2;
/// Starts in a plane of Newton's method on the polynomial; see start_directions.
constexpr int polynomial_starts = 24;
constexpr int polynomial_steps = 50;
/// Where steps end, and what may be left of the largest force there: the fit has an error of second order more, and a
/// force across all directions that conservation lets none of.
constexpr double settled_step = 1e-9;
constexpr double left_over = 1e-2;
constexpr double same_zero = 0.02;
/// Of a unit vector: a harmonic that is smaller does not count when its period is asked for.
constexpr double seen_harmonic = 1e-3;
/// At each zero the force must change by so many times what the fit leaves, per radian. Not measured.
constexpr double well_known = 100.0;
constexpr double of_sum = 1e-6;

constexpr Complex imaginary{0.0, 1.0};

/// All ways to choose `count` of `n` with repetition.
std::vector<std::vector<int>> choices(Eigen::Index n, int count) {
  std::vector<std::vector<int>> out{{}};
  for (int c = 0; c < count; ++c) {
    std::vector<std::vector<int>> longer;
    for (const std::vector<int>& chosen : out)
      for (int i = chosen.empty() ? 0 : chosen.back(); i < n; ++i) {
        longer.push_back(chosen);
        longer.back().push_back(i);
      }
    out = std::move(longer);
  }
  return out;
}

/// A field on unit vectors that commutes with a_m -> e^{i k_m t} a_m, k_m = around(m). Terms of lower orders are among
/// those of two orders more there.
class Polynomial {
 public:
  Polynomial(const Eigen::VectorXd& around, int highest) : _around(around) {
    for (int total = highest - 1; total <= highest; ++total)
      for (int plain = 0; plain <= total; ++plain)
        for (const std::vector<int>& a : choices(around.size(), plain))
          for (const std::vector<int>& conjugate : choices(around.size(), total - plain)) add({a, conjugate});
    _coefficients = Eigen::MatrixXcd::Zero(around.size(), static_cast<Eigen::Index>(_terms.size()));
  }

  /// The largest number of coefficients of a component.
  [[nodiscard]] std::size_t size() const {
    std::size_t largest = 0;
    for (Eigen::Index m = 0; m < _around.size(); ++m) largest = std::max(largest, terms_of(m).size());
    return largest;
  }

  void fit(const std::vector<Eigen::VectorXcd>& at, const std::vector<Eigen::VectorXcd>& values) {
    const auto count = static_cast<Eigen::Index>(at.size());
    Eigen::MatrixXcd rows(count, _coefficients.cols());
    Eigen::MatrixXcd right(count, _around.size());
    for (Eigen::Index s = 0; s < count; ++s) {
      rows.row(s) = powers(at[static_cast<std::size_t>(s)]).transpose();
      right.row(s) = values[static_cast<std::size_t>(s)].transpose();
    }
    for (Eigen::Index m = 0; m < _around.size(); ++m) {
      const std::vector<Eigen::Index> terms = terms_of(m);
      const Eigen::VectorXcd fitted =
          Eigen::JacobiSVD<Eigen::MatrixXcd>(rows(Eigen::all, terms), Eigen::ComputeThinU | Eigen::ComputeThinV)
              .solve(right.col(m));
      _coefficients(m, terms) = fitted.transpose();
    }
  }

  [[nodiscard]] Eigen::VectorXcd operator()(const Eigen::VectorXcd& a) const { return _coefficients * powers(a); }
  /// How the parts of the value change with those of a.
  [[nodiscard]] Eigen::MatrixXd derivative(const Eigen::VectorXcd& a) const {
    const Eigen::Index n = a.size();
    Eigen::MatrixXcd by_a = Eigen::MatrixXcd::Zero(_coefficients.cols(), n);
    Eigen::MatrixXcd by_conjugate = by_a;
    for (std::size_t t = 0; t < _terms.size(); ++t) {
      const auto row = static_cast<Eigen::Index>(t);
      for (std::size_t f = 0; f < _terms[t].plain.size(); ++f)
        by_a(row, _terms[t].plain[f]) += product(_terms[t], a, f, none);
      for (std::size_t f = 0; f < _terms[t].conjugate.size(); ++f)
        by_conjugate(row, _terms[t].conjugate[f]) += product(_terms[t], a, none, f);
    }
    const Eigen::MatrixXcd by_real = _coefficients * (by_a + by_conjugate);
    const Eigen::MatrixXcd by_imaginary = imaginary * (_coefficients * (by_a - by_conjugate));
    Eigen::MatrixXd out(2 * n, 2 * n);
    out << by_real.real(), by_imaginary.real(), by_real.imag(), by_imaginary.imag();
    return out;
  }
  /// How a changes with time where it only turns, at rate 1.
  [[nodiscard]] Eigen::VectorXcd turn(const Eigen::VectorXcd& a) const {
    return imaginary * _around.cast<Complex>().cwiseProduct(a);
  }

 private:
  struct Term {
    std::vector<int> plain;
    std::vector<int> conjugate;
  };
  static constexpr std::size_t none = std::numeric_limits<std::size_t>::max();

  [[nodiscard]] double around(const Term& term) const {
    double out = 0.0;
    for (const int m : term.plain) out += _around(m);
    for (const int m : term.conjugate) out -= _around(m);
    return out;
  }
  void add(Term term) {
    if ((_around.array() == around(term)).any()) _terms.push_back(std::move(term));
  }
  [[nodiscard]] std::vector<Eigen::Index> terms_of(Eigen::Index m) const {
    std::vector<Eigen::Index> out;
    for (std::size_t t = 0; t < _terms.size(); ++t)
      if (around(_terms[t]) == _around(m)) out.push_back(static_cast<Eigen::Index>(t));
    return out;
  }
  [[nodiscard]] Eigen::VectorXcd powers(const Eigen::VectorXcd& a) const {
    Eigen::VectorXcd out(static_cast<Eigen::Index>(_terms.size()));
    Eigen::Index t = 0;
    for (const Term& term : _terms) out(t++) = product(term, a, none, none);
    return out;
  }
  /// Without these two of its factors.
  [[nodiscard]] static Complex product(const Term& term, const Eigen::VectorXcd& a, std::size_t plain,
                                       std::size_t conjugate) {
    Complex out = 1.0;
    for (std::size_t f = 0; f < term.plain.size(); ++f)
      if (f != plain) out *= a(term.plain[f]);
    for (std::size_t f = 0; f < term.conjugate.size(); ++f)
      if (f != conjugate) out *= std::conj(a(term.conjugate[f]));
    return out;
  }

  Eigen::VectorXd _around;
  std::vector<Term> _terms;
  Eigen::MatrixXcd _coefficients;
};

/// Real and imaginary parts, one behind the other.
Eigen::VectorXd parts(const Eigen::VectorXcd& v) {
  Eigen::VectorXd out(2 * v.size());
  out << v.real(), v.imag();
  return out;
}

Eigen::VectorXcd from_parts(const Eigen::VectorXd& v) {
  const Eigen::Index n = v.size() / 2;
  return v.head(n).cast<Complex>() + Complex(0.0, 1.0) * v.tail(n).cast<Complex>();
}

/// How force - nu turn changes with the parts of a.
Eigen::MatrixXd derivative_at(const Polynomial& force, const Eigen::VectorXcd& a, double nu) {
  Eigen::MatrixXd out = force.derivative(a);
  for (Eigen::Index c = 0; c < out.cols(); ++c)
    out.col(c) -= nu * parts(force.turn(from_parts(Eigen::VectorXd::Unit(out.cols(), c))));
  return out;
}

struct Zero {
  Eigen::VectorXcd a;
  int index = 0;         ///< of the field on the space of unit vectors, time shifts aside
  double weakest = 0.0;  ///< the least that it changes by there, per radian
};

Zero zero_at(const Polynomial& force, const Eigen::VectorXcd& a, double nu) {
  Eigen::MatrixXd taken(2 * a.size(), 2);
  taken << parts(a), parts(force.turn(a));
  const Eigen::MatrixXd axes = Eigen::MatrixXd(taken.householderQr().householderQ()).rightCols(2 * a.size() - 2);
  const Eigen::MatrixXd across = axes.transpose() * derivative_at(force, a, nu) * axes;
  return {a, across.determinant() > 0.0 ? 1 : -1,
          Eigen::JacobiSVD<Eigen::MatrixXd>(across).singularValues().minCoeff()};
}

/// What of a force does not only turn a unit vector, and the rate at which the rest does.
std::pair<Eigen::VectorXd, double> gap_at(const Eigen::VectorXcd& force, const Eigen::VectorXcd& turn) {
  const double nu = turn.dot(force).real() / turn.squaredNorm();
  return {parts(force - nu * turn), nu};
}

/// Newton's method for force = nu turn, |a| = 1, from a unit vector. Nothing where it does not converge.
std::optional<Zero> zero_from(const Polynomial& force, Eigen::VectorXcd a, double scale) {
  const Eigen::Index size = 2 * a.size();
  for (int step = 0; step < polynomial_steps; ++step) {
    const Eigen::VectorXcd turn = force.turn(a);
    const auto [gap, nu] = gap_at(force(a), turn);
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(size + 2, size + 1);
    matrix.topLeftCorner(size, size) = derivative_at(force, a, nu);
    matrix.col(size).head(size) = -parts(turn);
    matrix.row(size).head(size) = scale * parts(a).transpose();  // keeps the length, and the phase
    matrix.row(size + 1).head(size) = scale * parts(turn).transpose();
    Eigen::VectorXd right = Eigen::VectorXd::Zero(size + 2);
    right.head(size) = -gap;
    const Eigen::VectorXd change = matrix.completeOrthogonalDecomposition().solve(right).head(size);
    a = (a + from_parts(change)).normalized();
    if (!a.allFinite()) return std::nullopt;
    if (change.norm() < settled_step)
      return gap.norm() < left_over * scale ? std::optional(zero_at(force, a, nu)) : std::nullopt;
  }
  return std::nullopt;
}

}  // namespace

ReducedZeros reduced_zeros(const systems::System& system, const loop::Loop& base, const KernelActions& group,
                           double amplitude) {
  const int order = orders[std::clamp(group.dimension() / 2 - 2, 0, 2)];
  const LyapunovSchmidt reduction(system, base, group, order);
  const Eigen::VectorXd& around = reduction.around();
  Polynomial field(around, order);
  const std::vector<Eigen::VectorXd> starts = start_directions(group.dimension(), 1, polynomial_starts);
  const std::size_t wanted = samples_a_coefficient * field.size();
  std::vector<Eigen::VectorXcd> at;
  std::vector<Eigen::VectorXcd> forces;
  double scale = 0.0;
  for (const Eigen::VectorXd& direction : starts) {
    if (at.size() == wanted) break;
    const Eigen::VectorXcd a = reduction.amplitudes(direction);
    const std::optional<Eigen::VectorXcd> force = reduction.force(amplitude * a);
    if (!force) continue;
    at.push_back(a);
    forces.push_back(*force);
    scale = std::max(scale, gap_at(*force, field.turn(a)).first.norm());
  }
  if (at.size() < wanted) return {};
  field.fit(at, forces);
  double misfit = 0.0;
  for (std::size_t s = 0; s < at.size(); ++s) misfit = std::max(misfit, (field(at[s]) - forces[s]).norm());
  ReducedZeros out;
  double indices = 0.0;
  bool is_clear = true;
  for (const Eigen::VectorXd& direction : starts) {
    const std::optional<Zero> zero = zero_from(field, reduction.amplitudes(direction), scale);
    is_clear = is_clear && zero && zero->weakest > well_known * misfit;
    if (!zero) continue;
    const Eigen::VectorXd v = reduction.coordinates(zero->a).normalized();
    if (std::any_of(out.vectors.begin(), out.vectors.end(),
                    [&](const Eigen::VectorXd& other) { return group.image(v, other, same_zero) != 0; }))
      continue;
    out.vectors.push_back(v);
    indices += static_cast<double>(zero->index) * group.images(v, same_zero) / group.times_around(v, seen_harmonic);
  }
  out.is_complete = is_clear && std::abs(indices - around.cwiseInverse().sum()) < of_sum;
  return out;
}

}  // namespace orbweaver::bifurcation
