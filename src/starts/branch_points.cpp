#include "branch_points.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <utility>

#include "orbweaver/numerics/decompositions.hpp"
#include "orbweaver/numerics/locate.hpp"

namespace orbweaver::starts {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// A pivot, beside entries of 1, that is smaller is rounding's.
constexpr double dependent = 1e-13;
/// Rounds in which rows and columns are scaled to entries of 1 at most. Not measured.
constexpr int scaling_rounds = 3;
/// An imaginary part below this, in parts of the eigenvalue's size, is rounding's: of double real ones. Not measured.
constexpr double real_to_rounding = 1e-11;
/// A step over which no eigenvalue changes its sign, but one comes near zero and turns, is halved so often.
constexpr int most_looks = 6;
/// Branch points nearer than this, relative as places are known, are one.
constexpr double one_place = 1e-8;
/// Of its size: what an eigenvalue may be at a branch point that was located. Not measured.
constexpr double zero_eigenvalue = 1e-7;
/// Zeros within the last piece of a step, in parts of it.
constexpr double located_in_piece = 1e-10;

/// A determinant as its sign and the logarithm of its modulus, which no dimension lets under- or overflow.
struct Determinant {
  int sign = 0;
  double log = 0.0;
  double least_pivot = 0.0;  ///< of the matrix whose rows and columns were scaled
};

Determinant determinant_of(MatrixXd matrix) {
  Determinant out;
  const auto factor = [&out](double largest) {
    const double by = largest > 0.0 ? std::sqrt(largest) : 1.0;
    out.log += std::log(by);
    return 1.0 / by;
  };
  for (int round = 0; round < scaling_rounds; ++round) {
    for (Index i = 0; i < matrix.rows(); ++i) matrix.row(i) *= factor(matrix.row(i).cwiseAbs().maxCoeff());
    for (Index i = 0; i < matrix.cols(); ++i) matrix.col(i) *= factor(matrix.col(i).cwiseAbs().maxCoeff());
  }
  const Eigen::PartialPivLU<MatrixXd> lu(matrix);
  const VectorXd pivots = lu.matrixLU().diagonal();
  out.least_pivot = pivots.cwiseAbs().minCoeff();
  if (!(out.least_pivot > 0.0)) return out;
  out.log += pivots.cwiseAbs().array().log().sum();
  const auto negative = std::count_if(pivots.begin(), pivots.end(), [](double pivot) { return pivot < 0.0; });
  out.sign = static_cast<int>(lu.permutationP().determinant()) * (negative % 2 == 0 ? 1 : -1);
  return out;
}

/// A real eigenvalue and what its rounding is relative to.
struct Real {
  double value = 0.0;
  double size = 0.0;
  [[nodiscard]] bool may_be_zero() const { return std::abs(value) <= at_end * size; }
};

/// A place on the curve and what tells there whether others pass.
struct Looked {
  CurveNode node;
  std::vector<Real> real;   ///< eigenvalues, the largest first
  int to_the_right = 0;     ///< eigenvalues of positive real part
  double least_pair = 0.0;  ///< modulus of the real part of pairs, the least
  double largest = 0.0;     ///< size of eigenvalues
  int orientation = 0;      ///< the sign of the determinant of the bordered equation; 0 where rounding has it
  /// Of eigenvalues in that order: whether it is zero because another curve passes just here.
  [[nodiscard]] bool is_zero(std::size_t k) const { return orientation == 0 && real[k].may_be_zero(); }
};

bool is_real(const GradedSpectrum& spectrum, Index i) {
  return std::abs(spectrum.values(i).imag()) <= real_to_rounding * spectrum.sizes(i);
}

std::vector<Real> real_ones(const GradedSpectrum& spectrum) {
  std::vector<Real> out;
  for (Index i = 0; i < spectrum.values.size(); ++i)
    if (is_real(spectrum, i)) out.push_back({spectrum.values(i).real(), spectrum.sizes(i)});
  std::sort(out.begin(), out.end(), [](const Real& a, const Real& b) { return a.value > b.value; });
  return out;
}

double least_modulus(const std::vector<Real>& real) {
  double least = std::numeric_limits<double>::infinity();
  for (const Real& one : real) least = std::min(least, std::abs(one.value));
  return least;
}

Looked looked_at(const CurveEquations& curve, CurveNode node) {
  const GradedSpectrum spectrum = curve.eigensystem(node.x, false);
  Looked out;
  out.largest = spectrum.sizes.maxCoeff();
  out.real = real_ones(spectrum);
  out.least_pair = std::numeric_limits<double>::infinity();
  for (Index i = 0; i < spectrum.values.size(); ++i) {
    if (spectrum.values(i).real() > 0.0) ++out.to_the_right;
    if (!is_real(spectrum, i)) out.least_pair = std::min(out.least_pair, std::abs(spectrum.values(i).real()));
  }
  const Determinant determinant = determinant_of(curve.bordered(node.x, node.direction));
  const bool is_zero = determinant.least_pivot <= dependent &&
                       std::any_of(out.real.begin(), out.real.end(), [](const Real& r) { return r.may_be_zero(); });
  out.orientation = is_zero ? 0 : determinant.sign;
  out.node = std::move(node);
  return out;
}

bool are_of_one_sign(double a, double b) { return (a < 0.0) == (b < 0.0); }

class Search {
 public:
  explicit Search(const CurveEquations& curve) : _curve(curve) {}

