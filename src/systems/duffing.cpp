#include "duffing.hpp"

#include <limits>

#include "orbweaver/systems/model/model_system.hpp"

namespace orbweaver::systems {

ModelInfo ideal_duffing() {
  constexpr double inf = std::numeric_limits<double>::infinity();
  ModelInfo info;
  info.name = "duffing";
  info.title = "Duffing oscillator";
  info.meaning = "a mass of 1 on a spring whose force is -alpha x - beta x^3";
  info.state_names = {"x", "v"};
  info.winding_names = {"", ""};
  info.parameters = {{"alpha", 1.0, -inf, inf, false, "1", "linear stiffness"},
                     {"beta", 1.0, -inf, inf, false, "1", "cubic stiffness"}};
  info.effects = {Damping<1>::info(), Drive<1>::info()};
  return info;
}

Structure structure_of_ideal_duffing() {
  const Eigen::Matrix2d reverse = Eigen::Vector2d(1, -1).asDiagonal();
  const Eigen::Matrix2d mirror = -Eigen::Matrix2d::Identity();
  Structure structure;
  structure.dimension = 2;
  structure.conserved = {"energy"};
  structure.equivariances = {{"S", mirror}};
  structure.reversors = {{"R", reverse}, {"RS", -reverse}};
  structure.symplectic = true;
  return structure;
}

template struct Registered<Duffing<>>;
template struct Registered<Duffing<Damping<1>>>;
template struct Registered<Duffing<Drive<1>>>;
template struct Registered<Duffing<Damping<1>, Drive<1>>>;

}  // namespace orbweaver::systems
