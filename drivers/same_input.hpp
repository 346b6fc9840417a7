#pragma once

#include <string>

#include "orbweaver/core/mpi/communicator.hpp"

namespace orbweaver::drivers {

/// Collective. Throws core::InputError on all ranks where one has read another scene than rank 0, or has loaded other
/// plugins: `scene` is its text, "" where there is none.
void require_same_input(const core::Communicator& comm, const std::string& scene);

}  // namespace orbweaver::drivers
