#include "orbweaver/core/petsc/session.hpp"

#include <algorithm>
#include <array>

#include <slepcsys.h>

#include "mpi/open_mpi_defaults.hpp"
#include "orbweaver/core/address_space.hpp"
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

/// Beginnings of options that PetscFinalize asks for.
constexpr std::array read_at_the_end{"-options_", "-malloc_", "-objects_dump", "-memory_", "-log_"};

bool is_read_at_the_end(const std::string& option) {
  return std::any_of(read_at_the_end.begin(), read_at_the_end.end(),
                     [&](const char* beginning) { return option.starts_with(beginning); });
}

}  // namespace

Session::Session(const std::vector<std::string>& petsc_options) : _options(petsc_options) {
  int initialized = 0;
  check_mpi(MPI_Initialized(&initialized), "MPI_Initialized");
  if (initialized == 0) {
    require_space_of_a_rank();
    set_open_mpi_defaults();
    check_mpi(MPI_Init(nullptr, nullptr), "MPI_Init");
    _owns_mpi = true;
  }
  try {
    take_blas_buffer();
  } catch (...) {
    if (_owns_mpi) MPI_Finalize();
    throw;
  }
  Arguments& a = arguments();
  // What lies in a folder must not change results, nor a pipe in it hold up the start.
  a.words = {"orbweaver", "-no_signal_handler", "-skip_petscrc"};
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

std::vector<std::string> Session::unused_options(MPI_Comm comm) const {
  std::vector<std::string> unused;
  for (const std::string& word : _options) {
    PetscBool is_option = PETSC_FALSE;
    check(PetscOptionsValidKey(word.c_str(), &is_option), "PetscOptionsValidKey");
    if (is_option == PETSC_FALSE || is_read_at_the_end(word)) continue;
    PetscBool used = PETSC_FALSE;
    check(PetscOptionsUsed(nullptr, word.c_str() + 1, &used), "PetscOptionsUsed");
    int anywhere = used == PETSC_TRUE ? 1 : 0;
    check_mpi(MPI_Allreduce(MPI_IN_PLACE, &anywhere, 1, MPI_INT, MPI_MAX, comm), "MPI_Allreduce");
    if (anywhere == 0) unused.push_back(word);
  }
  return unused;
}

Session::~Session() {
  forget_log_stages();
  PetscPopErrorHandler();
  SlepcFinalize();
  if (_owns_mpi) MPI_Finalize();
}

}  // namespace orbweaver::core
