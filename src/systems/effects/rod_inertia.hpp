#pragma once

#include <limits>

#include "effects/composition.hpp"

namespace orbweaver::systems {

/// Rods of the double pendulum that have masses rod1, rod2, evenly along them: kinetic and potential energy of a rod
/// are integrals along it.
class RodInertia {
 public:
  static constexpr bool dissipates = false;
  static constexpr bool drives = false;

  static Effect info() {
    constexpr double inf = std::numeric_limits<double>::infinity();
    return {"rod_inertia",
            "uniform rods with masses, which move and weigh as the bobs do",
            {{"rod1", 0.1, 0.0, inf, false, "kg", "mass of the inner rod"},
             {"rod2", 0.1, 0.0, inf, false, "kg", "mass of the outer rod"}}};
  }

  static PhaseShift shift(const Symmetry&, const Bound&) { return PhaseShift::any; }

  template <class P>
  class With {
   public:
    explicit With(const BoundTo<P>& bound) : _rod1(bound["rod1"]), _rod2(bound["rod2"]) {}

    /// Adds to the Lagrangian's masses of two bobs (PendulumMasses).
    template <class Masses>
    void add_masses(Masses& masses) const {
      const P third_1 = _rod1 / 3.0;
      const P third_2 = _rod2 / 3.0;
      masses.determinant =
          (masses.bob_1 + third_1) * (masses.bob_2 + third_2) + masses.bob_2 * third_2 + third_2 * _rod2 * 0.25;
      masses.inner = masses.inner + third_1 + _rod2;
      masses.outer = masses.outer + third_2;
      masses.coupling = masses.coupling + _rod2 * 0.5;
      masses.weight_1 = masses.weight_1 + _rod1 * 0.5 + _rod2;
      masses.weight_2 = masses.weight_2 + _rod2 * 0.5;
    }

   private:
    P _rod1;
    P _rod2;
  };
};

}  // namespace orbweaver::systems
