#pragma once

#include <map>
#include <string>
#include <vector>

#include "orbweaver/model/graph.hpp"
#include "orbweaver/systems/model_info.hpp"
#include "orbweaver/systems/structure.hpp"
#include "orbweaver/systems/text/model_text.hpp"

namespace orbweaver::systems {

/// A model with the effects asked for as one graph: inputs are the coordinates of the state, in their order. Lists are
/// nodes.
struct BuiltModel {
  model::Graph graph;
  ModelInfo info;
  std::vector<std::string> effects;     ///< that are on, in the text's order
  std::vector<std::string> parameters;  ///< in the order of the graph's
  std::map<std::string, double> sizes;
  std::vector<int> field;
  /// What may be conserved: the energy first. `claimed` says whether the text says so, or it follows from its form.
  struct Quantity {
    std::string name;
    int node = -1;
    bool claimed = false;
  };
  std::vector<Quantity> quantities;
  std::vector<int> guards;
  int action = -1;  ///< p dq/dt; -1: none
  /// The image of a state, coordinate by coordinate.
  struct Image {
    std::string name;
    bool reverses = false;
    bool if_it_holds = false;
    std::vector<int> nodes;
    std::string place;
  };
  std::vector<Image> images;
  std::vector<int> angles;
  std::vector<Guard> named_guards;
  bool is_canonical = false;  ///< of a Hamiltonian or a Lagrangian, without forces
  bool is_driven = false;     ///< the last coordinate is the phase of a drive
  int power = -1;             ///< of the forces; -1: none act
  /// How fast volumes of the space of states grow, in coordinates and momenta where it has them; -1: they stay.
  int growth = -1;
  std::string place;
};

/// Names, parameters and effects of a text, with sizes of their standard values.
[[nodiscard]] ModelInfo info_of(const ModelText& text);

/// Throws core::InputError with the place of what is wrong. `values`: of sizes and parameters, where they are not the
/// standard ones.
[[nodiscard]] BuiltModel build_model(const ModelText& text, const std::map<std::string, double>& values,
                                     const std::vector<std::string>& effects);

}  // namespace orbweaver::systems
