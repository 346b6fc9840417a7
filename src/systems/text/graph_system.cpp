#include "orbweaver/systems/text/graph_system.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "found_structure.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/model/block_program.hpp"
#include "orbweaver/model/derivatives.hpp"
#include "orbweaver/systems/formulas.hpp"
#include "orbweaver/systems/model/checks.hpp"
#include "orbweaver/systems/model/linearized_formulas.hpp"
#include "orbweaver/systems/quad_system.hpp"

namespace orbweaver::systems {

namespace {

/// What systems with other values of the parameters share: the model, and its programs, made when they are first asked
/// for.
class Compiled {
 public:
  BuiltModel model;
  std::vector<int> conserved;

  using Make = std::vector<int> (Compiled::*)(const std::string&);

  const model::BlockProgram& field() { return program("field", {}, &Compiled::field_nodes); }
  const model::BlockProgram& linear() { return program("linear", {}, &Compiled::linear_nodes); }
  const model::BlockProgram& second() { return program("second", {}, &Compiled::second_nodes); }
  const model::BlockProgram& by_parameter(const std::string& name) {
    return program("by", name, &Compiled::parameter_nodes);
  }
  const model::BlockProgram& quantity(int k) { return program("quantity", std::to_string(k), &Compiled::quantity_nodes); }
  const model::BlockProgram& gradient(int k) { return program("gradient", std::to_string(k), &Compiled::gradient_nodes); }
  const model::BlockProgram& guard(int k) { return program("guard", std::to_string(k), &Compiled::guard_nodes); }
  const model::BlockProgram& action() { return program("action", {}, &Compiled::action_nodes); }

  [[nodiscard]] int dimension() const { return static_cast<int>(model.field.size()); }
  /// The input of number 0 of the weights, behind the state.
  [[nodiscard]] int first_weight() const { return dimension(); }
  /// Whose sum with factors n, n + 1, ... of the inputs are: variations of formulas.
  const Formulas& formulas(const std::vector<double>& values) {
    if (_formulas.field.empty()) make_formulas();
    _formulas.values = values;
    return _formulas;
  }

 private:
  const model::BlockProgram& program(const char* kind, const std::string& which, Make make) {
    std::unique_ptr<const model::BlockProgram>& own = _programs[{kind, which}];
    if (!own) {
      const std::vector<int> nodes = (this->*make)(which);
      own = std::make_unique<const model::BlockProgram>(model.graph, nodes);
    }
    return *own;
  }

  std::vector<int> field_nodes(const std::string&) { return model.field; }
  std::vector<int> linear_nodes(const std::string&) {
    std::vector<int> nodes = model.field;
    const std::vector<int> slopes = model::jacobian(model.graph, model.field, dimension());
    nodes.insert(nodes.end(), slopes.begin(), slopes.end());
    return nodes;
  }
  std::vector<int> second_nodes(const std::string&) {
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
  std::vector<int> parameter_nodes(const std::string& name) {
    model::Direction direction;
    for (const std::string& own : model.parameters)
      direction.parameters.push_back(own == name ? model.graph.constant(1.0) : -1);
    return or_zero(model::derivatives_along(model.graph, model.field, direction));
  }
  std::vector<int> quantity_nodes(const std::string& k) { return {conserved[std::stoul(k)]}; }
  std::vector<int> gradient_nodes(const std::string& k) {
    return or_zero(model::gradient(model.graph, conserved[std::stoul(k)], states()));
  }
  std::vector<int> guard_nodes(const std::string& k) { return {model.guards[std::stoul(k)]}; }
  std::vector<int> action_nodes(const std::string&) { return {model.action}; }

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
    for (std::size_t k = 0; k < conserved.size(); ++k)
      _formulas.conserved_gradients.push_back(gradient_nodes(std::to_string(k)));
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

  std::map<std::pair<std::string, std::string>, std::unique_ptr<const model::BlockProgram>> _programs;
  Formulas _formulas;
};

/// Rows of `nodes` numbers behind one another.
template <class Number>
void add_rows(std::vector<Number*>& rows, Number* first, std::size_t count, std::size_t nodes) {
  for (std::size_t i = 0; i < count; ++i) rows.push_back(first + i * nodes);
}

class GraphSystem final : public System, public QuadSystem, public FormulaSystem {
 public:
  GraphSystem(std::shared_ptr<Compiled> compiled, Structure structure, std::vector<double> values, FamilyScalars scalars)
      : _compiled(std::move(compiled)),
        _structure(std::move(structure)),
        _values(std::move(values)),
        _scalars(std::move(scalars)) {
    for (std::size_t n = 0; n < _values.size(); ++n) _parameters[model().parameters[n]] = _values[n];
  }

  [[nodiscard]] const ModelInfo& info() const override { return model().info; }
  [[nodiscard]] const Structure& structure() const override { return _structure; }
  [[nodiscard]] const std::map<std::string, double>& parameters() const override { return _parameters; }
  [[nodiscard]] const FamilyScalars& family_scalars() const override { return _scalars; }

