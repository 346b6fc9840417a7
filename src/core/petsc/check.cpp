#include "orbweaver/core/petsc/check.hpp"

#include <string>

#include <fmt/format.h>

#include "orbweaver/core/error.hpp"

namespace orbweaver::core::detail {

void throw_petsc_error(PetscErrorCode code, const char* call, std::source_location where) {
  const char* text = nullptr;
  char* specific = nullptr;
  PetscErrorMessage(code, &text, &specific);
  const std::string detail = (specific != nullptr && *specific != '\0') ? fmt::format(" ({})", specific) : "";
  throw EnvironmentError(fmt::format("{} failed: {}{} [PETSc error {}, {}:{}]", call,
                                     text != nullptr ? text : "unknown error", detail, static_cast<int>(code),
                                     where.file_name(), where.line()));
}

}  // namespace orbweaver::core::detail
