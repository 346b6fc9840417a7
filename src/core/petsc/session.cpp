#include "orbweaver/core/petsc/session.hpp"

#include <slepcsys.h>

#include "orbweaver/core/petsc/check.hpp"
#include "petsc_log.hpp"

namespace orbweaver::core {

namespace {

// PETSc keeps pointers into argv, so the strings must outlive it.
struct Arguments {
  std::vector<std::string> words;
  std::vector<char*> pointers;
  int count = 0;
  char** data = nullptr;
};

Arguments& arguments() {
  static Arguments instance;
  return instance;
}

}  // namespace

Session::Session(const std::vector<std::string>& petsc_options) {
  int initialized = 0;
  check_mpi(MPI_Initialized(&initialized), "MPI_Initialized");
  if (initialized == 0) {
    check_mpi(MPI_Init(nullptr, nullptr), "MPI_Init");
    _owns_mpi = true;
  }
  Arguments& a = arguments();
  a.words = {"orbweaver", "-no_signal_handler"};
  a.words.insert(a.words.end(), petsc_options.begin(), petsc_options.end());
  a.pointers.clear();
  for (std::string& word : a.words) a.pointers.push_back(word.data());
  a.pointers.push_back(nullptr);
  a.count = static_cast<int>(a.words.size());
  a.data = a.pointers.data();
  check(SlepcInitialize(&a.count, &a.data, nullptr, nullptr), "SlepcInitialize");
  check(PetscPushErrorHandler(PetscReturnErrorHandler, nullptr), "PetscPushErrorHandler");
  register_log_stages();
}

Session::~Session() {
  forget_log_stages();
  PetscPopErrorHandler();
  SlepcFinalize();
  if (_owns_mpi) MPI_Finalize();
}

}  // namespace orbweaver::core
