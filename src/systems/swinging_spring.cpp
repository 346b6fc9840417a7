#include "swinging_spring.hpp"

#include <limits>

#include "orbweaver/systems/model/model_system.hpp"

namespace orbweaver::systems {

ModelInfo ideal_swinging_spring() {
  constexpr double inf = std::numeric_limits<double>::infinity();
  ModelInfo info;
  info.name = "swinging_spring";
  info.title = "Swinging spring";
  info.meaning = "a point mass on a massless spring under gravity, in a vertical plane";
  info.state_names = {"x", "y", "vx", "vy"};
  info.winding_names = {"", "", "", ""};
  info.parameters = {
      {"mass", 1.0, 0.0, inf, true, "kg", "mass of the bob"},
      {"stiffness", 3.0, 0.0, inf, true, "N/m", "stiffness of the spring"},
      {"length", 1.0, 0.0, inf, true, "m", "length of the spring without load"},
      {"gravity", 1.0, 0.0, inf, true, "m/s^2", "gravity"},
  };
  info.effects = {Damping<2>::info(), Drive<2>::info()};
  return info;
}

Structure structure_of_ideal_swinging_spring() {
  const Eigen::Matrix4d reverse = Eigen::Vector4d(1, 1, -1, -1).asDiagonal();
  const Eigen::Matrix4d mirror = Eigen::Vector4d(-1, 1, -1, 1).asDiagonal();
  Structure structure;
  structure.dimension = 4;
  structure.conserved = {"energy"};
  structure.guards = {{"r", "the point of suspension"}};
  structure.equivariances = {{"S", mirror}};
  structure.reversors = {{"R", reverse}, {"RS", reverse * mirror}};
  structure.symplectic = true;
  return structure;
}

template struct Registered<SwingingSpring<>>;

}  // namespace orbweaver::systems
