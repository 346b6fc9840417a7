#include "orbweaver/spectrum/sliced_hessian.hpp"

#include <cmath>

#include <fmt/format.h>

#include "orbweaver/core/error.hpp"
#include "orbweaver/core/petsc/check.hpp"
#include "orbweaver/loss/assembled.hpp"
#include "orbweaver/loss/dense.hpp"

namespace orbweaver::spectrum {

namespace {

/// Added to the diagonal where the factorisation fails, relative to |H|: from rounding up to what would show in the
/// smallest eigenvalues.
constexpr double first_shift = 1e-15;
constexpr double largest_shift = 1e-9;
constexpr double shift_growth = 10.0;  // few factorisations, and no shift far above what was needed

}  // namespace

SlicedHessian::SlicedHessian(const loss::Linearization& linearization, const loss::Unknowns& unknowns,
                             const loss::Slice& slice)
    : _slice(slice), _hessian(loss::assemble_hessian(linearization, unknowns, loss::Curvature::gauss_newton)) {
  const std::vector<double> gradient = linearization.gradient(unknowns);
  _gradient = loss::ConstVectorMap(gradient.data(), static_cast<Eigen::Index>(gradient.size()));
  factor(_slice.reduce_symmetric(_hessian));
}

void SlicedHessian::factor(const core::Handle<Mat>& reduced) {
  double norm = 0.0;
  core::check(MatNorm(reduced.get(), NORM_INFINITY, &norm), "MatNorm");
  if (!(norm > 0.0) || !std::isfinite(norm))
    throw core::NumericalError("the Hessian on the slice is zero or not finite");
  for (_shift = 0.0; _shift <= largest_shift * norm; _shift = std::max(shift_growth * _shift, first_shift * norm)) {
    core::check(MatDuplicate(reduced.get(), MAT_COPY_VALUES, _factor.put()), "MatDuplicate");
    if (_shift > 0.0) core::check(MatShift(_factor.get(), _shift), "MatShift");
    core::check(MatSetOption(_factor.get(), MAT_SPD, PETSC_TRUE), "MatSetOption");
    const PetscErrorCode code = MatCholeskyFactor(_factor.get(), nullptr, nullptr);
    if (code == 0) return;
    if (code != PETSC_ERR_MAT_CH_ZRPVT) core::check(code, "MatCholeskyFactor");
  }
  throw core::NumericalError(fmt::format(
      "the Hessian on the slice cannot be factored even with {:.1e} |H| = {:.1e} added: the loop is not near a "
      "regular point of a family",
      largest_shift, largest_shift * norm));
}

Eigen::VectorXd SlicedHessian::solve(const Eigen::VectorXd& right_side) const {
  const int size = static_cast<int>(right_side.size());
  const core::Handle<Vec> b = loss::create_vector(size);
  const core::Handle<Vec> x = loss::create_vector(size);
  loss::assign(b.get(), right_side);
  core::check(MatSolve(_factor.get(), b.get(), x.get()), "MatSolve");
  return loss::to_eigen(x.get());
}

Eigen::VectorXd SlicedHessian::newton_step() const { return _slice.expand(-solve(_slice.reduce(_gradient))); }

Eigen::VectorXd SlicedHessian::flat_direction(const Eigen::VectorXd& normal) const {
  Eigen::VectorXd image;
  loss::with_dense_array(_hessian, [&](loss::DenseMap h) { image = h * normal; });
  const Eigen::VectorXd direction = normal - _slice.expand(solve(_slice.reduce(image)));
  return direction.normalized();
}

}  // namespace orbweaver::spectrum
