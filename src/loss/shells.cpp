#include "shells.hpp"

#include <exception>
#include <memory>
#include <utility>

#include "orbweaver/core/petsc/check.hpp"
#include "orbweaver/loss/dense.hpp"

namespace orbweaver::loss {

namespace {

struct Context {
  std::shared_ptr<const Linearization> linearization;
  std::shared_ptr<const Unknowns> unknowns;
  Curvature curvature = Curvature::gauss_newton;
};

// Products through spans of the vectors' own storage; an exception becomes PETSc's error with its text.
template <class Product>
PetscErrorCode apply(Mat matrix, Vec x, Vec y, Product&& product) {
  void* raw = nullptr;
  PetscErrorCode code = MatShellGetContext(matrix, &raw);
  if (code != 0) return code;
  const auto& context = *static_cast<const Context*>(raw);
  try {
    const Eigen::VectorXd in = to_eigen(x);
    const std::vector<double> out =
        product(context, std::span<const double>(in.data(), static_cast<std::size_t>(in.size())));
    assign(y, ConstVectorMap(out.data(), static_cast<Eigen::Index>(out.size())));
    return 0;
  } catch (const std::exception& error) {
    return PetscError(PETSC_COMM_SELF, __LINE__, "loss::apply", __FILE__, PETSC_ERR_USER, PETSC_ERROR_INITIAL, "%s",
                      error.what());
  }
}

PetscErrorCode multiply_jacobian(Mat matrix, Vec x, Vec y) {
  return apply(matrix, x, y, [](const Context& c, std::span<const double> v) {
    return c.linearization->apply_jacobian(*c.unknowns, v);
  });
}

PetscErrorCode multiply_jacobian_transposed(Mat matrix, Vec x, Vec y) {
  return apply(matrix, x, y, [](const Context& c, std::span<const double> v) {
    return c.linearization->apply_jacobian_transposed(*c.unknowns, v);
  });
}

PetscErrorCode multiply_hessian(Mat matrix, Vec x, Vec y) {
  return apply(matrix, x, y, [](const Context& c, std::span<const double> v) {
    return c.linearization->apply_hessian(*c.unknowns, v, c.curvature);
  });
}

PetscErrorCode destroy_context(Mat matrix) {
  void* raw = nullptr;
  const PetscErrorCode code = MatShellGetContext(matrix, &raw);
  delete static_cast<Context*>(raw);
  return code;
}

core::Handle<Mat> create_shell(int rows, int columns, Context context) {
  auto owned = std::make_unique<Context>(std::move(context));
  core::Handle<Mat> matrix;
  core::check(MatCreateShell(PETSC_COMM_SELF, rows, columns, rows, columns, owned.get(), matrix.put()),
              "MatCreateShell");
  core::check(MatShellSetOperation(matrix.get(), MATOP_DESTROY, reinterpret_cast<void (*)()>(destroy_context)),
              "MatShellSetOperation");
  static_cast<void>(owned.release());
  return matrix;
}

void set_operation(const core::Handle<Mat>& matrix, MatOperation operation, PetscErrorCode (*function)(Mat, Vec, Vec)) {
  core::check(MatShellSetOperation(matrix.get(), operation, reinterpret_cast<void (*)()>(function)),
              "MatShellSetOperation");
}

}  // namespace

core::Handle<Mat> shell_jacobian(std::shared_ptr<const Linearization> linearization,
                                 std::shared_ptr<const Unknowns> unknowns) {
  const int rows = linearization->rows();
  const int columns = unknowns->size();
  core::Handle<Mat> matrix = create_shell(rows, columns, {std::move(linearization), std::move(unknowns)});
  set_operation(matrix, MATOP_MULT, multiply_jacobian);
  set_operation(matrix, MATOP_MULT_TRANSPOSE, multiply_jacobian_transposed);
  return matrix;
}

core::Handle<Mat> shell_hessian(std::shared_ptr<const Linearization> linearization,
                                std::shared_ptr<const Unknowns> unknowns, Curvature curvature) {
  const int size = unknowns->size();
  core::Handle<Mat> matrix = create_shell(size, size, {std::move(linearization), std::move(unknowns), curvature});
  set_operation(matrix, MATOP_MULT, multiply_hessian);
  set_operation(matrix, MATOP_MULT_TRANSPOSE, multiply_hessian);
  core::check(MatSetOption(matrix.get(), MAT_SYMMETRIC, PETSC_TRUE), "MatSetOption");
  return matrix;
}

}  // namespace orbweaver::loss
