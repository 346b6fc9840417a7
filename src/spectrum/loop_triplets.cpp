#include "orbweaver/spectrum/loop_triplets.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <slepcsvd.h>

#include "orbweaver/core/error.hpp"
#include "orbweaver/core/log/log_stage.hpp"
#include "orbweaver/core/petsc/callback.hpp"
#include "orbweaver/core/petsc/check.hpp"
#include "orbweaver/equations/loop_solver.hpp"
#include "orbweaver/loss/assembled.hpp"
#include "orbweaver/loss/dense.hpp"
#include "orbweaver/numerics/decompositions.hpp"
#include "start_vector.hpp"

namespace orbweaver::spectrum {

namespace {

// Residuals of a triplet that counts as found: of its value (which then is right to 1e-7), or of 2 pi / T where it is
// tiny.
constexpr double share_of_value = 3e-4;
constexpr double share_of_rate = 1e-6;

// Unknowns of a dense matrix: with its rows, twice as many, and the factors of both decompositions some 0.7 GB.
constexpr int most_dense = 4000;

// Krylov vectors: convergence is looked at once they are all there, and half of them are kept at a restart.
int basis_size(int count) { return 2 * count + 4; }

// The pseudo-inverse of J on the slice (docs/mathematics.md, "Singular triplets"), without the triplets found already.
struct Inverse {
  const equations::LoopEquations& equations;
  equations::LoopSolver solver;
  equations::LoopSolver::Accuracy accuracy;
  Eigen::MatrixXd right;  // found: unknowns x count
  Eigen::MatrixXd left;   // found: rows x count
  core::CallbackGuard guard{};

  [[nodiscard]] int rows() const { return equations.linearization().rows(); }
  [[nodiscard]] int unknowns() const { return equations.unknowns().size(); }

