#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "orbweaver/systems/family_scalars.hpp"
#include "orbweaver/systems/model_info.hpp"
#include "orbweaver/systems/scales.hpp"
#include "orbweaver/systems/structure.hpp"

namespace orbweaver::systems {

/// An autonomous vector field dz/dt = f(z) with its parameters and effects bound. Immutable; safe to share in a
/// process.
///
/// Nodal arrays are component-major: coordinate i of node j stands at [i * nodes + j]. Registered systems evaluate
/// several nodes at once; a node's bits depend neither on the other nodes nor on its place among them. Functions do not
/// check for NaN: the loss does, and says at which node.
class System {
 public:
  virtual ~System() = default;
  System() = default;
  System(const System&) = delete;
  System& operator=(const System&) = delete;

  /// What could be asked of its model.
  [[nodiscard]] virtual const ModelInfo& info() const = 0;
  /// What holds with these parameters and effects.
  [[nodiscard]] virtual const Structure& structure() const = 0;
  /// Bound value of every parameter, by name (defaults filled in).
  [[nodiscard]] virtual const std::map<std::string, double>& parameters() const = 0;
  /// The units in which its states, times and conserved quantities are told: 1 unless it is a scaled one
  /// (systems/scaled_system.hpp).
  [[nodiscard]] virtual const Scales& scales() const;
  /// What moves along its families. Loops of such a system carry the values (loop::Loop::parameters).
  [[nodiscard]] virtual const FamilyScalars& family_scalars() const;
  [[nodiscard]] int dimension() const { return structure().dimension; }
  /// Of a parameter: that of its scales where it moves along families, else 1.
  [[nodiscard]] double parameter_scale(const std::string& name) const;
  /// One an angle of the structure.
  [[nodiscard]] std::vector<std::string> winding_names() const;

  /// f at each node. `z`, `f`: dimension x nodes.
  virtual void field(std::size_t nodes, const double* z, double* f) const = 0;
  /// f and its Jacobian. `jacobian`: entry (i, l) = df_i/dz_l of node j at [(i * dimension + l) * nodes + j].
  virtual void field_jacobian(std::size_t nodes, const double* z, double* f, double* jacobian) const = 0;
  /// Second derivatives contracted with `weights` (dimension x nodes): entry (l, m) = sum_i weights_i d2f_i/dz_l dz_m
  /// of node j at [(l * dimension + m) * nodes + j], symmetric.
  virtual void second_derivatives(std::size_t nodes, const double* z, const double* weights,
                                  double* contracted) const = 0;

  /// df/dp for the parameter `name` at each node, p being told in its scale; `derivatives`: dimension x nodes. Throws
  /// MisuseError unless the system can.
  virtual void parameter_derivatives(const std::string& name, std::size_t nodes, const double* z,
                                     double* derivatives) const;
  /// The same system with other values of some parameters, in their units, which may lie outside of their ranges: an
  /// iteration may pass there. Throws MisuseError for a parameter that it does not have, or unless the system can.
  [[nodiscard]] virtual std::shared_ptr<const System> with_parameters(
      const std::map<std::string, double>& values) const;

  /// Conserved quantity k (of structure().conserved) at one state (size dimension). Throws MisuseError if there is
  /// none.
  [[nodiscard]] virtual double conserved(int k, std::span<const double> z) const = 0;
  /// Its gradient at one state; `gradient` has size dimension.
  virtual void conserved_gradient(int k, std::span<const double> z, std::span<double> gradient) const = 0;
  /// The same at each node; `gradients`: dimension x nodes.
  virtual void conserved_gradients(int k, std::size_t nodes, const double* z, double* gradients) const;
  /// Guard k (of structure().guards) at one state. Throws MisuseError if there is none.
  [[nodiscard]] virtual double guard(int k, std::span<const double> z) const;
  /// p . dq/dt at one state, whose time integral over a period is the action; NaN where the system has none.
  [[nodiscard]] virtual double action_density(std::span<const double> z) const = 0;
};

}  // namespace orbweaver::systems
