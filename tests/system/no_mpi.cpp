// Preloaded, it ends a program that starts MPI, PETSc or SLEPc.
#include <cstdio>
#include <cstdlib>

namespace {

[[noreturn]] int refuse(const char* function) {
  std::fprintf(stderr, "%s was called\n", function);
  std::_Exit(99);
}

}  // namespace

extern "C" {
int MPI_Init(int*, char***) { return refuse("MPI_Init"); }
int MPI_Init_thread(int*, char***, int, int*) { return refuse("MPI_Init_thread"); }
int PetscInitialize(int*, char***, const char*, const char*) { return refuse("PetscInitialize"); }
int SlepcInitialize(int*, char***, const char*, const char*) { return refuse("SlepcInitialize"); }
}
