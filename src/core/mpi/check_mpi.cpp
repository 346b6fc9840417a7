#include "orbweaver/core/mpi/check_mpi.hpp"

#include <array>
#include <string>

#include <fmt/format.h>

#include "orbweaver/core/error.hpp"

namespace orbweaver::core::detail {

void throw_mpi_error(int code, const char* call, std::source_location where) {
  std::array<char, MPI_MAX_ERROR_STRING> text{};
  int length = 0;
  MPI_Error_string(code, text.data(), &length);
  throw EnvironmentError(fmt::format("{} failed: {} [MPI error {}, {}:{}]", call,
                                     std::string(text.data(), static_cast<std::size_t>(length)), code,
                                     where.file_name(), where.line()));
}

}  // namespace orbweaver::core::detail
