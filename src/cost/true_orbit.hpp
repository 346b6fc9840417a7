#pragma once

#include <memory>
#include <vector>

#include <Eigen/Dense>

#include "orbweaver/loop/curve/loop.hpp"
#include "orbweaver/loop/symmetry/isotropy.hpp"
#include "orbweaver/refine/orbit.hpp"
#include "orbweaver/refine/shoot.hpp"
#include "orbweaver/systems/system.hpp"

namespace orbweaver::cost {

/// An orbit of a family to more digits than double precision has, to hold others against.
class TrueOrbit {
 public:
  /// The orbit with the period or the energy of `near`, a loop in the scales of `scaled` with this isotropy.
  /// `neighbour`: an orbit of the family beside it, in phase with it. Throws what refine::refine_orbit does.
  TrueOrbit(const std::shared_ptr<const systems::System>& plain, const systems::System& scaled, const loop::Loop& near,
            const loop::Loop& neighbour, const loop::Isotropy& isotropy);

  /// The largest |z - z_true| over instants of the period and over coordinates, in the scales, less what a shift of
  /// time and another place on the family explain (least squares): both are the solver's choice, not its error.
  [[nodiscard]] double error_of(const loop::Loop& orbit) const;
  /// The same at the nodes of an orbit that has exactly the period or energy held, in standard phase.
  [[nodiscard]] double error_of(const refine::ShotOrbit& orbit) const;
  /// The same at those of one with a period of its own near by, a little off the phase, against the true orbit of that
  /// period.
  [[nodiscard]] double error_at_its_period(const refine::ShotOrbit& orbit) const;

  [[nodiscard]] const refine::Guess& guess() const { return _guess; }
  [[nodiscard]] const refine::HeldValue& held() const { return _refined.held; }

 private:
  struct Refined {
    refine::HeldValue held;
    int digits = 0;
    refine::RefinedOrbit orbit;
  };
  [[nodiscard]] static Refined refined_near(const refine::Guess& guess, const systems::System& scaled,
                                            const loop::Loop& near, const loop::Isotropy& isotropy);
  [[nodiscard]] Eigen::VectorXd samples_of(const loop::Loop& orbit) const;
  [[nodiscard]] Eigen::VectorXd velocities(const Eigen::VectorXd& states) const;
  [[nodiscard]] Eigen::VectorXd in_scales(const std::vector<std::vector<double>>& states) const;

  const systems::System& _scaled;
  loop::Isotropy _isotropy;
  refine::Guess _guess;
  Refined _refined;
  std::vector<double> _fractions;
  Eigen::VectorXd _states;   // at the fractions, one after the other, in the scales
  Eigen::MatrixXd _neutral;  // dz/dt and the family's direction there
};

}  // namespace orbweaver::cost
