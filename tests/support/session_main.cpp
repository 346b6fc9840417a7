#include "orbweaver/core/blas_kernels.hpp"
#include "orbweaver/core/petsc/session.hpp"
#include "run_tests.hpp"

int main(int argc, char** argv) {
  orbweaver::core::prefer_fitting_blas_kernels(argv);
  const orbweaver::core::Session session;
  return run_tests(argc, argv);
}
