#pragma once

#include <array>

#include "effects/composition.hpp"

namespace orbweaver::systems {

/// Either primary is oblate, its equator in the plane of the motion: A_k = J2 R^2 of body k over the distance^2. A body
/// of mass m then has the potential -m/r (1 + A/(2 r^2)) in that plane, and since the bodies feel this too, the frame
/// turns with n^2 = 1 + 3 (A1 + A2)/2 (R. K. Sharma and P. V. Subba Rao, Celest. Mech. 13 (1976) 137). At the height z
/// above the plane the potential's last term has the factor 1 - 3 z^2/r^2.
class Oblateness {
 public:
  static constexpr bool dissipates = false;
  static constexpr bool drives = false;

  static Effect info() {
    return {"oblateness",
            "J2 of either body: potentials -m/r (1 + A/(2 r^2)), and n^2 = 1 + 3 (A1 + A2)/2 of the frame that turns",
            {{"A1", 0.001, 0.0, 1.0, false, "1", "J2 times radius^2 of the first body over the distance^2"},
             {"A2", 0.001, 0.0, 1.0, false, "1", "J2 times radius^2 of the second body over the distance^2"}}};
  }

  /// What makes the bodies change places, at mu = 1/2, turns the coordinate along them round.
  static PhaseShift shift(const Symmetry& ideal, const Bound& bound) {
    return mirrors(ideal) && bound["A1"] != bound["A2"] ? PhaseShift::broken : PhaseShift::any;
  }

  template <class P>
  class With {
   public:
    explicit With(const BoundTo<P>& bound) : _a{bound["A1"], bound["A2"]}, _masses{1.0 - bound["mu"], bound["mu"]} {}

    /// Of n^2.
    void change_turning(P& square) const { square = square + (_a[0] + _a[1]) * 1.5; }

    /// Strengths g of the attraction g/r^4 in the plane, beside that of a sphere, and g/(3 r^3) of its potential.
    void set_quadrupoles(std::array<P, 2>& strengths) const {
      for (std::size_t k = 0; k < 2; ++k) strengths[k] = _a[k] * _masses[k] * 1.5;
    }

   private:
    std::array<P, 2> _a;
    std::array<P, 2> _masses;
  };
};

}  // namespace orbweaver::systems
