#include "orbweaver/starts/linear_modes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include <fmt/format.h>
#include <Eigen/Eigenvalues>
#include <boost/math/constants/constants.hpp>

#include "orbweaver/core/error.hpp"
#include "orbweaver/numerics/decompositions.hpp"
#include "orbweaver/systems/quad_system.hpp"

namespace orbweaver::starts {

namespace {

using numerics::Quad;
using numerics::QuadMatrix;
using numerics::QuadVector;

/// Parameters are doubles, and so are the entries of A to a few roundings: what moves by less under relative changes of
/// the entries of this size cannot be told apart.
constexpr double entry_rounding = 16.0 * std::numeric_limits<double>::epsilon();
/// A fixed point is known to rounding, so that Newton's method in quadruple precision, which squares the error, needs
/// two steps. One that is longer, relative to 1 + |z|, comes from a singular Jacobian and is not made.
constexpr int polishing_steps = 2;
constexpr double longest_polishing = 1e-6;
/// Parlett and Reinsch 1969 (doi:10.1007/BF02165404): a scaling is worth it if it shortens row and column by 5 %.
constexpr double worth_scaling = 0.95;
constexpr double quad_rounding = 1e-30;
/// Rounding of the coordinates of a fixed point, where it is asked whether a reversor leaves it alone.
constexpr double kept_point = 1e-9;
/// Largest whole ratio of two frequencies that is a resonance: harmonics beyond it carry nothing that double sees.
constexpr double highest_ratio = 4096.0;

double to_double(const Quad& value) { return value.convert_to<double>(); }

/// The Jacobian at the fixed point nearest to `point`.
QuadMatrix jacobian_at(const systems::System& system, std::span<const double> point) {
  const auto d = static_cast<Eigen::Index>(system.dimension());
  const Eigen::Map<const Eigen::VectorXd> given(point.data(), d);
  const auto* quad = dynamic_cast<const systems::QuadSystem*>(&system);
  if (quad == nullptr) {
    Eigen::VectorXd f(d);
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> a(d, d);
    system.field_jacobian(1, point.data(), f.data(), a.data());
    return a.cast<Quad>();
  }
  QuadVector z = given.cast<Quad>();
  QuadVector f(d);
  QuadMatrix a(d, d);
  quad->linearize(z, f, a);
  for (int step = 0; step < polishing_steps; ++step) {
    const QuadVector newton = a.partialPivLu().solve(f);
    if (!(to_double(newton.norm()) <= longest_polishing * (1.0 + given.norm()))) break;
    z -= newton;
    quad->linearize(z, f, a);
  }
  return a;
}

/// D^-1 A D with powers of two on D's diagonal, so that the sums of the moduli in each row and column, the diagonal
/// left out, are near one another. What is rounding in quadruple precision says nothing.
QuadMatrix balanced(QuadMatrix a, QuadVector& scale) {
  const Eigen::Index d = a.rows();
  const Quad least = quad_rounding * a.norm();
  scale = QuadVector::Ones(d);
  for (bool settled = false; !settled;) {
    settled = true;
    for (Eigen::Index i = 0; i < d; ++i) {
      const Quad column = a.col(i).cwiseAbs().sum() - abs(a(i, i));
      const Quad row = a.row(i).cwiseAbs().sum() - abs(a(i, i));
      if (column <= least || row <= least) continue;
      Quad factor = 1;
      Quad scaled = column;
      for (; scaled < row / 2; scaled *= 4) factor *= 2;
      for (; scaled >= row * 2; scaled /= 4) factor /= 2;
      if ((scaled + row) / factor >= worth_scaling * (column + row)) continue;
      settled = false;
      scale(i) *= factor;
      a.col(i) *= factor;
      a.row(i) /= factor;
    }
  }
  return a;
}

struct Value {
  Quad re;
  Quad im;
};

double distance(const Value& a, const Value& b) { return std::hypot(to_double(a.re - b.re), to_double(a.im - b.im)); }

/// Eigenvalues that are taken for one.
struct Group {
  std::vector<Value> members;
  Value mean;
  int parts = 1;           ///< groups that it was joined from
  bool defective = false;  ///< with fewer eigenvectors than members; they are not computed
  Eigen::MatrixXcd right;  ///< eigenvectors of the balanced matrix, orthonormal
  double bound = 0.0;      ///< how far `entry_rounding` could move the mean

