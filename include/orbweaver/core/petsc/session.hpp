#pragma once

#include <string>
#include <vector>

#include <mpi.h>

namespace orbweaver::core {

/// Owns the order in which MPI, PETSc and SLEPc start and finish. Make one, first thing in main; every Handle and
/// Communicator must be gone before it is. Collective over MPI_COMM_WORLD.
///
/// PETSc's signal handlers and its error output are switched off: errors become exceptions (core/check.hpp).
class Session {
 public:
  /// `petsc_options`: options for PETSc's database, as they would stand on a command line (may be empty).
  /// Throws EnvironmentError if MPI, PETSc or SLEPc cannot start.
  explicit Session(const std::vector<std::string>& petsc_options = {});
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;
  Session(Session&&) = delete;
  Session& operator=(Session&&) = delete;
  ~Session();

  /// Those of the options given that no object has asked for on any rank so far, with their `-`: misspelt ones, or ones
  /// of solvers that were not needed. Options that PETSc reads when it ends are not among them. Collective over `comm`.
  [[nodiscard]] std::vector<std::string> unused_options(MPI_Comm comm) const;

 private:
  std::vector<std::string> _options;
  bool _owns_mpi = false;
};

}  // namespace orbweaver::core
