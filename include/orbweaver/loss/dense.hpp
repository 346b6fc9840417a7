#pragma once

#include <utility>

#include <petscmat.h>
#include <Eigen/Dense>

#include "orbweaver/core/petsc/check.hpp"
#include "orbweaver/core/petsc/handle.hpp"

namespace orbweaver::loss {

/// A dense PETSc matrix or vector seen through Eigen, without a copy (column-major).
using DenseMap = Eigen::Map<Eigen::MatrixXd>;
using VectorMap = Eigen::Map<Eigen::VectorXd>;
using ConstVectorMap = Eigen::Map<const Eigen::VectorXd>;

/// A new sequential dense matrix or vector of zeros.
[[nodiscard]] core::Handle<Mat> create_dense(int rows, int columns);
[[nodiscard]] core::Handle<Vec> create_vector(int size);

/// Calls `body(DenseMap)` on the matrix's own storage and gives it back to PETSc afterwards, also when `body` throws.
template <class Body>
void with_dense_array(const core::Handle<Mat>& matrix, Body&& body) {
  PetscInt rows = 0;
  PetscInt columns = 0;
  PetscScalar* data = nullptr;
  core::check(MatGetSize(matrix.get(), &rows, &columns), "MatGetSize");
  core::check(MatDenseGetArray(matrix.get(), &data), "MatDenseGetArray");
  struct Restore {
    Mat matrix;
    PetscScalar** data;
    ~Restore() { MatDenseRestoreArray(matrix, data); }
  } restore{matrix.get(), &data};
  std::forward<Body>(body)(DenseMap(data, rows, columns));
}

/// The entries of a vector, copied out of or into PETSc.
[[nodiscard]] Eigen::VectorXd to_eigen(Vec vector);
void assign(Vec vector, const Eigen::VectorXd& values);

}  // namespace orbweaver::loss
