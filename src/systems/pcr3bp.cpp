#include "pcr3bp.hpp"

#include "orbweaver/systems/model/model_system.hpp"

namespace orbweaver::systems {

ModelInfo ideal_pcr3bp() {
  ModelInfo info;
  info.name = "pcr3bp";
  info.title = "Planar circular restricted three-body problem";
  info.meaning = "a particle attracted by two bodies on circles, in the frame that turns with them";
  info.state_names = {"x", "y", "vx", "vy"};
  info.winding_names = {"", "", "", ""};
  info.parameters = {
      {"mu", 0.01215058560962404, 0.0, 0.5, true, "1", "mass of the smaller body over the mass of both"}};
  info.effects = {Radiation::info(), Oblateness::info()};
  return info;
}

Structure structure_of_ideal_pcr3bp(const Bound& bound) {
  const Eigen::Matrix4d reverse = Eigen::Vector4d(1, -1, -1, 1).asDiagonal();
  const Eigen::Matrix4d half_turn = -Eigen::Matrix4d::Identity();
  Structure structure;
  structure.dimension = 4;
  structure.conserved = {"energy"};
  const bool equal = bound["mu"] == 0.5;
  structure.guards = {{"r1", equal ? "the first body" : "the larger body"},
                      {"r2", equal ? "the second body" : "the smaller body"}};
  structure.reversors = {{"R", reverse}};
  // Equal bodies change places in half a turn.
  if (equal) {
    structure.equivariances = {{"S", half_turn}};
    structure.reversors.push_back({"RS", -reverse});
  }
  structure.symplectic = true;
  return structure;
}

template struct Registered<Pcr3bp<>>;

}  // namespace orbweaver::systems