  void field(std::size_t nodes, const double* z, double* f) const override {
    std::vector<double*> out;
    add_rows(out, f, size(), nodes);
    run(_compiled->field(), nodes, states(nodes, z), out);
  }

  void field_jacobian(std::size_t nodes, const double* z, double* f, double* jacobian) const override {
    std::vector<double*> out;
    add_rows(out, f, size(), nodes);
    add_rows(out, jacobian, size() * size(), nodes);
    run(_compiled->linear(), nodes, states(nodes, z), out);
  }

  void second_derivatives(std::size_t nodes, const double* z, const double* weights,
                          double* contracted) const override {
    std::vector<const double*> in = states(nodes, z);
    add_rows(in, weights, size(), nodes);
    std::vector<double*> out;
    add_rows(out, contracted, size() * size(), nodes);
    run(_compiled->second(), nodes, in, out);
  }

  void parameter_derivatives(const std::string& name, std::size_t nodes, const double* z,
                             double* derivatives) const override {
    core::require(_parameters.contains(name), "a field is differentiated by a parameter that it has");
    std::vector<double*> out;
    add_rows(out, derivatives, size(), nodes);
    run(_compiled->by_parameter(name), nodes, states(nodes, z), out);
  }

  [[nodiscard]] std::shared_ptr<const System> with_parameters(
      const std::map<std::string, double>& values) const override {
    std::vector<double> moved = _values;
    for (const auto& [name, value] : values) {
      const auto at = std::find(model().parameters.begin(), model().parameters.end(), name);
      core::require(at != model().parameters.end(), "a system moves parameters that it has");
      moved[static_cast<std::size_t>(at - model().parameters.begin())] = value;
    }
    return std::make_shared<const GraphSystem>(_compiled, _structure, std::move(moved), _scalars);
  }

  [[nodiscard]] double conserved(int k, std::span<const double> z) const override {
    require_quantity(k);
    return one(_compiled->quantity(k), z);
  }
  void conserved_gradient(int k, std::span<const double> z, std::span<double> gradient) const override {
    conserved_gradients(k, 1, z.data(), gradient.data());
  }
  void conserved_gradients(int k, std::size_t nodes, const double* z, double* gradients) const override {
    require_quantity(k);
    std::vector<double*> out;
    add_rows(out, gradients, size(), nodes);
    run(_compiled->gradient(k), nodes, states(nodes, z), out);
  }

  [[nodiscard]] double guard(int k, std::span<const double> z) const override {
    if (k < 0 || k >= static_cast<int>(_structure.guards.size())) return System::guard(k, z);
    return one(_compiled->guard(k), z);
  }

  [[nodiscard]] double action_density(std::span<const double> z) const override {
    return model().action < 0 ? std::numeric_limits<double>::quiet_NaN() : one(_compiled->action(), z);
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

  [[nodiscard]] std::vector<const double*> states(std::size_t nodes, const double* z) const {
    std::vector<const double*> in;
    add_rows(in, z, size(), nodes);
    return in;
  }
  [[nodiscard]] double one(const model::BlockProgram& program, std::span<const double> z) const {
    double value = 0.0;
    std::vector<double*> out{&value};
    run(program, 1, states(1, z.data()), out);
    return value;
  }

  void run(const model::BlockProgram& program, std::size_t nodes, const std::vector<const double*>& in,
           const std::vector<double*>& out) const {
    std::vector<double>& scalars = _scalars_of[&program];
    if (scalars.empty()) scalars = program.scalars(_values);
    program.run(scalars, nodes, in, out);
  }

  std::shared_ptr<Compiled> _compiled;
  Structure _structure;
  std::vector<double> _values;
  std::map<std::string, double> _parameters;
  FamilyScalars _scalars;
  mutable std::map<const model::BlockProgram*, std::vector<double>> _scalars_of;
};

}  // namespace

std::shared_ptr<const System> system_of(BuiltModel model, const std::map<std::string, double>& values,
                                        const FamilyScalars& scalars) {
  std::vector<double> own;
  for (const std::string& name : model.parameters) own.push_back(values.at(name));
  const auto compiled = std::make_shared<Compiled>();
  compiled->model = std::move(model);
  Structure structure = found_structure(compiled->model, own, scalars.free, compiled->conserved);
  check(structure, compiled->model.info, structure.dimension, static_cast<int>(structure.conserved.size()));
  return std::make_shared<const GraphSystem>(compiled, std::move(structure), std::move(own), scalars);
}

std::shared_ptr<const System> system_of(BuiltModel model, Structure structure, const Bound& bound) {
  const auto quantities = static_cast<int>(model.quantities.size());
  const auto dimension = static_cast<int>(model.field.size());
  check(structure, model.info, dimension, quantities);
  if (model.guards.empty()) check_without_guards(structure);
  if (model.action < 0) check_without_action_density(structure);
  std::vector<double> own;
  for (const std::string& name : model.parameters) own.push_back(bound[name]);
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