  [[nodiscard]] int count() const { return static_cast<int>(members.size()); }
};

/// Of a matrix with more rows the vectors are found all at once: the kernel of one costs as much. With vectors found so
/// a branch of the pendulum with m2 = 1e6, which rounding decides, ended at T = 10.3; one by one it goes to 10.4.
constexpr Eigen::Index one_by_one = 24;

/// Eigenvalues of a matrix, and its eigenvectors.
class Eigenpairs {
 public:
  explicit Eigenpairs(const QuadMatrix& matrix) : _solver(matrix, true) {
    if (_solver.info() != Eigen::Success)
      throw core::NumericalError(
          "the eigenvalues of the Jacobian at a fixed point: the QR iteration does not converge");
  }

  [[nodiscard]] Eigen::Index size() const { return _solver.eigenvalues().size(); }
  [[nodiscard]] Value value(Eigen::Index i) const {
    return {_solver.eigenvalues()(i).real(), _solver.eigenvalues()(i).imag()};
  }

  /// The eigenvector, of unit length, of the eigenvalue nearest to `value`, from which all others are told apart.
  [[nodiscard]] Eigen::MatrixXcd vector_of(const Value& value) const {
    Eigen::Index nearest = 0;
    for (Eigen::Index i = 1; i < size(); ++i)
      if (distance(this->value(i), value) < distance(this->value(nearest), value)) nearest = i;
    // Of a conjugate pair, which has two columns, the first one is that with the positive imaginary part.
    const Quad im = this->value(nearest).im;
    const Eigen::Index first = im < 0 ? nearest - 1 : nearest;
    Eigen::VectorXcd vector(size());
    vector.real() = _solver.pseudoEigenvectors().col(first).cast<double>();
    vector.imag().setZero();
    if (im != 0) vector.imag() = _solver.pseudoEigenvectors().col(first + 1).cast<double>();
    if (im < 0) vector = vector.conjugate().eval();
    // In the phase in which its largest entry is real: those of a reversible system are real or imaginary then.
    Eigen::Index largest = 0;
    vector.cwiseAbs().maxCoeff(&largest);
    return (vector / vector(largest)).normalized();
  }

 private:
  Eigen::EigenSolver<QuadMatrix> _solver;
};

class Spectrum {
 public:
  explicit Spectrum(const QuadMatrix& jacobian) : _a(balanced(jacobian, _scale)), _right(_a), _left(_a.transpose()) {
    _moduli = _a.cwiseAbs().cast<double>();
    _rounding = entry_rounding * _moduli.norm();
    for (Eigen::Index i = 0; i < _right.size(); ++i) _values.push_back(_right.value(i));
  }

  /// Groups that rounding tells apart, and in `undecided` those of which it does not.
  [[nodiscard]] std::vector<Group> groups(std::vector<UndecidedEigenvalues>& undecided) const {
    std::vector<Group> near;
    for (const Value& value : _values) {
      Group& group = near.emplace_back();
      group.members = {value};
      group.mean = value;
    }
    near =
        joined(std::move(near), [&](const Group& a, const Group& b) { return distance(a.mean, b.mean) <= _rounding; });
    for (Group& group : near) analyse(group);
    std::vector<Group> linked =
        joined(near, [](const Group& a, const Group& b) { return distance(a.mean, b.mean) <= a.bound + b.bound; });
    std::vector<Group> decided;
    for (Group& group : linked) {
      if (group.parts > 1) analyse(group);
      // Real ones do not oscillate, with or without their vectors; a Jordan block at zero is one of a translation.
      const bool real = std::abs(to_double(group.mean.im)) <= group.bound;
      const bool away = std::abs(to_double(group.mean.re)) > group.bound;
      if (!group.defective || (real && (away || group.parts == 1)))
        decided.push_back(std::move(group));
      else if (real || group.mean.im > 0)
        undecided.push_back({{to_double(group.mean.re), to_double(group.mean.im)},
                             group.count(),
                             group.parts == 1 ? Doubt::defective : Doubt::unresolved});
    }
    return decided;
  }

