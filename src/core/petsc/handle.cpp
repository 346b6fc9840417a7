#include "orbweaver/core/petsc/handle.hpp"

namespace orbweaver::core::detail {

void destroy_petsc_object(PetscObject* object) noexcept {
  // After PetscFinalize there is nothing left to destroy: the session outlives handles in correct programs, but a
  // static or an unwinding main must not crash.
  PetscBool finalized = PETSC_FALSE;
  PetscFinalized(&finalized);
  if (finalized == PETSC_TRUE) return;
  PetscObjectDestroy(object);
}

}  // namespace orbweaver::core::detail
