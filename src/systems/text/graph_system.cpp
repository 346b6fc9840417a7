#include "orbweaver/systems/text/graph_system.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "found_structure.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/model/block_program.hpp"
#include "orbweaver/model/derivatives.hpp"
#include "orbweaver/systems/formulas.hpp"
#include "orbweaver/systems/model/checks.hpp"
#include "linearized_formulas.hpp"
#include "orbweaver/systems/quad_system.hpp"

namespace orbweaver::systems {

namespace {

/// What systems with other values of the parameters share: the model, and its programs, made when they are first asked
/// for.
class Compiled {
 public:
  BuiltModel model;
  std::vector<int> conserved;

  /// Of what there is one program; of the others one a number: a quantity, a guard, a parameter.
  enum Kind : std::size_t { field, linear, second, action, quantity, gradient, guard, by_parameter, kinds };

  const model::BlockProgram& program(Kind kind, std::size_t number) {
    std::vector<std::unique_ptr<const model::BlockProgram>>& own = _programs[kind];
    if (own.size() <= number) own.resize(number + 1);
    if (!own[number]) {
      const std::vector<int> nodes = nodes_of(kind, number);
      own[number] = std::make_unique<const model::BlockProgram>(model.graph, nodes);
    }
    return *own[number];
  }

  [[nodiscard]] int dimension() const { return static_cast<int>(model.field.size()); }
  /// The input of number 0 of the weights, behind the state.
  [[nodiscard]] int first_weight() const { return dimension(); }
  const Formulas& formulas(const std::vector<double>& values) {
    if (_formulas.field.empty()) make_formulas();
    _formulas.values = values;
    return _formulas;
  }

 private:
  std::vector<int> nodes_of(Kind kind, std::size_t number) {
    switch (kind) {
      case linear: return linear_nodes();
      case second: return second_nodes();
      case action: return {model.action};
      case quantity: return {conserved[number]};
      case gradient: return gradient_nodes(number);
      case guard: return {model.guards[number]};
      case by_parameter: return parameter_nodes(number);
      default: return model.field;
    }
  }

  std::vector<int> linear_nodes() {
    std::vector<int> nodes = model.field;
    const std::vector<int> slopes = model::jacobian(model.graph, model.field, dimension());
    nodes.insert(nodes.end(), slopes.begin(), slopes.end());
    return nodes;
  }
  std::vector<int> second_nodes() {
    model::Graph& graph = model.graph;
    const auto d = static_cast<std::size_t>(dimension());
    int sum = graph.constant(0.0);
    for (std::size_t i = 0; i < d; ++i)
      sum = graph.add(sum, graph.multiply(graph.input(first_weight() + static_cast<int>(i)), model.field[i]));
    const std::vector<int> slopes = or_zero(model::gradient(graph, sum, states()));
    const std::vector<int> bends = model::jacobian(graph, slopes, dimension());
    std::vector<int> nodes(d * d);
    for (std::size_t l = 0; l < d; ++l)
      for (std::size_t m = 0; m < d; ++m) nodes[l * d + m] = bends[std::max(l, m) * d + std::min(l, m)];
    return nodes;
  }
  std::vector<int> parameter_nodes(std::size_t number) {
    model::Direction direction;
    direction.parameters.assign(model.parameters.size(), -1);
    direction.parameters[number] = model.graph.constant(1.0);
    return or_zero(model::derivatives_along(model.graph, model.field, direction));
  }
  std::vector<int> gradient_nodes(std::size_t number) {
    return or_zero(model::gradient(model.graph, conserved[number], states()));
  }

  [[nodiscard]] std::vector<int> states() const {
    std::vector<int> numbers;
    for (int i = 0; i < dimension(); ++i) numbers.push_back(i);
    return numbers;
  }
  std::vector<int> or_zero(std::vector<int> nodes) {
    for (int& node : nodes)
      if (node < 0) node = model.graph.constant(0.0);
    return nodes;
  }

  void make_formulas() {
    model::Graph& graph = model.graph;
    const int d = dimension();
    _formulas.dimension = d;
    _formulas.field = model.field;
    _formulas.parameters = model.parameters;
    _formulas.conserved = conserved;
    for (std::size_t k = 0; k < conserved.size(); ++k) _formulas.conserved_gradients.push_back(gradient_nodes(k));
    _formulas.variations.resize(model.field.size() * model.field.size());
    for (int c = 0; c < d; ++c) {
      model::Direction direction;
      for (int i = 0; i < d; ++i) direction.inputs.push_back(graph.input(d + i * d + c));
      const std::vector<int> column = or_zero(model::derivatives_along(graph, model.field, direction));
      for (int i = 0; i < d; ++i)
        _formulas.variations[static_cast<std::size_t>(i * d + c)] = column[static_cast<std::size_t>(i)];
    }
    _formulas.graph = graph;
  }