  /// Vectors of the balanced matrix in the coordinates of the system, orthonormal.
  [[nodiscard]] Eigen::MatrixXcd in_coordinates(const Eigen::MatrixXcd& vectors) const {
    const Eigen::VectorXd scale = (_scale / _scale.maxCoeff()).cast<double>();
    return span_of(scale.cast<std::complex<double>>().asDiagonal() * vectors, vectors.cols());
  }

 private:
  /// Groups of which one can be reached from another by steps between `linked` ones; a single one as it is.
  template <class Linked>
  static std::vector<Group> joined(const std::vector<Group>& groups, const Linked& linked) {
    std::vector<std::size_t> label(groups.size());
    for (std::size_t i = 0; i < label.size(); ++i) label[i] = i;
    for (std::size_t i = 0; i < groups.size(); ++i)
      for (std::size_t j = 0; j < i; ++j)
        if (linked(groups[i], groups[j])) {
          const std::size_t from = label[i];
          for (std::size_t& l : label)
            if (l == from) l = label[j];
        }
    std::vector<Group> out;
    for (std::size_t first = 0; first < groups.size(); ++first) {
      Group group;
      group.parts = static_cast<int>(std::count(label.begin(), label.end(), first));
      if (group.parts == 0) continue;
      if (group.parts == 1) {
        out.push_back(groups[first]);
        out.back().parts = 1;
        continue;
      }
      for (std::size_t i = 0; i < groups.size(); ++i)
        if (label[i] == first)
          group.members.insert(group.members.end(), groups[i].members.begin(), groups[i].members.end());
      group.mean = {0, 0};
      for (const Value& value : group.members) {
        group.mean.re += value.re / group.count();
        group.mean.im += value.im / group.count();
      }
      out.push_back(std::move(group));
    }
    return out;
  }

  /// Orthonormal columns that span `rank` directions of others, which have no more: by Gram and Schmidt's method, the
  /// longest first. Rows are not mixed: where balancing has made a coordinate small it may be 1e-17 of the others and
  /// mean something.
  static Eigen::MatrixXcd span_of(Eigen::MatrixXcd vectors, Eigen::Index rank) {
    Eigen::MatrixXcd out(vectors.rows(), rank);
    for (Eigen::Index n = 0; n < rank; ++n) {
      Eigen::Index longest = 0;
      vectors.colwise().norm().maxCoeff(&longest);
      Eigen::VectorXcd next = vectors.col(longest).normalized();
      for (Eigen::Index m = 0; m < n; ++m) next -= out.col(m) * out.col(m).dot(next);
      out.col(n) = next.normalized();
      for (Eigen::Index m = 0; m < vectors.cols(); ++m) vectors.col(m) -= out.col(n) * out.col(n).dot(vectors.col(m));
    }
    return out;
  }

  /// The kernel of matrix - value, `count` columns; `defect` is the largest of the pivots that should vanish.
  static Eigen::MatrixXcd kernel(const QuadMatrix& matrix, const Value& value, int count, double& defect) {
    const Eigen::Index d = matrix.rows();
    // As real equations for real and imaginary part: each kernel vector shows twice, as v and i v.
    QuadMatrix whole(2 * d, 2 * d);
    const QuadMatrix shifted = matrix - value.re * QuadMatrix::Identity(d, d);
    whole << shifted, value.im * QuadMatrix::Identity(d, d), -value.im * QuadMatrix::Identity(d, d), shifted;
    const Eigen::ColPivHouseholderQR<QuadMatrix> factors(whole.transpose());
    defect = to_double(abs(factors.matrixQR()(2 * (d - count), 2 * (d - count))));
    const QuadMatrix frame = factors.householderQ();
    const Eigen::MatrixXd last = frame.rightCols(2 * count).cast<double>();
    Eigen::MatrixXcd vectors(d, 2 * count);
    vectors.real() = last.topRows(d);
    vectors.imag() = last.bottomRows(d);
    return span_of(vectors, count);
  }

