#include <benchmark/benchmark.h>

#include "orbweaver/core/blas_kernels.hpp"
#include "orbweaver/core/petsc/session.hpp"

int main(int argc, char** argv) {
  orbweaver::core::prefer_fitting_blas_kernels(argv);
  const orbweaver::core::Session session;
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
