#pragma once

#include <exception>
#include <utility>

#include <petscsys.h>

namespace orbweaver::core {

/// Carries an exception out of a C callback: PETSc must never be unwound through, so `run` stores the exception and
/// returns an error code, and the caller of the solver calls `rethrow` afterwards.
class CallbackGuard {
 public:
  template <class Body>
  PetscErrorCode run(Body&& body) noexcept {
    try {
      std::forward<Body>(body)();
      return 0;
    } catch (...) {
      _error = std::current_exception();
      return PETSC_ERR_USER;
    }
  }

  /// Throws what a callback threw, once; does nothing otherwise.
  void rethrow() {
    if (_error) std::rethrow_exception(std::exchange(_error, nullptr));
  }

 private:
  std::exception_ptr _error;
};

}  // namespace orbweaver::core
