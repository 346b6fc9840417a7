#pragma once

#include <source_location>
#include <utility>

#include <petscsys.h>

#include "orbweaver/core/error.hpp"

namespace orbweaver::core {

namespace detail {
void destroy_petsc_object(PetscObject* object) noexcept;
}  // namespace detail

/// Owns one PETSc, SLEPc or TAO object (Mat, Vec, KSP, EPS, SVD, Tao, ...): the only place that destroys one.
/// A moved-from handle is empty; using an empty handle throws MisuseError, since a null object crashes the packaged
/// PETSc.
template <class T>
class Handle {
 public:
  Handle() = default;
  /// Takes over an object that the caller owns.
  explicit Handle(T object) noexcept : _object(object) {}
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  Handle(Handle&& other) noexcept : _object(std::exchange(other._object, nullptr)) {}
  Handle& operator=(Handle&& other) noexcept {
    if (this != &other) {
      reset();
      _object = std::exchange(other._object, nullptr);
    }
    return *this;
  }
  ~Handle() { reset(); }

  /// A second reference to an object that PETSc or another handle owns.
  [[nodiscard]] static Handle share(T object) {
    require(object != nullptr, "cannot share a null PETSc object");
    PetscObjectReference(reinterpret_cast<PetscObject>(object));
    return Handle(object);
  }

  /// The object; throws MisuseError when the handle is empty.
  [[nodiscard]] T get(std::source_location where = std::source_location::current()) const {
    if (_object == nullptr) [[unlikely]]
      throw MisuseError("use of an empty handle", where);
    return _object;
  }

  /// Where a PETSc create function puts its result; whatever the handle held is destroyed first.
  [[nodiscard]] T* put() noexcept {
    reset();
    return &_object;
  }

  [[nodiscard]] bool empty() const noexcept { return _object == nullptr; }

  void reset() noexcept {
    if (_object != nullptr) detail::destroy_petsc_object(reinterpret_cast<PetscObject*>(&_object));
    _object = nullptr;
  }

 private:
  T _object = nullptr;
};

}  // namespace orbweaver::core