  /// Halves the piece until each part has nothing, a fold, or is as short as places are known.
  void between(const Looked& a, const Looked& b, int looks = 0) {
    const Index p = _curve.dimension();
    const bool turns = !are_of_one_sign(a.node.direction(p), b.node.direction(p));
    const bool as_many = a.real.size() == b.real.size();
    const std::vector<std::size_t> passing = as_many ? passing_between(a, b) : std::vector<std::size_t>{};
    // The determinant is that of the Jacobian over the parameter's share of the direction.
    const bool odd = (passing.size() % 2 == 1) != turns;
    const bool is_known = a.orientation != 0 && b.orientation != 0;
    const bool changes = is_known ? a.orientation != b.orientation : odd;
    const int across = std::abs(a.to_the_right - b.to_the_right);
    const int events = static_cast<int>(passing.size()) + (turns ? 1 : 0);
    if (as_many && changes == odd) {
      if (events == 0) return look_closer(a, b, passing, looks);
      if (turns && events == 1) return add_one(a, b);
      if (events == 2 && turns && !changes) return look_closer(a, b, passing, looks);  // at the fold one passes
    } else if (!as_many && !changes && across == (turns ? 1 : 0)) {
      return;  // real ones have met, away from zero
    }
    if ((b.node.x - a.node.x).norm() > beside_singular(a.node.x)) {
      if (const auto middle = middle_of(a, b)) {
        if (middle->orientation == 0 && a.orientation * b.orientation != 0) add(middle->node.x);
        between(a, *middle, looks);
        return between(*middle, b, looks);
      }
      _found.is_undecided = true;
    } else if (as_many && changes == odd) {
      add_all(a, b, passing, turns);
    } else if (changes && !as_many && across <= 1) {
      add_one(a, b);
    } else if (as_many || changes || turns || a.least_pair > least_modulus(a.real) ||
               b.least_pair > least_modulus(b.real)) {
      _found.is_undecided = true;  // else the axis is passed by a pair
    }
  }

  void add(VectorXd place) { _found.places.push_back(std::move(place)); }

  /// In their order along the step.
  [[nodiscard]] BranchPoints found(const CurveNode& a, const CurveNode& b) && {
    const VectorXd chord = b.x - a.x;
    std::vector<VectorXd>& places = _found.places;
    std::sort(places.begin(), places.end(),
              [&](const VectorXd& x, const VectorXd& y) { return chord.dot(x) < chord.dot(y); });
    const auto end = std::unique(places.begin(), places.end(), [](const VectorXd& x, const VectorXd& y) {
      return (x - y).norm() <= one_place * known_to(y);
    });
    places.erase(end, places.end());
    return std::move(_found);
  }

 private:
  /// Eigenvalues whose sign changes, those left out that are zero at an end.
  [[nodiscard]] static std::vector<std::size_t> passing_between(const Looked& a, const Looked& b) {
    std::vector<std::size_t> out;
    for (std::size_t k = 0; k < a.real.size(); ++k)
      if (!are_of_one_sign(a.real[k].value, b.real[k].value) && !a.is_zero(k) && !b.is_zero(k)) out.push_back(k);
    return out;
  }

  [[nodiscard]] std::optional<Looked> middle_of(const Looked& a, const Looked& b) const {
    int steps = 0;
    const VectorXd guess = cubic_between(a.node, b.node, 0.5);
    const auto x =
        _curve.corrected(guess, (b.node.x - a.node.x).normalized(), steps, converged_beside / known_to(guess));
    if (!x) return std::nullopt;
    return looked_at(_curve, {*x, _curve.direction(*x, a.node.direction)});
  }