  void analyse(Group& group) const {
    double spread = 0.0;
    for (const Value& value : group.members) spread = std::max(spread, distance(value, group.mean));
    double defect_right = 0.0;
    double defect_left = 0.0;
    const Value conjugate{group.mean.re, -group.mean.im};
    const bool simple = group.count() == 1 && _a.rows() > one_by_one;
    group.right = simple ? _right.vector_of(group.mean) : kernel(_a, group.mean, group.count(), defect_right);
    const Eigen::MatrixXcd left =
        simple ? _left.vector_of(conjugate) : kernel(_a.transpose(), conjugate, group.count(), defect_left);
    const Eigen::VectorXd overlap = Eigen::JacobiSVD<Eigen::MatrixXcd>(left.adjoint() * group.right).singularValues();
    const double overlapping = overlap(overlap.size() - 1);
    const double weight = (left.cwiseAbs().transpose() * _moduli * group.right.cwiseAbs()).norm();
    // To first order, and no more than the eigenvalues of a Jordan block move.
    group.bound = std::min(entry_rounding * weight / overlapping,
                           _moduli.norm() * std::pow(entry_rounding, 1.0 / std::max(group.count(), 2)));
    // Members of a group with all its vectors are spread by what moved them, and M by no more; one without has a vector
    // that M maps to something of the size of A.
    const double vanishing = _rounding + group.count() * spread;
    group.defective = group.count() > 1 && std::max(defect_right, defect_left) > vanishing;
    if (group.defective) group.bound = _moduli.norm() * std::pow(entry_rounding, 1.0 / group.count());
  }

