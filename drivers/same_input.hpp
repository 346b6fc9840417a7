#pragma once

#include <string>

#include "orbweaver/core/mpi/communicator.hpp"

namespace orbweaver::drivers {

/// Collective. Throws core::InputError on all ranks where one has read another scene than rank 0; `scene` is its text
/// and its model's.
void require_same_input(const core::Communicator& comm, const std::string& scene);

}  // namespace orbweaver::drivers
