#pragma once

#include "orbweaver/numerics/quad.hpp"

namespace orbweaver::systems {

/// A system that evaluates its field in quadruple precision too, its parameters being the doubles that they are. All
/// registered systems do.
class QuadSystem {
 public:
  virtual ~QuadSystem() = default;
  QuadSystem() = default;
  QuadSystem(const QuadSystem&) = delete;
  QuadSystem& operator=(const QuadSystem&) = delete;

  /// f and df/dz at one state; sizes dimension, and dimension x dimension. Throws MisuseError for a state of another
  /// dimension.
  virtual void linearize(const numerics::QuadVector& z, numerics::QuadVector& f,
                         numerics::QuadMatrix& jacobian) const = 0;
};

}  // namespace orbweaver::systems
