#include "orbweaver/core/error.hpp"

#include <fmt/format.h>

namespace orbweaver::core {

MisuseError::MisuseError(const std::string& message, std::source_location where)
    : std::logic_error(
          fmt::format("{} (in {}, {}:{})", message, where.function_name(), where.file_name(), where.line())) {}

}  // namespace orbweaver::core
