#pragma once

#include "orbweaver/core/mpi/communicator.hpp"
#include "orbweaver/core/petsc/session.hpp"

namespace orbweaver::drivers {

/// Warns, on the root, of options for PETSc that nothing has used. Collective over `comm`.
void warn_of_unused_options(const core::Session& session, const core::Communicator& comm);

}  // namespace orbweaver::drivers
