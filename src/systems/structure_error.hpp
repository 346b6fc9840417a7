#pragma once

#include <stdexcept>

namespace orbweaver::systems {

/// A model's structure does not fit the model. The message names the item as the model's source has it
/// (structure.reversors[1]), what was expected, what came, and what to do.
class StructureError : public std::logic_error {
 public:
  using std::logic_error::logic_error;
};

}  // namespace orbweaver::systems
