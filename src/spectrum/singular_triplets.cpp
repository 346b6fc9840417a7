#include "orbweaver/spectrum/singular_triplets.hpp"

#include <fmt/format.h>
#include <slepcsvd.h>

#include "orbweaver/core/error.hpp"
#include "orbweaver/core/log/log_stage.hpp"
#include "orbweaver/core/petsc/check.hpp"
#include "orbweaver/loss/dense.hpp"
#include "orbweaver/numerics/decompositions.hpp"
#include "start_vector.hpp"

namespace orbweaver::spectrum {

SingularTriplets smallest_singular_triplets(const core::Handle<Mat>& matrix, int count) {
  const core::LogStage stage(core::Stage::spectrum);
  Eigen::MatrixXd j;
  loss::with_dense_array(matrix, [&](loss::DenseMap map) { j = map; });
  core::require(j.rows() >= j.cols(), "singular triplets need at least as many rows as columns");
  core::require(count >= 1 && count <= j.cols(), "between one and all singular triplets can be asked for");
  if (!j.allFinite())
    throw core::NotFiniteError("the Jacobian whose smallest singular values are wanted is not finite");

  const int n = static_cast<int>(j.cols());
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(j);
  core::Handle<Mat> triangle = loss::create_dense(n, n);
  loss::with_dense_array(triangle,
                         [&](loss::DenseMap r) { r = qr.matrixQR().topRows(n).triangularView<Eigen::Upper>(); });

  core::Handle<SVD> svd;
  core::check(SVDCreate(PETSC_COMM_SELF, svd.put()), "SVDCreate");
  core::check(SVDSetOperators(svd.get(), triangle.get(), nullptr), "SVDSetOperators");
  core::check(SVDSetType(svd.get(), SVDLAPACK), "SVDSetType");
  core::check(SVDSetWhichSingularTriplets(svd.get(), SVD_SMALLEST), "SVDSetWhichSingularTriplets");
  core::check(SVDSetDimensions(svd.get(), count, PETSC_DEFAULT, PETSC_DEFAULT), "SVDSetDimensions");
  core::check(SVDSetOptionsPrefix(svd.get(), "spectrum_"), "SVDSetOptionsPrefix");
  core::check(SVDSetFromOptions(svd.get()), "SVDSetFromOptions");
  core::check(SVDSolve(svd.get()), "SVDSolve");
  PetscInt converged = 0;
  core::check(SVDGetConverged(svd.get(), &converged), "SVDGetConverged");
  if (converged < count)
    throw core::NumericalError(fmt::format("only {} of {} smallest singular triplets of a {} x {} Jacobian converged",
                                           converged, count, j.rows(), n));

  SingularTriplets out;
  out.right.resize(n, count);
  out.left.resize(j.rows(), count);
  const core::Handle<Vec> u = loss::create_vector(n);
  const core::Handle<Vec> v = loss::create_vector(n);
  for (int m = 0; m < count; ++m) {
    PetscReal sigma = 0.0;
    core::check(SVDGetSingularTriplet(svd.get(), m, &sigma, u.get(), v.get()), "SVDGetSingularTriplet");
    const Eigen::VectorXd right = loss::to_eigen(v.get());
    const Eigen::VectorXd fixed = with_fixed_sign(right);
    const double sign = fixed.dot(right) < 0.0 ? -1.0 : 1.0;
    Eigen::VectorXd left = Eigen::VectorXd::Zero(j.rows());
    left.head(n) = sign * loss::to_eigen(u.get());
    left.applyOnTheLeft(qr.householderQ());
    out.values.push_back(sigma);
    out.right.col(m) = fixed;
    out.left.col(m) = left;
    out.residuals.push_back((j * fixed - sigma * left).norm());
    out.left_residuals.push_back((j.transpose() * left - sigma * fixed).norm());
  }
  return out;
}

}  // namespace orbweaver::spectrum