  /// Whether anything but `passing` passes and comes back.
  void look_closer(const Looked& a, const Looked& b, const std::vector<std::size_t>& passing, int looks) {
    if (looks == most_looks || a.real.empty() || a.orientation == 0 || b.orientation == 0) return;
    const auto middle = middle_of(a, b);
    if (!middle || middle->real.size() != a.real.size()) return;
    for (std::size_t k = 0; k < a.real.size(); ++k) {
      if (std::find(passing.begin(), passing.end(), k) != passing.end()) continue;
      // Halfway to zero from an end it is never nearer to zero than that, unless it slows down, turns or passes.
      const double there = middle->real[k].value;
      if (!are_of_one_sign(a.real[k].value, there) ||
          2.0 * std::abs(there) < std::max(std::abs(a.real[k].value), std::abs(b.real[k].value))) {
        between(a, *middle, looks + 1);
        return between(*middle, b, looks + 1);
      }
    }
  }

  /// Unless an eigenvalue has another sign by a jump, or a pole. At the place itself all may be zero.
  void add_if_singular(const std::optional<VectorXd>& place, const Looked& a, const Looked& b) {
    if (place && _curve.eigenvalues(*place).cwiseAbs().minCoeff() <= zero_eigenvalue * size_between(a, b))
      add(*place);
    else
      _found.is_undecided = true;
  }

  /// Of what passes zero, at the ends, since where it is zero it may have none; where no eigenvalue alone tells, of
  /// all.
  [[nodiscard]] static double size_between(const Looked& a, const Looked& b) {
    double size = 0.0;
    if (a.real.size() == b.real.size())
      for (const std::size_t k : passing_between(a, b)) size = std::max({size, a.real[k].size, b.real[k].size});
    return size > 0.0 ? size : std::max(a.largest, b.largest);
  }

  /// By the determinant, where no eigenvalue alone tells: the curve turns as well, or real ones meet.
  void add_one(const Looked& a, const Looked& b) {
    const double size = determinant_of(_curve.bordered(a.node.x, a.node.direction)).log;
    add_if_singular(zero_beside_curve(_curve, a.node, b.node,
                                      [&](const VectorXd& at) {
                                        constexpr double most = 700.0;  // a double's
                                        const Determinant here = determinant_of(_curve.bordered(at, a.node.direction));
                                        return here.sign * std::exp(std::clamp(here.log - size, -most, most));
                                      }),
                    a, b);
  }

  /// By their eigenvalues, within a piece so short that its cubic is the curve to rounding.
  void add_all(const Looked& a, const Looked& b, const std::vector<std::size_t>& passing, bool turns) {
    std::vector<double> shares;
    for (const std::size_t k : passing) {
      const auto found = numerics::locate_root(
          [&](double share) {
            const std::vector<Real> real = real_ones(_curve.eigensystem(cubic_between(a.node, b.node, share), false));
            return real.size() == a.real.size() ? real[k].value : std::numeric_limits<double>::quiet_NaN();
          },
          0.0, 1.0, located_in_piece);
      if (found)
        shares.push_back(found->position);
      else
        _found.is_undecided = true;
    }
    if (turns && !shares.empty()) {  // one of them passes at the fold
      const auto fold = numerics::locate_root(
          [&](double share) {
            return _curve.direction(cubic_between(a.node, b.node, share), a.node.direction)(_curve.dimension());
          },
          0.0, 1.0, located_in_piece);
      const double at = fold ? fold->position : 0.5;
      shares.erase(std::min_element(shares.begin(), shares.end(),
                                    [&](double x, double y) { return std::abs(x - at) < std::abs(y - at); }));
    }
    for (const double share : shares) add_if_singular(cubic_between(a.node, b.node, share), a, b);
  }

  const CurveEquations& _curve;
  BranchPoints _found;
};

}  // namespace

std::vector<BranchPoints> branch_points(const CurveEquations& curve, const std::vector<CurveNode>& nodes) {
  std::vector<Looked> looked;
  for (const CurveNode& node : nodes) looked.push_back(looked_at(curve, node));
  const auto at_one_place = [&](std::size_t n, std::size_t m) {
    return (nodes[n].x - nodes[m].x).norm() <= one_place * known_to(nodes[m].x);
  };
  // Of several nodes at one place the first. Where it is singular at a neighbour too it is so all along.
  const auto is_itself = [&](std::size_t n) {
    if (looked[n].orientation != 0 || (n > 0 && (at_one_place(n, n - 1) || looked[n - 1].orientation == 0)))
      return false;
    std::size_t next = n + 1;
    while (next < nodes.size() && at_one_place(n, next)) ++next;
    return next == nodes.size() || looked[next].orientation != 0;
  };
  std::vector<BranchPoints> out;
  for (std::size_t n = 1; n < looked.size(); ++n) {
    Search search(curve);
    if (n == 1 && is_itself(0)) search.add(nodes[0].x);
    search.between(looked[n - 1], looked[n]);
    if (is_itself(n)) search.add(nodes[n].x);
    out.push_back(std::move(search).found(nodes[n - 1], nodes[n]));
  }
  return out;
}

}  // namespace orbweaver::starts
