#include "run_tests.hpp"

int main(int argc, char** argv) {
  MPI_Init(&argc, &argv);
  const int result = run_tests(argc, argv);
  MPI_Finalize();
  return result;
}
