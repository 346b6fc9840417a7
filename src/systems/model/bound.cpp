#include "orbweaver/systems/model/bound.hpp"

#include <fmt/format.h>

#include "orbweaver/systems/model/checks.hpp"
#include "structure_error.hpp"

namespace orbweaver::systems {

void refuse_parameter(const std::string& asked, const std::vector<std::string>& known) {
  throw StructureError(fmt::format(
      "it asks for a parameter '{}', which info.parameters does not name; it names {}: add it there, or mend "
      "the name where it is asked for, bound[\"{}\"]",
      asked, joined(known), asked));
}

}  // namespace orbweaver::systems
