#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "ball.hpp"
#include "ball_arithmetic.hpp"
#include "orbweaver/prove/proof.hpp"
#include "orbweaver/systems/formulas.hpp"
#include "orbweaver/taylor/series.hpp"

namespace orbweaver::prove {

/// The flow of a system as a set that is proven to hold it, from a whole box of states at once (docs/mathematics.md,
/// "Proofs"). All balls have the bits that were in force when it was made, and it is used with these.
class EnclosedFlow {
 public:
  /// `digits`: what a step leaves out is proven to be below 10^-digits.
  EnclosedFlow(const systems::Formulas& formulas, const BallVector& parameters, double digits);

  struct Image {
    BallVector state;       ///< holds the solutions through all states of the box
    BallMatrix transition;  ///< holds their derivatives by the state they come from
  };
  /// After `time`, for all times in that ball. Throws NotProven where that cannot be enclosed, as where they are not
  /// all positive.
  [[nodiscard]] Image advance(const BallVector& box, const Ball& time);

  [[nodiscard]] BallVector field(const BallVector& z) const;
  /// Conserved quantity 0 and its gradient.
  [[nodiscard]] Ball energy(const BallVector& z) const;
  [[nodiscard]] BallVector energy_gradient(const BallVector& z) const;

  /// Of all calls so far; NotProven after more than `most`.
  [[nodiscard]] long steps() const { return _steps; }
  void limit_steps(long most) { _most_steps = most; }
  [[nodiscard]] int order() const { return _order; }

  /// The disc |t| <= radius in the complex plane on which all solutions from a box are analytic.
  struct Disc {
    Ball radius;
    BallVector departure;  ///< bounds |z_i(t) - z_i(0)|, one a coordinate
    BallMatrix growth;     ///< bounds the entries of |Phi(t) - 1|
  };
  /// Throws NotProven. `guess`: a radius to begin with.
  [[nodiscard]] Disc analytic_disc(const BallVector& box, double guess) const;

 private:
  class Set;
  [[nodiscard]] std::optional<Disc> disc_of_radius(const BallVector& box, double radius) const;
  [[nodiscard]] double step_size(const Disc& disc) const;

  systems::Formulas _formulas;
  BallVector _parameters;
  std::vector<ComplexBall> _complex_parameters;
  double _digits;
  int _order;
  taylor::Series<Ball> _state;
  taylor::Series<Ball> _variational;
  double _last_radius;
  long _steps = 0;
  long _most_steps = 1000000;
};

}  // namespace orbweaver::prove
