#pragma once

#include <complex>

#include "orbweaver/systems/system.hpp"

namespace orbweaver::systems {

/// A system whose functions also take complex states: what a complex step needs to check the derivatives of every
/// registered system. All of them are ComplexSystems.
class ComplexSystem : public System {
 public:
  /// f at one state; `z` and `f` have size dimension.
  virtual void complex_field(const std::complex<double>* z, std::complex<double>* f) const = 0;
  /// Conserved quantity k at one state.
  [[nodiscard]] virtual std::complex<double> complex_conserved(int k, const std::complex<double>* z) const = 0;
};

}  // namespace orbweaver::systems
