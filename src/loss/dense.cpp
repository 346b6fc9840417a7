#include "orbweaver/loss/dense.hpp"

#include "orbweaver/core/error.hpp"

namespace orbweaver::loss {

core::Handle<Mat> create_dense(int rows, int columns) {
  core::Handle<Mat> matrix;
  core::check(MatCreateSeqDense(PETSC_COMM_SELF, rows, columns, nullptr, matrix.put()), "MatCreateSeqDense");
  return matrix;
}

core::Handle<Vec> create_vector(int size) {
  core::Handle<Vec> vector;
  core::check(VecCreateSeq(PETSC_COMM_SELF, size, vector.put()), "VecCreateSeq");
  return vector;
}

Eigen::VectorXd to_eigen(Vec vector) {
  PetscInt size = 0;
  const PetscScalar* data = nullptr;
  core::check(VecGetLocalSize(vector, &size), "VecGetLocalSize");
  core::check(VecGetArrayRead(vector, &data), "VecGetArrayRead");
  Eigen::VectorXd out = ConstVectorMap(data, size);
  core::check(VecRestoreArrayRead(vector, &data), "VecRestoreArrayRead");
  return out;
}

void assign(Vec vector, const Eigen::VectorXd& values) {
  PetscInt size = 0;
  PetscScalar* data = nullptr;
  core::check(VecGetLocalSize(vector, &size), "VecGetLocalSize");
  core::require(size == values.size(), "a vector of another size");
  core::check(VecGetArrayWrite(vector, &data), "VecGetArrayWrite");
  VectorMap(data, size) = values;
  core::check(VecRestoreArrayWrite(vector, &data), "VecRestoreArrayWrite");
}

}  // namespace orbweaver::loss