  [[nodiscard]] Eigen::VectorXd apply(Eigen::VectorXd y) {
    y -= left * (left.transpose() * y);
    Eigen::VectorXd right_side = Eigen::VectorXd::Zero(equations.size());
    equations.project_rows(y, right_side.head(equations.image().size()));
    Eigen::VectorXd u = solver.solve(equations, right_side, accuracy).head(unknowns());
    u -= right * (right.transpose() * u);
    return u;
  }
  [[nodiscard]] Eigen::VectorXd apply_transposed(Eigen::VectorXd u) {
    u -= right * (right.transpose() * u);
    Eigen::VectorXd right_side = Eigen::VectorXd::Zero(equations.size());
    right_side.head(u.size()) = u;
    const Eigen::VectorXd solution = solver.solve_transposed(equations, right_side, accuracy);
    Eigen::VectorXd y(rows());
    equations.project_rows_transposed(solution.head(equations.image().size()), y);
    y -= left * (left.transpose() * y);
    return y;
  }
};

template <bool transposed>
PetscErrorCode multiply(Mat matrix, Vec x, Vec y) {
  void* context = nullptr;
  PetscCall(MatShellGetContext(matrix, &context));
  auto& inverse = *static_cast<Inverse*>(context);
  return inverse.guard.run([&] {
    const Eigen::VectorXd in = loss::to_eigen(x);
    loss::assign(y, transposed ? inverse.apply_transposed(in) : inverse.apply(in));
  });
}

// The transposed inverse: SLEPc wants at least as many rows as columns.
core::Handle<Mat> shell_of(Inverse& inverse) {
  const int rows = inverse.rows();
  const int columns = inverse.unknowns();
  core::Handle<Mat> matrix;
  core::check(MatCreateShell(PETSC_COMM_SELF, rows, columns, rows, columns, &inverse, matrix.put()), "MatCreateShell");
  core::check(MatShellSetOperation(matrix.get(), MATOP_MULT, reinterpret_cast<void (*)()>(multiply<true>)),
              "MatShellSetOperation");
  core::check(MatShellSetOperation(matrix.get(), MATOP_MULT_TRANSPOSE, reinterpret_cast<void (*)()>(multiply<false>)),
              "MatShellSetOperation");
  return matrix;
}

// Smooth, as the vectors that are sought, without symmetry, and in the slice.
Eigen::VectorXd smooth_start(const equations::LoopEquations& equations, int number = 0) {
  const loss::Unknowns& unknowns = equations.unknowns();
  Eigen::VectorXd values = loss::to_eigen(start_vector(unknowns.size(), number).get());
  for (int n = 0; n < unknowns.subspace.size(); ++n) values(n) /= std::pow(1.0 + unknowns.subspace.harmonic(n), 2);
  return equations.slice().expand(equations.slice().reduce(values));
}

std::span<const double> view(const Eigen::VectorXd& v) { return {v.data(), static_cast<std::size_t>(v.size())}; }
Eigen::VectorXd vector_of(const std::vector<double>& v) {
  return loss::ConstVectorMap(v.data(), static_cast<Eigen::Index>(v.size()));
}

struct Triplet {
  double value = 0.0;
  Eigen::VectorXd right;  // unknowns, in the slice
  Eigen::VectorXd left;   // rows of J
  double residual = 0.0;
  double left_residual = 0.0;
};

// sigma = |J v|: off by the square of v's error.
Triplet triplet_of(const equations::LoopEquations& equations, const Eigen::VectorXd& right,
                   const Eigen::VectorXd& left) {
  const loss::Linearization& linearization = equations.linearization();
  const loss::Slice& slice = equations.slice();
  Triplet t;
  t.right = with_fixed_sign(slice.expand(slice.reduce(right)).normalized());
  t.left = (t.right.dot(right) < 0.0 ? -left : left).normalized();
  const Eigen::VectorXd jv = vector_of(linearization.apply_jacobian(equations.unknowns(), view(t.right)));
  const Eigen::VectorXd ju = vector_of(linearization.apply_jacobian_transposed(equations.unknowns(), view(t.left)));
  t.value = jv.norm();
  t.residual = (jv - t.value * t.left).norm();
  t.left_residual = (slice.reduce(ju) - t.value * slice.reduce(t.right)).norm();
  return t;
}

// The largest triplets of the inverse, as SLEPc finds them.
std::vector<Triplet> largest_of(Inverse& inverse, int count, double tolerance) {
  const core::Handle<Mat> shell = shell_of(inverse);
  core::Handle<SVD> svd;
  core::check(SVDCreate(PETSC_COMM_SELF, svd.put()), "SVDCreate");
  core::check(SVDSetOperators(svd.get(), shell.get(), nullptr), "SVDSetOperators");
  core::check(SVDSetType(svd.get(), SVDTRLANCZOS), "SVDSetType");
  core::check(SVDSetWhichSingularTriplets(svd.get(), SVD_LARGEST), "SVDSetWhichSingularTriplets");
  core::check(SVDSetDimensions(svd.get(), count, std::min(basis_size(count), inverse.unknowns()), PETSC_DEFAULT),
              "SVDSetDimensions");
  core::check(SVDSetTolerances(svd.get(), tolerance, PETSC_DEFAULT), "SVDSetTolerances");
  const core::Handle<Vec> start = loss::create_vector(inverse.unknowns());
  loss::assign(start.get(), smooth_start(inverse.equations));
  Vec raw = start.get();
  core::check(SVDSetInitialSpaces(svd.get(), 1, &raw, 0, nullptr), "SVDSetInitialSpaces");
  BV basis[2] = {nullptr, nullptr};
  core::check(SVDGetBV(svd.get(), &basis[0], &basis[1]), "SVDGetBV");
  for (BV each : basis) seed_basis(each);
  core::check(SVDSetOptionsPrefix(svd.get(), "spectrum_loop_"), "SVDSetOptionsPrefix");
  core::check(SVDSetFromOptions(svd.get()), "SVDSetFromOptions");
  const PetscErrorCode code = SVDSolve(svd.get());
  inverse.guard.rethrow();
  core::check(code, "SVDSolve");
  PetscInt converged = 0;
  core::check(SVDGetConverged(svd.get(), &converged), "SVDGetConverged");

  std::vector<Triplet> out;
  const core::Handle<Vec> right = loss::create_vector(inverse.equations.unknowns().size());
  const core::Handle<Vec> left = loss::create_vector(inverse.rows());
  for (int n = 0; n < std::min(count, static_cast<int>(converged)); ++n) {
    PetscReal value = 0.0;
    core::check(SVDGetSingularTriplet(svd.get(), n, &value, left.get(), right.get()), "SVDGetSingularTriplet");
    out.push_back(triplet_of(inverse.equations, loss::to_eigen(right.get()), loss::to_eigen(left.get())));
  }
  return out;
}

void append_column(Eigen::MatrixXd& matrix, const Eigen::VectorXd& column) {
  matrix.conservativeResize(Eigen::NoChange, matrix.cols() + 1);
  matrix.col(matrix.cols() - 1) = column;
}

bool is_good(const Triplet& t, double rate) {
  return std::max(t.residual, t.left_residual) <= std::max(share_of_value * t.value, share_of_rate * rate);
}

void add(Inverse& inverse, std::vector<Triplet>& found, Triplet t) {
  append_column(inverse.right, t.right);
  append_column(inverse.left, t.left);
  found.push_back(std::move(t));
}

/// Of I - C'(A + B C')^-1 B = (I + C' A^-1 B)^-1, which is about sigma / rate over the parts of u and v in B and C: a
/// block that leaves more holds nothing nearly flat (kernels of the double pendulum leave 4e-8 to 4e-4, sectors without
/// one 0.03 and more).
constexpr double nearly_flat = 1e-2;
/// The first solve only tells that, and the next one takes out what it is wrong by. What the others are wrong by stays
/// in the vectors: A itself is known to 1e-10 of the rate at best, the tolerance of orbits.
constexpr equations::LoopSolver::Accuracy of_first_solve{1e-4, 1e-2, 0.0};
constexpr equations::LoopSolver::Accuracy of_flat_vectors{1e-11, 1e-8, 0.0};

Eigen::MatrixXd orthonormal(const Eigen::MatrixXd& columns) {
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(columns);
  return qr.householderQ() * Eigen::MatrixXd::Identity(columns.rows(), columns.cols());
}

/// Inverse iteration with a block of vectors, for triplets whose values are nearly zero: on A + B C', which is regular,
/// and (A + B C')^-1 B spans what A^-1 B spans (docs/mathematics.md, "Singular triplets").
class FlatTriplets {
 public:
  FlatTriplets(Inverse& inverse, int count) : _inverse(inverse), _equations(inverse.equations), _count(count) {}

