#pragma once

#include <source_location>

#include <mpi.h>

namespace orbweaver::core {

namespace detail {
[[noreturn]] void throw_mpi_error(int code, const char* call, std::source_location where);
}  // namespace detail

/// Throws EnvironmentError with MPI's own text unless `code` is MPI_SUCCESS. `call` names the MPI function.
inline void check_mpi(int code, const char* call, std::source_location where = std::source_location::current()) {
  if (code != MPI_SUCCESS) [[unlikely]]
    detail::throw_mpi_error(code, call, where);
}

}  // namespace orbweaver::core