  QuadVector _scale;
  QuadMatrix _a;
  Eigenpairs _right;
  Eigenpairs _left;  ///< those of the transpose
  Eigen::MatrixXd _moduli;
  double _rounding = 0.0;
  std::vector<Value> _values;
};

/// Whether lambda and -lambda are eigenvalues alike: A is Hamiltonian, or anticommutes with a reversor, or has a
/// quadratic form that it conserves.
bool has_pairs(const systems::System& system, std::span<const double> point) {
  const systems::Structure& structure = system.structure();
  if (structure.symplectic || structure.conservative()) return true;
  const Eigen::VectorXd z = Eigen::Map<const Eigen::VectorXd>(point.data(), static_cast<Eigen::Index>(point.size()));
  return std::any_of(structure.reversors.begin(), structure.reversors.end(), [&](const systems::Symmetry& r) {
    Eigen::VectorXd gap = r.map(z) - z;
    for (const int i : structure.angles) gap(i) = std::remainder(gap(i), 2.0 * std::numbers::pi);
    return gap.norm() < kept_point * (1.0 + z.norm());
  });
}

Oscillation oscillation_of(const QuadMatrix& jacobian, const Group& group, Eigen::MatrixXcd kernel) {
  const Quad turn = boost::math::constants::two_pi<Quad>();
  Oscillation out;
  out.period = to_double(turn / group.mean.im);
  out.period_error = out.period * group.bound / to_double(group.mean.im);
  const Quad rate = turn / Quad(out.period);
  for (Eigen::Index n = 0; n < kernel.cols(); ++n) {
    const QuadVector re = kernel.col(n).real().cast<Quad>();
    const QuadVector im = kernel.col(n).imag().cast<Quad>();
    const QuadVector first = -rate * im - jacobian * re;
    const QuadVector second = rate * re - jacobian * im;
    out.residual = std::max(out.residual, std::hypot(to_double(first.norm()), to_double(second.norm())));
  }
  out.kernel = std::move(kernel);
  return out;
}

std::vector<Resonance> resonances_of(const std::vector<Oscillation>& oscillations) {
  std::vector<Resonance> out;
  for (std::size_t slow = 0; slow < oscillations.size(); ++slow)
    for (std::size_t fast = slow + 1; fast < oscillations.size(); ++fast) {
      const Oscillation& a = oscillations[slow];
      const Oscillation& b = oscillations[fast];
      const double ratio = std::round(a.period / b.period);
      if (ratio < 2.0 || ratio > highest_ratio) continue;
      if (std::abs(a.period - ratio * b.period) <= a.period_error + ratio * b.period_error)
        out.push_back({slow, fast, static_cast<int>(ratio)});
    }
  return out;
}

}  // namespace

double UndecidedEigenvalues::period() const { return 2.0 * std::numbers::pi / std::abs(mean.imag()); }

std::string to_text(const UndecidedEigenvalues& eigenvalues) {
  switch (eigenvalues.doubt) {
    case Doubt::defective:
      return fmt::format(
          "{} eigenvalues of the Jacobian are one, with fewer oscillations: the linear problem does not "
          "tell which families start here",
          eigenvalues.count);
    case Doubt::unresolved:
      return fmt::format(
          "rounding does not tell {} eigenvalues of the Jacobian apart, nor how many oscillations they "
          "have: no family is started here",
          eigenvalues.count);
    case Doubt::real_part:
      return "an eigenvalue of the Jacobian whose real part is rounding, and nothing that holds it at zero: no family "
             "is started here";
  }
  return "";
}

std::string to_text(LinearStability stability) {
  switch (stability) {
    case LinearStability::elliptic: return "elliptic";
    case LinearStability::stable: return "stable";
    case LinearStability::unstable: return "unstable";
    case LinearStability::neutral: return "neutral";
    case LinearStability::undecided: return "undecided";
  }
  return "";
}

LinearStability stability_of(const LinearModes& modes) {
  if (!modes.rest.empty() && modes.rest.front().real() > 0.0) return LinearStability::unstable;
  if (!modes.undecided.empty()) return LinearStability::undecided;
  if (modes.rest.empty()) return LinearStability::elliptic;
  return modes.oscillations.empty() && modes.rest.front().real() < 0.0 ? LinearStability::stable
                                                                       : LinearStability::neutral;
}

LinearModes linear_modes(const systems::System& system, std::span<const double> fixed_point) {
  core::require(fixed_point.size() == static_cast<std::size_t>(system.dimension()),
                "a fixed point of another dimension");
  const QuadMatrix jacobian = jacobian_at(system, fixed_point);
  if (!jacobian.cast<double>().allFinite()) throw core::NotFiniteError("the Jacobian at a fixed point is not finite");
  const Spectrum spectrum(jacobian);
  const bool pairs = has_pairs(system, fixed_point);
  LinearModes modes;
  const std::vector<Group> groups = spectrum.groups(modes.undecided);
  for (const Group& group : groups) {
    const double re = to_double(group.mean.re);
    const double im = to_double(group.mean.im);
    if (std::abs(re) > group.bound || std::abs(im) <= group.bound) {
      const bool zero = std::abs(re) <= group.bound;
      modes.rest.insert(modes.rest.end(), group.members.size(), zero ? std::complex<double>() : std::complex(re, im));
      continue;
    }
    if (im < 0.0) continue;  // its conjugate says the same
    // With lambda, -conj(lambda) is an eigenvalue. If no other is nearer to it than lambda itself, they are one, and
    // the real part is zero.
    const Value mirror{-group.mean.re, group.mean.im};
    const bool alone = std::all_of(groups.begin(), groups.end(), [&](const Group& other) {
      return distance(other.mean, mirror) >= 2.0 * std::abs(re);
    });
    if (pairs && alone)
      modes.oscillations.push_back(oscillation_of(jacobian, group, spectrum.in_coordinates(group.right)));
    else
      modes.undecided.push_back({{re, im}, group.count(), Doubt::real_part});
  }
  std::sort(modes.oscillations.begin(), modes.oscillations.end(),
            [](const Oscillation& a, const Oscillation& b) { return a.period > b.period; });
  std::sort(modes.rest.begin(), modes.rest.end(), [](const std::complex<double>& a, const std::complex<double>& b) {
    return a.real() != b.real() ? a.real() > b.real() : a.imag() < b.imag();
  });
  modes.resonances = resonances_of(modes.oscillations);
  modes.stability = stability_of(modes);
  return modes;
}

}  // namespace orbweaver::starts