  /// Adds those that are triplets by their residuals: all, some or none of the block.
  void find(std::vector<Triplet>& found) {
    const double rate = _equations.linearization().rate();
    Eigen::MatrixXd right(_inverse.unknowns(), _count);
    for (int n = 0; n < _count; ++n) right.col(n) = smooth_start(_equations, n);
    right = orthonormal(right);
    Eigen::MatrixXd columns = rate * padded(orthonormal(right.topRows(_equations.image().size())));
    Eigen::MatrixXd rows = padded(right);
    _inverse.solver.raise({columns, rows});
    const Eigen::MatrixXd first = solve(rows, true, of_first_solve);
    const Eigen::MatrixXd remains = Eigen::MatrixXd::Identity(_count, _count) - columns.transpose() * first;
    if (!(Eigen::JacobiSVD<Eigen::MatrixXd>(remains).singularValues().minCoeff() < nearly_flat)) return;

    columns = rate * padded(orthonormal(projected(left_of(first))));
    _inverse.solver.raise({columns, rows});
    right = orthonormal(solve(columns, false, of_flat_vectors).topRows(right.rows()));
    rows = padded(right);
    _inverse.solver.raise({columns, rows});
    Eigen::MatrixXd left = left_of(solve(rows, true, of_flat_vectors));

    Eigen::MatrixXd images(_inverse.rows(), _count);
    for (int n = 0; n < _count; ++n) {
      const Eigen::VectorXd v = right.col(n);
      images.col(n) = vector_of(_equations.linearization().apply_jacobian(_equations.unknowns(), view(v)));
    }
    const Eigen::JacobiSVD<Eigen::MatrixXd> ritz(left.transpose() * images, Eigen::ComputeFullU | Eigen::ComputeFullV);
    right *= ritz.matrixV();
    left *= ritz.matrixU();
    for (int n = _count; n-- > 0;) {
      Triplet t = triplet_of(_equations, right.col(n), left.col(n));
      if (is_good(t, rate)) add(_inverse, found, std::move(t));
    }
  }

 private:
  [[nodiscard]] Eigen::MatrixXd padded(const Eigen::MatrixXd& columns) const {
    Eigen::MatrixXd out = Eigen::MatrixXd::Zero(_equations.size(), columns.cols());
    out.topRows(columns.rows()) = columns;
    return out;
  }

  [[nodiscard]] Eigen::MatrixXd solve(const Eigen::MatrixXd& right_sides, bool transposed,
                                      equations::LoopSolver::Accuracy accuracy) {
    Eigen::MatrixXd out(right_sides.rows(), right_sides.cols());
    for (Eigen::Index n = 0; n < out.cols(); ++n)
      out.col(n) = transposed ? _inverse.solver.solve_transposed(_equations, right_sides.col(n), accuracy)
                              : _inverse.solver.solve(_equations, right_sides.col(n), accuracy);
    return out;
  }

  /// Rows of J from solutions of the transposed equations.
  [[nodiscard]] Eigen::MatrixXd left_of(const Eigen::MatrixXd& solutions) const {
    Eigen::MatrixXd out(_inverse.rows(), solutions.cols());
    for (Eigen::Index n = 0; n < out.cols(); ++n)
      _equations.project_rows_transposed(solutions.col(n).head(_equations.image().size()), out.col(n));
    return orthonormal(out);
  }

