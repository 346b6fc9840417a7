#include <limits>

#include "orbweaver/systems/model/model_system.hpp"

namespace orbweaver::systems {

/// The harmonic oscillator H = (p^2 + omega^2 q^2) / 2, state q, p: every orbit is known exactly.
class HarmonicOscillator {
 public:
  static constexpr int dimension = 2;
  static constexpr int quantities = 1;
  static ModelInfo info();
  static Structure structure(const Bound& bound);

  template <class P>
  class With {
   public:
    explicit With(const BoundTo<P>& bound) : _omega(bound["omega"]) {}

    template <class S>
    void field(const S* z, S* f) const {
      f[0] = z[1];
      f[1] = z[0] * (-_omega * _omega);
    }

    template <int, class S>
    S conserved(const S* z) const {
      return (z[1] * z[1] + z[0] * z[0] * (_omega * _omega)) * 0.5;
    }

    template <class S>
    S action_density(const S* z) const {
      return z[1] * z[1];
    }

   private:
    P _omega;
  };
};

ModelInfo HarmonicOscillator::info() {
  ModelInfo info;
  info.name = "harmonic_oscillator";
  info.title = "Harmonic oscillator";
  info.meaning = "a mass of 1 on a linear spring";
  info.state_names = {"q", "p"};
  info.winding_names = {"", ""};
  info.parameters = {{"omega", 1.0, 0.0, std::numeric_limits<double>::infinity(), true, "rad/s", "angular frequency"}};
  return info;
}

Structure HarmonicOscillator::structure(const Bound&) {
  const Eigen::Matrix2d reverse = Eigen::Vector2d(1, -1).asDiagonal();
  const Eigen::Matrix2d mirror = -Eigen::Matrix2d::Identity();
  Structure structure;
  structure.dimension = dimension;
  structure.conserved = {"energy"};
  structure.equivariances = {{"S", mirror}};
  structure.reversors = {{"R", reverse}, {"RS", -reverse}};
  structure.symplectic = true;
  return structure;
}

template struct Registered<HarmonicOscillator>;

}  // namespace orbweaver::systems
