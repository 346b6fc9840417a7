#include "orbweaver/spectrum/eigenpairs.hpp"

#include <cmath>

#include <fmt/format.h>
#include <slepceps.h>

#include "orbweaver/core/error.hpp"
#include "orbweaver/core/log/log_stage.hpp"
#include "orbweaver/core/petsc/check.hpp"
#include "orbweaver/loss/dense.hpp"
#include "start_vector.hpp"

namespace orbweaver::spectrum {

namespace {

void shift_and_invert(EPS eps, double shift) {
  ST st = nullptr;
  KSP ksp = nullptr;
  PC pc = nullptr;
  core::check(EPSSetTarget(eps, shift), "EPSSetTarget");
  core::check(EPSSetWhichEigenpairs(eps, EPS_TARGET_MAGNITUDE), "EPSSetWhichEigenpairs");
  core::check(EPSGetST(eps, &st), "EPSGetST");
  core::check(STSetType(st, STSINVERT), "STSetType");
  core::check(STGetKSP(st, &ksp), "STGetKSP");
  core::check(KSPSetType(ksp, KSPPREONLY), "KSPSetType");
  core::check(KSPGetPC(ksp, &pc), "KSPGetPC");
  core::check(PCSetType(pc, PCLU), "PCSetType");
}

}  // namespace

Eigenpairs smallest_eigenpairs(const core::Handle<Mat>& matrix, const EigenOptions& options) {
  const core::LogStage stage(core::Stage::spectrum);
  PetscInt size = 0;
  core::check(MatGetSize(matrix.get(), &size, nullptr), "MatGetSize");
  core::require(options.count >= 1 && options.count <= size, "between one and all eigenpairs can be asked for");
  double norm = 0.0;
  core::check(MatNorm(matrix.get(), NORM_FROBENIUS, &norm), "MatNorm");
  if (!std::isfinite(norm))
    throw core::NotFiniteError("the matrix whose smallest eigenvalues are wanted is not finite");

  core::Handle<EPS> eps;
  core::check(EPSCreate(PETSC_COMM_SELF, eps.put()), "EPSCreate");
  core::check(EPSSetOperators(eps.get(), matrix.get(), nullptr), "EPSSetOperators");
  core::check(EPSSetProblemType(eps.get(), EPS_HEP), "EPSSetProblemType");
  core::check(EPSSetDimensions(eps.get(), options.count, PETSC_DEFAULT, PETSC_DEFAULT), "EPSSetDimensions");
  core::check(EPSSetTolerances(eps.get(), options.tolerance, PETSC_DEFAULT), "EPSSetTolerances");
  if (size <= options.lapack_below || norm == 0.0) {
    core::check(EPSSetType(eps.get(), EPSLAPACK), "EPSSetType");
    core::check(EPSSetWhichEigenpairs(eps.get(), EPS_SMALLEST_REAL), "EPSSetWhichEigenpairs");
  } else {
    // Closer to a singular H, rounding of size eps / shift in the solves drowns all but the smallest pairs.
    constexpr double safe_shift = 1e-8;  // about sqrt(eps)
    shift_and_invert(eps.get(), -safe_shift * norm);
    const core::Handle<Vec> start = start_vector(static_cast<int>(size));
    Vec raw = start.get();
    core::check(EPSSetInitialSpace(eps.get(), 1, &raw), "EPSSetInitialSpace");
    BV basis = nullptr;
    core::check(EPSGetBV(eps.get(), &basis), "EPSGetBV");
    seed_basis(basis);
  }
  core::check(EPSSetOptionsPrefix(eps.get(), "spectrum_"), "EPSSetOptionsPrefix");
  core::check(EPSSetFromOptions(eps.get()), "EPSSetFromOptions");
  core::check(EPSSolve(eps.get()), "EPSSolve");
  PetscInt converged = 0;
  core::check(EPSGetConverged(eps.get(), &converged), "EPSGetConverged");
  if (converged < options.count)
    throw core::NumericalError(fmt::format("only {} of {} smallest eigenpairs of a {} x {} Hessian converged",
                                           converged, options.count, size, size));

  Eigenpairs pairs;
  pairs.vectors.resize(size, options.count);
  const core::Handle<Vec> vector = loss::create_vector(static_cast<int>(size));
  const core::Handle<Vec> product = loss::create_vector(static_cast<int>(size));
  Eigen::MatrixXd vectors(size, options.count);
  std::vector<double> values;
  std::vector<double> residuals;
  for (int n = 0; n < options.count; ++n) {
    PetscScalar value = 0.0;
    core::check(EPSGetEigenpair(eps.get(), n, &value, nullptr, vector.get(), nullptr), "EPSGetEigenpair");
    const Eigen::VectorXd v = loss::to_eigen(vector.get()).normalized();
    loss::assign(vector.get(), v);
    core::check(MatMult(matrix.get(), vector.get(), product.get()), "MatMult");
    const Eigen::VectorXd hv = loss::to_eigen(product.get());
    // The Rayleigh quotient is of second order in the error of the vector.
    values.push_back(v.dot(hv));
    residuals.push_back((hv - values.back() * v).norm());
    vectors.col(n) = with_fixed_sign(v);
  }
  for (const std::size_t n : ascending(values)) {
    const auto column = static_cast<Eigen::Index>(pairs.values.size());
    pairs.values.push_back(values[n]);
    pairs.residuals.push_back(residuals[n]);
    pairs.vectors.col(column) = vectors.col(static_cast<Eigen::Index>(n));
  }
  return pairs;
}

}  // namespace orbweaver::spectrum
