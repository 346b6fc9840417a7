#include "restricted_problem.hpp"

#include "cr3bp.hpp"
#include "orbweaver/systems/model/model_system.hpp"
#include "pcr3bp.hpp"

namespace orbweaver::systems {

ModelInfo ideal_restricted_problem(int space) {
  const bool planar = space == 2;
  ModelInfo info;
  info.name = planar ? "pcr3bp" : "cr3bp";
  info.title = planar ? "Planar circular restricted three-body problem" : "Circular restricted three-body problem";
  info.meaning = "a particle attracted by two bodies on circles, in the frame that turns with them";
  info.state_names = {"x", "y", "vx", "vy"};
  if (!planar) info.state_names = {"x", "y", "z", "vx", "vy", "vz"};
  info.winding_names.assign(info.state_names.size(), "");
  info.parameters = {
      {"mu", 0.01215058560962404, 0.0, 0.5, true, "1", "mass of the smaller body over the mass of both"}};
  info.effects = {Radiation::info(), Oblateness::info()};
  return info;
}

Structure structure_of_ideal_restricted_problem(int space, const Bound& bound) {
  const bool planar = space == 2;
  // The same map of positions and of velocities, or the opposite one.
  const auto on_states = [&](const Eigen::Vector3d& positions, double velocities) {
    Eigen::VectorXd diagonal(2 * space);
    diagonal << positions.head(space), velocities * positions.head(space);
    return Eigen::MatrixXd(diagonal.asDiagonal());
  };
  const Eigen::MatrixXd reverse = on_states({1, -1, 1}, -1);
  const Eigen::MatrixXd half_turn = on_states({-1, -1, 1}, 1);
  const Eigen::MatrixXd mirror = on_states({1, 1, -1}, 1);
  Structure structure;
  structure.dimension = 2 * space;
  structure.conserved = {"energy"};
  const bool equal = bound["mu"] == 0.5;
  structure.guards = {{"r1", equal ? "the first body" : "the larger body"},
                      {"r2", equal ? "the second body" : "the smaller body"}};
  structure.reversors = {{"R", reverse}};
  if (!planar) {
    structure.equivariances = {{"Z", mirror}};
    structure.reversors.push_back({"RZ", reverse * mirror});
  }
  // Equal bodies change places in half a turn.
  if (equal) {
    structure.equivariances.push_back({"S", half_turn});
    structure.reversors.push_back({"RS", reverse * half_turn});
    if (!planar) {
      structure.equivariances.push_back({"SZ", half_turn * mirror});
      structure.reversors.push_back({"RSZ", reverse * half_turn * mirror});
    }
  }
  structure.symplectic = true;
  return structure;
}

template struct Registered<Pcr3bp<>>;
template struct Registered<Cr3bp<>>;

}  // namespace orbweaver::systems
