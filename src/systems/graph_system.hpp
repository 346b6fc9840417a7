#pragma once

#include <array>
#include <functional>
#include <initializer_list>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "orbweaver/model/graph.hpp"
#include "orbweaver/systems/formulas.hpp"
#include "orbweaver/systems/quad_system.hpp"
#include "orbweaver/systems/system.hpp"

namespace orbweaver::systems {

/// A system's functions as nodes of one graph, in the units of its parameters: inputs 0 .. d - 1 are the state.
struct Equations {
  model::Graph graph;
  std::vector<std::string> parameters;  ///< in the order of the graph's
  std::vector<int> field;
  std::vector<int> conserved;  ///< one a conserved quantity of the structure
  std::vector<int> guards;     ///< one a guard of the structure
  int action = -1;             ///< p dq/dt; -1: none
};

struct Reduction;

/// What is told of a system beside its equations.
struct Frame {
  ModelInfo info;
  Structure structure;
  Scales scales;
  std::shared_ptr<const Reduction> reduction;  ///< of a system without its linear quantities
  bool has_action = true;                      ///< false: the equations' action density is not the system's
};

/// The system that equations make with values of their parameters. Programs for them are made when they are first asked
/// for; systems with other values share them.
class GraphSystem final : public System, public QuadSystem, public FormulaSystem {
 public:
  using FrameOf = std::function<Frame(const std::shared_ptr<const GraphSystem>& whole)>;

  /// Of a model. `sizes`: parameters that are in the equations already.
  GraphSystem(Equations equations, Frame frame, std::vector<double> values, std::map<std::string, double> sizes,
              FamilyScalars scalars);
  /// Of another system's transformed equations; their parameters are its, then `added` ones with the values given.
  /// `frame_of`: what is told of the transformed system, by the other one; `hangs_on_values`: it is another one where
  /// parameters have other values.
  GraphSystem(const std::shared_ptr<const GraphSystem>& whole, Equations equations, const std::vector<double>& added,
              FamilyScalars scalars, const FrameOf& frame_of, bool hangs_on_values = false);

  [[nodiscard]] const Equations& equations() const;
  [[nodiscard]] const Frame& frame() const { return *_frame; }

  [[nodiscard]] const ModelInfo& info() const override { return _frame->info; }
  [[nodiscard]] const Structure& structure() const override { return _frame->structure; }
  [[nodiscard]] const std::map<std::string, double>& parameters() const override { return _parameters; }
  [[nodiscard]] const Scales& scales() const override { return _frame->scales; }
  [[nodiscard]] const FamilyScalars& family_scalars() const override { return _scalars; }

  void field(std::size_t nodes, const double* z, double* f) const override;
  void field_jacobian(std::size_t nodes, const double* z, double* f, double* jacobian) const override;
  void second_derivatives(std::size_t nodes, const double* z, const double* weights, double* contracted) const override;
  void parameter_derivatives(const std::string& name, std::size_t nodes, const double* z,
                             double* derivatives) const override;
  [[nodiscard]] std::shared_ptr<const System> with_parameters(
      const std::map<std::string, double>& values) const override;

  [[nodiscard]] double conserved(int k, std::span<const double> z) const override;
  void conserved_gradient(int k, std::span<const double> z, std::span<double> gradient) const override {
    conserved_gradients(k, 1, z.data(), gradient.data());
  }
  void conserved_gradients(int k, std::size_t nodes, const double* z, double* gradients) const override;
  [[nodiscard]] double guard(int k, std::span<const double> z) const override;
  [[nodiscard]] double action_density(std::span<const double> z) const override;

  void linearize(const numerics::QuadVector& z, numerics::QuadVector& f, numerics::QuadMatrix& jacobian) const override;
  [[nodiscard]] Formulas formulas() const override;

 private:
  class Programs;
  enum Kind : std::size_t { rate, linear, second, action, quantity, gradient, guarded, by_parameter, kinds };

  GraphSystem(const GraphSystem& other, std::shared_ptr<const GraphSystem> whole, std::shared_ptr<const Frame> frame,
              std::vector<double> values);

  [[nodiscard]] std::size_t size() const { return static_cast<std::size_t>(_frame->structure.dimension); }
  void require_quantity(int k) const;
  void name_parameters();
  [[nodiscard]] double one(Kind kind, int number, std::span<const double> z) const;
  void run(Kind kind, std::size_t number, std::size_t nodes, std::span<const double* const> in,
           std::span<double* const> out) const;
  void run_one(Kind kind, std::size_t number, const double* z, std::initializer_list<std::span<double>> out) const;
  [[nodiscard]] const std::vector<double>& scalars_of(Kind kind, std::size_t number) const;

  std::shared_ptr<Programs> _programs;
  std::shared_ptr<const Frame> _frame;
  std::shared_ptr<const GraphSystem> _whole;  // where the frame hangs on values
  FrameOf _frame_of;
  std::vector<double> _values;
  std::map<std::string, double> _sizes;
  std::map<std::string, double> _parameters;
  FamilyScalars _scalars;
  mutable std::array<std::vector<std::vector<double>>, kinds> _scalars_of;
};

/// Throws MisuseError for a system that is no such one.
[[nodiscard]] std::shared_ptr<const GraphSystem> graph_system(const std::shared_ptr<const System>& system);

}  // namespace orbweaver::systems