  std::array<std::vector<std::unique_ptr<const model::BlockProgram>>, kinds> _programs;
  Formulas _formulas;
};

/// The rows of one call: of `nodes` numbers behind one another. One at a time.
template <class Number>
class Rows {
 public:
  Rows& add(Number* first, std::size_t count, std::size_t nodes) {
    for (std::size_t i = 0; i < count; ++i) _rows.push_back(first + i * nodes);
    return *this;
  }
  Rows& clear() {
    _rows.clear();
    return *this;
  }
  operator std::span<Number* const>() const { return _rows; }

 private:
  std::vector<Number*> _rows;
};

class GraphSystem final : public System, public QuadSystem, public FormulaSystem {
 public:
  GraphSystem(std::shared_ptr<Compiled> compiled, Structure structure, std::vector<double> values,
              FamilyScalars scalars)
      : _compiled(std::move(compiled)),
        _structure(std::move(structure)),
        _values(std::move(values)),
        _parameters(model().sizes),
        _scalars(std::move(scalars)) {
    for (std::size_t n = 0; n < _values.size(); ++n) _parameters[model().parameters[n]] = _values[n];
  }

  [[nodiscard]] const ModelInfo& info() const override { return model().info; }
  [[nodiscard]] const Structure& structure() const override { return _structure; }
  [[nodiscard]] const std::map<std::string, double>& parameters() const override { return _parameters; }
  [[nodiscard]] const FamilyScalars& family_scalars() const override { return _scalars; }

  void field(std::size_t nodes, const double* z, double* f) const override {
    if (nodes == 1) return run_one(Compiled::field, 0, z, {{f, size()}});
    run(Compiled::field, 0, nodes, states(nodes, z), results().add(f, size(), nodes));
  }

  void field_jacobian(std::size_t nodes, const double* z, double* f, double* jacobian) const override {
    if (nodes == 1) return run_one(Compiled::linear, 0, z, {{f, size()}, {jacobian, size() * size()}});
    run(Compiled::linear, 0, nodes, states(nodes, z),
        results().add(f, size(), nodes).add(jacobian, size() * size(), nodes));
  }

  void second_derivatives(std::size_t nodes, const double* z, const double* weights,
                          double* contracted) const override {
    run(Compiled::second, 0, nodes, states(nodes, z).add(weights, size(), nodes),
        results().add(contracted, size() * size(), nodes));
  }

  void parameter_derivatives(const std::string& name, std::size_t nodes, const double* z,
                             double* derivatives) const override {
    const auto at = std::find(model().parameters.begin(), model().parameters.end(), name);
    core::require(at != model().parameters.end(), "a field is differentiated by a parameter that it has");
    run(Compiled::by_parameter, static_cast<std::size_t>(at - model().parameters.begin()), nodes, states(nodes, z),
        results().add(derivatives, size(), nodes));
  }

  [[nodiscard]] std::shared_ptr<const System> with_parameters(
      const std::map<std::string, double>& values) const override {
    std::vector<double> moved = _values;
    for (const auto& [name, value] : values) {
      if (const auto size = model().sizes.find(name); size != model().sizes.end() && size->second == value) continue;
      const auto at = std::find(model().parameters.begin(), model().parameters.end(), name);
      core::require(at != model().parameters.end(), "a system moves parameters that it has");
      moved[static_cast<std::size_t>(at - model().parameters.begin())] = value;
    }
    return std::make_shared<const GraphSystem>(_compiled, _structure, std::move(moved), _scalars);
  }

  [[nodiscard]] double conserved(int k, std::span<const double> z) const override {
    require_quantity(k);
    return one(Compiled::quantity, k, z);
  }
  void conserved_gradient(int k, std::span<const double> z, std::span<double> gradient) const override {
    conserved_gradients(k, 1, z.data(), gradient.data());
  }
  void conserved_gradients(int k, std::size_t nodes, const double* z, double* gradients) const override {
    require_quantity(k);
    if (nodes == 1) return run_one(Compiled::gradient, static_cast<std::size_t>(k), z, {{gradients, size()}});
    run(Compiled::gradient, static_cast<std::size_t>(k), nodes, states(nodes, z),
        results().add(gradients, size(), nodes));
  }

  [[nodiscard]] double guard(int k, std::span<const double> z) const override {
    if (k < 0 || k >= static_cast<int>(_structure.guards.size())) return System::guard(k, z);
    return one(Compiled::guard, k, z);
  }

