#include "double_pendulum.hpp"

#include <limits>

#include "orbweaver/systems/model/model_system.hpp"

namespace orbweaver::systems {

ModelInfo ideal_double_pendulum() {
  constexpr double inf = std::numeric_limits<double>::infinity();
  ModelInfo info;
  info.name = "double_pendulum";
  info.title = "Ideal double pendulum";
  info.meaning = "two point masses on massless rods under gravity";
  info.state_names = {"th1", "th2", "w1", "w2"};
  info.winding_names = {"n1", "n2", "", ""};
  info.parameters = {
      {"m1", 1.0, 0.0, inf, true, "kg", "mass of the inner bob"},
      {"m2", 1.0, 0.0, inf, true, "kg", "mass of the outer bob"},
      {"l1", 1.0, 0.0, inf, true, "m", "length of the inner rod"},
      {"l2", 1.0, 0.0, inf, true, "m", "length of the outer rod"},
      {"g", 1.0, 0.0, inf, true, "m/s^2", "gravity"},
  };
  info.effects = {RodInertia::info(), TorsionSprings::info(), JointDamping::info(), PivotDrive::info(),
                  JointTorque::info()};
  return info;
}

Structure structure_of_ideal_double_pendulum() {
  const Eigen::Matrix4d reverse = Eigen::Vector4d(1, 1, -1, -1).asDiagonal();
  const Eigen::Matrix4d mirror = -Eigen::Matrix4d::Identity();
  Structure structure;
  structure.dimension = 4;
  structure.angles = {0, 1};
  structure.conserved = {"energy"};
  structure.equivariances = {{"S", mirror}};
  structure.reversors = {{"R", reverse}, {"RS", -reverse}};
  structure.symplectic = true;
  return structure;
}

template struct Registered<DoublePendulum<>>;

}  // namespace orbweaver::systems
