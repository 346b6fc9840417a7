#include <limits>

#include "model_system.hpp"

namespace orbweaver::systems {

/// The harmonic oscillator H = (p^2 + omega^2 q^2) / 2, state q, p: every orbit is known exactly.
class HarmonicOscillator {
 public:
  static constexpr int dimension = 2;
  static Description describe();

  template <class P>
  class With {
   public:
    explicit With(const std::map<std::string, P>& parameters) : _omega(parameters.at("omega")) {}

    template <class S>
    void field(const S* z, S* f) const {
      f[0] = z[1];
      f[1] = z[0] * (-_omega * _omega);
    }

    template <class S>
    S energy(const S* z) const {
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

Description HarmonicOscillator::describe() {
  const Eigen::Matrix2d reverse = Eigen::Vector2d(1, -1).asDiagonal();
  const Eigen::Matrix2d mirror = -Eigen::Matrix2d::Identity();
  Description description;
  description.name = "harmonic_oscillator";
  description.title = "Harmonic oscillator";
  description.state_names = {"q", "p"};
  description.parameters = {
      {"omega", 1.0, 0.0, std::numeric_limits<double>::infinity(), true, "rad/s", "angular frequency"}};
  description.equivariances = {{"S", mirror}};
  description.reversors = {{"R", reverse}, {"RS", -reverse}};
  description.conservative = true;
  description.symplectic = true;
  return description;
}

template struct Registered<HarmonicOscillator>;

}  // namespace orbweaver::systems
