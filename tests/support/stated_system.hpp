#pragma once

#include <limits>
#include <map>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>

#include "orbweaver/systems/registry.hpp"
#include "orbweaver/systems/system.hpp"

namespace orbweaver::test {

/// What all systems made for one test have in common: a structure as stated, no parameters, and nothing beyond the
/// field unless the test says so.
class StatedSystem : public systems::System {
 public:
  explicit StatedSystem(systems::Structure structure, const std::string& name = "test")
      : _structure(std::move(structure)) {
    _info.name = name;
    // Not as sums of texts: g++ 12 sees an overflow in them.
    for (int i = 0; i < _structure.dimension; ++i) {
      _info.state_names.emplace_back("z").append(std::to_string(i));
      _info.winding_names.emplace_back("n").append(std::to_string(i));
    }
  }

  [[nodiscard]] const systems::ModelInfo& info() const override { return _info; }
  [[nodiscard]] const systems::Structure& structure() const override { return _structure; }
  [[nodiscard]] const std::map<std::string, double>& parameters() const override { return _parameters; }
  void second_derivatives(std::size_t, const double*, const double*, double*) const override {
    throw std::logic_error("this test needs no second derivatives");
  }
  [[nodiscard]] double conserved(int, std::span<const double>) const override {
    return std::numeric_limits<double>::quiet_NaN();
  }
  void conserved_gradient(int, std::span<const double>, std::span<double>) const override {
    throw std::logic_error("this test needs no gradient");
  }
  [[nodiscard]] double action_density(std::span<const double>) const override {
    return std::numeric_limits<double>::quiet_NaN();
  }

 private:
  systems::ModelInfo _info;
  systems::Structure _structure;
  std::map<std::string, double> _parameters;
};

[[nodiscard]] inline systems::Structure structure_of(int dimension, bool conservative = false,
                                                     bool symplectic = false) {
  systems::Structure structure;
  structure.dimension = dimension;
  if (conservative) structure.conserved = {"energy"};
  structure.symplectic = symplectic;
  return structure;
}

/// The structure of a registered system with its standard parameters.
[[nodiscard]] inline const systems::Structure& structure_of(const std::string& name) {
  static std::map<std::string, std::shared_ptr<const systems::System>> known;
  std::shared_ptr<const systems::System>& system = known[name];
  if (!system) system = systems::make_system(name);
  return system->structure();
}

}  // namespace orbweaver::test
