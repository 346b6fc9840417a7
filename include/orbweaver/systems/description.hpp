#pragma once

#include <string>
#include <vector>

#include <Eigen/Dense>

namespace orbweaver::systems {

/// A named real parameter of a system and the values it may take.
struct Parameter {
  std::string name;
  double standard = 0.0;    ///< value when the scene does not give one
  double lower = 0.0;       ///< least allowed value
  double upper = 0.0;       ///< greatest allowed value
  bool lower_open = false;  ///< true: `lower` itself is refused (a mass must be > 0)
  std::string unit;         ///< "kg", "m", "1"
  std::string meaning;      ///< one phrase
};

/// Something a scene may add to the ideal system (friction, a drive, ...), with the parameters it brings.
struct Effect {
  std::string name;
  std::string meaning;
  std::vector<Parameter> parameters;
};

/// A linear symmetry of phase space (dimension x dimension), acting modulo 2 pi on the angles.
struct Symmetry {
  std::string name;  ///< "S", "R", "RS": as it appears in an isotropy
  Eigen::MatrixXd matrix;
};

/// What a system says of itself. Everything that other layers do depends on this and on the field alone.
struct Description {
  std::string name;                        ///< as in a scene: "double_pendulum"
  std::string title;                       ///< as a person would write it
  std::vector<std::string> state_names;    ///< one a coordinate; its size is the dimension
  std::vector<int> angles;                 ///< indices of the coordinates that live on a circle of 2 pi and may wind
  std::vector<std::string> winding_names;  ///< one an angle
  std::vector<Parameter> parameters;
  std::vector<Effect> effects;
  std::vector<Symmetry> equivariances;  ///< S with f(S z) = S f(z), identity excluded
  std::vector<Symmetry> reversors;      ///< R with f(R z) = -R f(z), in the order in which they are preferred for s = 0
  bool conservative = false;            ///< energy is conserved along the flow
  bool symplectic = false;              ///< multipliers come in pairs mu, 1/mu

  [[nodiscard]] int dimension() const { return static_cast<int>(state_names.size()); }
  /// Number of nontrivial stability indices of an orbit (pairs of multipliers).
  [[nodiscard]] int pairs() const { return symplectic ? dimension() / 2 - 1 : dimension() - 1; }
};

}  // namespace orbweaver::systems
