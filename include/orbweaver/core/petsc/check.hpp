#pragma once

#include <source_location>

#include <petscsys.h>

#include "orbweaver/core/mpi/check_mpi.hpp"

namespace orbweaver::core {

namespace detail {
[[noreturn]] void throw_petsc_error(PetscErrorCode code, const char* call, std::source_location where);
}  // namespace detail

/// Throws EnvironmentError with PETSc's own text unless `code` is 0. `call` names the PETSc, SLEPc or TAO function.
inline void check(PetscErrorCode code, const char* call, std::source_location where = std::source_location::current()) {
  if (code != 0) [[unlikely]]
    detail::throw_petsc_error(code, call, where);
}

}  // namespace orbweaver::core
