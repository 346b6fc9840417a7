#include "orbweaver/core/serialization.hpp"

#include <fmt/format.h>

#include "orbweaver/core/error.hpp"

namespace orbweaver::core {

void refuse_enum(int number, int last) {
  throw EnvironmentError(
      fmt::format("an enum that ends at {} has the value {}: the bytes are damaged or foreign", last, number));
}

void refuse_flag(int byte) {
  throw EnvironmentError(fmt::format("a flag has the value {}: the bytes are damaged or foreign", byte));
}

}  // namespace orbweaver::core
