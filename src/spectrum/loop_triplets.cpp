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
core::Handle<Vec> smooth_start(const equations::LoopEquations& equations) {
  const loss::Unknowns& unknowns = equations.unknowns();
  core::Handle<Vec> start = start_vector(unknowns.size());
  Eigen::VectorXd values = loss::to_eigen(start.get());
  for (int n = 0; n < unknowns.subspace.size(); ++n) values(n) /= std::pow(1.0 + unknowns.subspace.harmonic(n), 2);
  loss::assign(start.get(), equations.slice().expand(equations.slice().reduce(values)));
  return start;
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
  const core::Handle<Vec> start = smooth_start(inverse.equations);
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

/// Inverse iterations on a triplet, and what each may leave of its residuals to be followed by another. Beside kernels
/// at 1e-14 each was seen to leave 0.2 to 0.4 (m2 = 16/9 m1).
constexpr int most_cleanings = 12;
constexpr double cleaned = 0.7;

// Looks for `count` more triplets beside those found, and adds at least one.
void search(Inverse& inverse, std::vector<Triplet>& found, int count, double tolerance) {
  const std::size_t before = found.size();
  const double rate = inverse.equations.linearization().rate();
  const auto acceptable = [&](const Triplet& t) { return std::max(share_of_value * t.value, share_of_rate * rate); };
  const auto good = [&](const Triplet& t) { return std::max(t.residual, t.left_residual) <= acceptable(t); };
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
    append_column(inverse.right, t.right);
    append_column(inverse.left, t.left);
    found.push_back(std::move(t));
  }
  if (found.size() == before)
    throw core::NumericalError(
        fmt::format("after {} of a loop's smallest singular triplets: {}; the loop is far from an orbit, or its cutoff "
                    "too small",
                    before, failure));
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
  Inverse inverse{equations,
                  equations::LoopSolver(equations.size(), "spectrum_inner_"),
                  {options.inner_tolerance, 1.0, share_of_rate * equations.linearization().rate()},
                  Eigen::MatrixXd(unknowns, 0),
                  Eigen::MatrixXd(rows, 0)};

  std::vector<Triplet> found;
  const auto wanted = static_cast<std::size_t>(options.count);
  while (found.size() < wanted) search(inverse, found, static_cast<int>(wanted - found.size()), options.tolerance);
  while (options.multiple && static_cast<int>(found.size()) < free) {
    const double largest = found[order_of(found)[wanted - 1]].value;
    search(inverse, found, 1, options.tolerance);
    if (found.back().value >= largest) break;
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