  [[nodiscard]] double action_density(std::span<const double> z) const override {
    return model().action < 0 ? std::numeric_limits<double>::quiet_NaN() : one(Compiled::action, 0, z);
  }

  void linearize(const numerics::QuadVector& z, numerics::QuadVector& f,
                 numerics::QuadMatrix& jacobian) const override {
    linearize_formulas(_compiled->formulas(_values), z, f, jacobian);
  }

  [[nodiscard]] Formulas formulas() const override { return _compiled->formulas(_values); }

 private:
  [[nodiscard]] const BuiltModel& model() const { return _compiled->model; }
  [[nodiscard]] std::size_t size() const { return static_cast<std::size_t>(_structure.dimension); }
  void require_quantity(int k) const {
    core::require(k >= 0 && k < static_cast<int>(_structure.conserved.size()),
                  "the structure names no such conserved quantity");
  }

  /// Valid until the next call, as the results.
  Rows<const double>& states(std::size_t nodes, const double* z) const {
    thread_local Rows<const double> rows;
    return rows.clear().add(z, size(), nodes);
  }
  static Rows<double>& results() {
    thread_local Rows<double> rows;
    return rows.clear();
  }
  [[nodiscard]] double one(Compiled::Kind kind, int number, std::span<const double> z) const {
    double value = 0.0;
    run_one(kind, static_cast<std::size_t>(number), z.data(), {{&value, 1}});
    return value;
  }

  void run(Compiled::Kind kind, std::size_t number, std::size_t nodes, std::span<const double* const> in,
           std::span<double* const> out) const {
    const model::BlockProgram& program = _compiled->program(kind, number);
    program.run(scalars_of(program, kind, number), nodes, in, out);
  }
  void run_one(Compiled::Kind kind, std::size_t number, const double* z,
               std::initializer_list<std::span<double>> out) const {
    const model::BlockProgram& program = _compiled->program(kind, number);
    program.run_one(scalars_of(program, kind, number), {z, size()}, out);
  }
  const std::vector<double>& scalars_of(const model::BlockProgram& program, Compiled::Kind kind,
                                        std::size_t number) const {
    std::vector<std::vector<double>>& own = _scalars_of[kind];
    if (own.size() <= number) own.resize(number + 1);
    if (own[number].empty()) own[number] = program.scalars(_values);
    return own[number];
  }

  std::shared_ptr<Compiled> _compiled;
  Structure _structure;
  std::vector<double> _values;
  std::map<std::string, double> _parameters;
  FamilyScalars _scalars;
  mutable std::array<std::vector<std::vector<double>>, Compiled::kinds> _scalars_of;
};

}  // namespace

namespace {

std::vector<double> values_of(const BuiltModel& model, const Bound& bound) {
  std::vector<double> values;
  for (const std::string& name : model.parameters) values.push_back(bound[name]);
  return values;
}

}  // namespace

std::shared_ptr<const System> system_of(BuiltModel model, const Bound& bound) {
  std::vector<double> values = values_of(model, bound);
  const auto compiled = std::make_shared<Compiled>();
  compiled->model = std::move(model);
  Structure structure = found_structure(compiled->model, values, bound.scalars.free, compiled->conserved);
  check(structure, compiled->model.info, structure.dimension, static_cast<int>(structure.conserved.size()));
  return std::make_shared<const GraphSystem>(compiled, std::move(structure), std::move(values), bound.scalars);
}

std::shared_ptr<const System> system_of(BuiltModel model, Structure structure, const Bound& bound) {
  const auto quantities = static_cast<int>(model.quantities.size());
  const auto dimension = static_cast<int>(model.field.size());
  check(structure, model.info, dimension, quantities);
  if (model.guards.empty()) check_without_guards(structure);
  if (model.action < 0) check_without_action_density(structure);
  std::vector<double> own = values_of(model, bound);
  const auto compiled = std::make_shared<Compiled>();
  compiled->model = std::move(model);
  for (const BuiltModel::Quantity& quantity : compiled->model.quantities) compiled->conserved.push_back(quantity.node);
  // All quantities are the structure's while it is asked which of them the field keeps.
  Structure whole = structure;
  whole.conserved.resize(static_cast<std::size_t>(quantities));
  const GraphSystem asked(compiled, std::move(whole), own, bound.scalars);
  check_unnamed(structure, quantities, [&](int k, const double* z, double* f, double* gradient) {
    asked.field(1, z, f);
    asked.conserved_gradients(k, 1, z, gradient);
  });
  compiled->conserved.resize(structure.conserved.size());
  return std::make_shared<const GraphSystem>(compiled, std::move(structure), std::move(own), bound.scalars);
}

}  // namespace orbweaver::systems
