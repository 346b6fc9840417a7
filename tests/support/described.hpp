#pragma once

#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "orbweaver/systems/model_info.hpp"
#include "orbweaver/systems/structure.hpp"

namespace orbweaver::test {

/// What a system of the tests says of itself: no coordinate is an angle that winds, all coefficients are any numbers.
inline systems::ModelInfo described(std::string name, std::string meaning, std::vector<std::string> states,
                                    const std::vector<std::string>& coefficients = {}, double each = 1.0) {
  constexpr double any = std::numeric_limits<double>::infinity();
  systems::ModelInfo info;
  info.name = std::move(name);
  info.title = meaning;
  info.meaning = std::move(meaning);
  info.winding_names.resize(states.size());
  info.state_names = std::move(states);
  for (const std::string& coefficient : coefficients)
    info.parameters.push_back({coefficient, each, -any, any, false, "1", "coefficient"});
  return info;
}

/// Of a particle in the plane, by its two coordinates and their momenta: an energy, and the same motions backwards.
inline systems::Structure structure_in_plane() {
  const Eigen::Matrix4d back = Eigen::Vector4d(1, 1, -1, -1).asDiagonal();
  systems::Structure structure;
  structure.dimension = 4;
  structure.conserved = {"energy"};
  structure.symplectic = true;
  structure.reversors = {{"R", back}};
  return structure;
}

/// Without an energy, and motions lose their past.
inline systems::Structure dissipative_structure(int dimension) {
  systems::Structure structure;
  structure.dimension = dimension;
  structure.dissipative = true;
  return structure;
}

}  // namespace orbweaver::test
