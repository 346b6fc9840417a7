#pragma once

#include <array>

#include "effects/composition.hpp"

namespace orbweaver::systems {

/// The first primary shines: its light pushes the particle off with the part `radiation` of its attraction as a sphere,
/// which falls with the distance as the push does (D. W. Schuerman, Astrophys. J. 238 (1980) 337).
/// The primaries' own motion does not feel it.
class Radiation {
 public:
  static constexpr bool dissipates = false;
  static constexpr bool drives = false;

  static Effect info() {
    return {"radiation",
            "light of the first body pushes with the part `radiation` of its attraction as a sphere",
            {{"radiation", 0.1, 0.0, 1.0, false, "1", "pressure of the first body's light over its attraction"}}};
  }

  /// What makes the bodies change places, at mu = 1/2, turns the coordinate along them round.
  static PhaseShift shift(const Symmetry& ideal, const Bound&) {
    return mirrors(ideal) ? PhaseShift::broken : PhaseShift::any;
  }

  template <class P>
  class With {
   public:
    explicit With(const BoundTo<P>& bound) : _radiation(bound["radiation"]) {}

    /// Of what attracts as two spheres.
    void change_attraction(std::array<P, 2>& strengths) const { strengths[0] = strengths[0] * (1.0 - _radiation); }

   private:
    P _radiation;
  };
};

}  // namespace orbweaver::systems