  [[nodiscard]] Eigen::MatrixXd projected(const Eigen::MatrixXd& rows) const {
    Eigen::MatrixXd out(_equations.image().size(), rows.cols());
    for (Eigen::Index n = 0; n < out.cols(); ++n) _equations.project_rows(rows.col(n), out.col(n));
    return out;
  }

  Inverse& _inverse;
  const equations::LoopEquations& _equations;
  int _count;
};

/// What it does not find is left to the search.
void find_flat(Inverse& inverse, std::vector<Triplet>& found, int count) {
  try {
    FlatTriplets(inverse, count).find(found);
  } catch (const core::NumericalError&) {  // A + B C' is singular too: flat in more directions than were expected
  }
  inverse.solver.raise({});
}

/// Inverse iterations on a triplet, and what each may leave of its residuals to be followed by another. Beside kernels
/// at 1e-14 each was seen to leave 0.2 to 0.4 (m2 = 16/9 m1).
constexpr int most_cleanings = 12;
constexpr double cleaned = 0.7;

// Looks for `count` more triplets beside those found, and adds at least one.
void search(Inverse& inverse, std::vector<Triplet>& found, int count, double tolerance) {
  const std::size_t before = found.size();
  const double rate = inverse.equations.linearization().rate();
  const auto acceptable = [&](const Triplet& t) { return std::max(share_of_value * t.value, share_of_rate * rate); };
  const auto good = [&](const Triplet& t) { return is_good(t, rate); };
  std::string failure = "Krylov iterations did not converge";
  for (Triplet& t : largest_of(inverse, count, tolerance)) {
    // Tiny values leave the solves little but their own vectors, and Lanczos vectors mix: inverse iteration cleans
    // them.
    // Where one is found already, the next search finds the others better than these do.
    const int cleanings = found.size() == before ? most_cleanings : 1;
    for (int n = 0; n < cleanings && std::max(t.residual, t.left_residual) > share_of_value * t.value; ++n) {
      const double before_cleaning = std::max(t.residual, t.left_residual);
      try {
        const Eigen::VectorXd right = inverse.apply(inverse.apply_transposed(t.right).normalized()).normalized();
        t = triplet_of(inverse.equations, right, inverse.apply_transposed(right));
      } catch (const core::NumericalError&) {  // too singular for another solve: as clean as it gets
        break;
      }
      if (good(t) || !(std::max(t.residual, t.left_residual) < cleaned * before_cleaning)) break;
    }
    if (!good(t)) {
      failure = fmt::format("the next one ({:.3e}) has the residuals {:.1e} and {:.1e}, more than {:.1e}", t.value,
                            t.residual, t.left_residual, acceptable(t));
      break;
    }
    add(inverse, found, std::move(t));
  }
  if (found.size() == before)
    throw core::NumericalError(
        fmt::format("after {} of a loop's smallest singular triplets: {}; the loop is far from an orbit, or its cutoff "
                    "too small",
                    before, failure));
}

/// A + B C' from here on, with the vectors that are found: it has the others' triplets, and solves with it keep their
/// digits where A is singular to rounding.
void raise_found(Inverse& inverse, const std::vector<Triplet>& found) {
  const equations::LoopEquations& equations = inverse.equations;
  const auto count = static_cast<Eigen::Index>(found.size());
  Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(equations.size(), count);
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(equations.size(), count);
  for (Eigen::Index n = 0; n < count; ++n) {
    const Triplet& t = found[static_cast<std::size_t>(n)];
    Eigen::VectorXd image(equations.image().size());
    equations.project_rows(t.left, image);
    columns.col(n).head(image.size()) = equations.linearization().rate() * image;
    rows.col(n).head(t.right.size()) = t.right;
  }
  inverse.solver.raise({columns, rows});
}

std::vector<std::size_t> order_of(const std::vector<Triplet>& found) {
  std::vector<double> values;
  for (const Triplet& t : found) values.push_back(t.value);
  return ascending(values);
}

}  // namespace

SingularTriplets smallest_singular_triplets(const equations::LoopEquations& equations, const TripletOptions& options) {
  const core::LogStage stage(core::Stage::spectrum);
  const int unknowns = equations.unknowns().size();
  const int rows = equations.linearization().rows();
  const int free = equations.slice().free();
  core::require(options.count >= 1 && options.count <= free, "between one and all singular triplets can be asked for");
  core::require(options.nearly_flat >= 0 && options.nearly_flat < options.count,
                "beside triplets that are expected to be nearly flat one more is to be asked for");
  Inverse inverse{equations,
                  equations::LoopSolver(equations.size(), "spectrum_inner_"),
                  {options.inner_tolerance, 1.0, share_of_rate * equations.linearization().rate()},
                  Eigen::MatrixXd(unknowns, 0),
                  Eigen::MatrixXd(rows, 0)};

  std::vector<Triplet> found;
  const auto wanted = static_cast<std::size_t>(options.count);
  if (options.nearly_flat > 0) find_flat(inverse, found, options.nearly_flat);
  // A search finds the smallest values of what is left, multiple ones once: nothing smaller is missing where the last
  // value that it found is no smaller than those that are wanted.
  bool complete = false;
  bool is_raised = false;
  while (found.size() < wanted || (!complete && static_cast<int>(found.size()) < free)) {
    const int missing = found.size() < wanted ? static_cast<int>(wanted - found.size()) : 1;
    try {
      search(inverse, found, missing, options.tolerance);
    } catch (const core::NumericalError&) {
      if (is_raised || found.empty()) throw;
      raise_found(inverse, found);
      is_raised = true;
      continue;
    }
    complete = (!options.multiple || missing == 1) && found.size() >= wanted &&
               found.back().value >= found[order_of(found)[wanted - 1]].value;
  }

  SingularTriplets out;
  out.right.resize(unknowns, options.count);
  out.left.resize(rows, options.count);
  std::vector<std::size_t> order = order_of(found);
  order.resize(wanted);
  for (const std::size_t n : order) {
    const auto column = static_cast<Eigen::Index>(out.values.size());
    out.values.push_back(found[n].value);
    out.right.col(column) = found[n].right;
    out.left.col(column) = found[n].left;
    out.residuals.push_back(found[n].residual);
    out.left_residuals.push_back(found[n].left_residual);
  }
  out.inner_iterations = inverse.solver.iterations();
  return out;
}

SingularTriplets smallest_singular_triplets(const systems::System& system, const loop::Loop& loop,
                                            const loss::Unknowns& unknowns, const loss::Slice& slice,
                                            const TripletOptions& options) {
  const loop::Subspace image = unknowns.subspace.image();
  if (unknowns.size() >= options.krylov_from && equations::LoopEquations::are_square(system, unknowns, image, slice)) {
    equations::LoopEquations equations(system, loop, unknowns, image, slice,
                                       core::worth_dividing(options.team, system.dimension()));
    equations.factor(system, loop);
    return smallest_singular_triplets(equations, options);
  }
  const loss::Linearization linearization(system, loop, loss::Linearization::Order::jacobian, unknowns.scalars);
  if (unknowns.size() > most_dense)
    throw core::NumericalError(fmt::format(
        "singular triplets over {} unknowns by dense matrices: at most {} are affordable, and the matrix-free "
        "way needs as many equations",
        unknowns.size(), most_dense));
  SingularTriplets out =
      smallest_singular_triplets(slice.reduce_columns(loss::assemble_jacobian(linearization, unknowns)), options.count);
  Eigen::MatrixXd right(unknowns.size(), options.count);
  for (Eigen::Index n = 0; n < right.cols(); ++n) {
    const Eigen::VectorXd v = slice.expand(out.right.col(n));
    right.col(n) = with_fixed_sign(v);
    if (v.dot(right.col(n)) < 0.0) out.left.col(n) *= -1.0;
  }
  out.right = std::move(right);
  return out;
}

Eigenpairs smallest_eigenpairs(const systems::System& system, const loop::Loop& loop, const loss::Unknowns& unknowns,
                               const loss::Slice& slice, const TripletOptions& options) {
  const SingularTriplets triplets = smallest_singular_triplets(system, loop, unknowns, slice, options);
  const loss::Linearization linearization(system, loop, loss::Linearization::Order::jacobian, unknowns.scalars);
  Eigenpairs out;
  out.vectors = triplets.right;
  for (Eigen::Index n = 0; n < out.vectors.cols(); ++n) {
    const Eigen::VectorXd v = out.vectors.col(n);
    const double sigma = triplets.values[static_cast<std::size_t>(n)];
    const Eigen::VectorXd hv = vector_of(linearization.apply_hessian(unknowns, view(v), loss::Curvature::gauss_newton));
    out.values.push_back(2.0 * sigma * sigma);
    out.residuals.push_back((slice.reduce(hv) - out.values.back() * slice.reduce(v)).norm());
  }
  return out;
}

}  // namespace orbweaver::spectrum
