// Makes sessions and looks at what is running before, within and after: `owns` lets the session start MPI, `borrows`
// starts it outside. Exit status 0 when everything was as it should be, else the number of things that were not.
#include <cstdio>
#include <string>
#include <vector>

#include <mpi.h>
#include <petscvec.h>
#include <slepcsys.h>

#include "orbweaver/core/petsc/check.hpp"
#include "orbweaver/core/petsc/handle.hpp"
#include "orbweaver/core/petsc/session.hpp"

namespace {

using orbweaver::core::check;
using orbweaver::core::Handle;
using orbweaver::core::Session;

int failures = 0;

void expect(bool condition, const char* what) {
  if (condition) return;
  std::fprintf(stderr, "session_order: expected that %s\n", what);
  ++failures;
}

bool mpi_started() {
  int flag = 0;
  MPI_Initialized(&flag);
  return flag != 0;
}

bool mpi_finished() {
  int flag = 0;
  MPI_Finalized(&flag);
  return flag != 0;
}

bool petsc_runs() { return PetscInitializeCalled == PETSC_TRUE; }
bool slepc_runs() { return SlepcInitializeCalled == PETSC_TRUE; }

void expect_all_running() {
  expect(mpi_started() && !mpi_finished(), "MPI runs within a session");
  expect(petsc_runs(), "PETSc runs within a session");
  expect(slepc_runs(), "SLEPc runs within a session");
}

void expect_option() {
  PetscInt value = 0;
  PetscBool found = PETSC_FALSE;
  check(PetscOptionsGetInt(nullptr, nullptr, "-orbweaver_probe", &value, &found), "PetscOptionsGetInt");
  expect(found == PETSC_TRUE && value == 17, "options given to the session reach PETSc's database");
}

void expect_errors_are_returned() {
  Handle<Vec> vec;
  check(VecCreate(PETSC_COMM_SELF, vec.put()), "VecCreate");
  expect(VecSetType(vec.get(), "no-such-type") != 0, "a PETSc error is returned, and the program lives on");
}

// What outlives PETSc is left to the system, so cmake/lsan.supp names this function.
void make_survivor(Handle<Vec>& survivor) { check(VecCreateSeq(PETSC_COMM_SELF, 2, survivor.put()), "VecCreateSeq"); }

void run_session() {
  Handle<Vec> survivor;
  expect(!petsc_runs() && !slepc_runs(), "nothing of PETSc or SLEPc runs before a session");
  {
    const Session session({"-orbweaver_probe", "17", "-orbweaver_unasked", "-3", "-options_view", "0"});
    expect_all_running();
    expect(session.unused_options(MPI_COMM_WORLD) == std::vector<std::string>{"-orbweaver_probe", "-orbweaver_unasked"},
           "options are unused until something asks for them");
    expect_option();
    expect(session.unused_options(MPI_COMM_WORLD) == std::vector<std::string>{"-orbweaver_unasked"},
           "an option that something has asked for is not unused");
    expect_errors_are_returned();
    make_survivor(survivor);
  }
  expect(!petsc_runs() && !slepc_runs(), "PETSc and SLEPc have finished after the session");
  survivor.reset();  // must not touch a PETSc that is gone
}

void session_that_owns_mpi() {
  expect(!mpi_started(), "MPI does not run before the session");
  run_session();
  expect(mpi_finished(), "the session that started MPI finishes it");
}

void sessions_that_borrow_mpi() {
  MPI_Init(nullptr, nullptr);
  for (int round = 0; round < 2; ++round) {
    run_session();
    expect(!mpi_finished(), "a session leaves MPI alone that it did not start");
  }
  MPI_Finalize();
}

}  // namespace

int main(int argc, char** argv) {
  const std::string mode = argc > 1 ? argv[1] : "";
  if (mode == "owns") {
    session_that_owns_mpi();
  } else if (mode == "borrows") {
    sessions_that_borrow_mpi();
  } else {
    expect(false, "the mode is owns or borrows");
  }
  return failures;
}
