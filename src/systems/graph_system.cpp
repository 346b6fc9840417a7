#include "graph_system.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "linearized_formulas.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/model/block_program.hpp"
#include "orbweaver/model/derivatives.hpp"
#include "reduced_structure.hpp"

namespace orbweaver::systems {

namespace {

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

void multiply(std::size_t count, double* values, double factor) {
  if (factor == 1.0) return;
  for (std::size_t n = 0; n < count; ++n) values[n] *= factor;
}

/// Valid until the next call, as the results.
Rows<const double>& states(std::size_t size, std::size_t nodes, const double* z) {
  thread_local Rows<const double> rows;
  return rows.clear().add(z, size, nodes);
}

Rows<double>& results() {
  thread_local Rows<double> rows;
  return rows.clear();
}

}  // namespace

/// What systems with other values of the parameters share. Of a kind there is one program, or one a number: a quantity,
/// a guard, a parameter. Derivatives are taken in the units of the parameters and told in scales: with powers of two
/// each number is that of the unscaled system times a power of two, to the last bit.
class GraphSystem::Programs {
 public:
  Programs(Equations equations, Scales scales) : _own(std::move(equations)), _scales(std::move(scales)) {}

  [[nodiscard]] const Equations& equations() const { return _own; }

  const model::BlockProgram& program(Kind kind, std::size_t number) {
    std::vector<std::unique_ptr<const model::BlockProgram>>& own = _programs[kind];
    if (own.size() <= number) own.resize(number + 1);
    if (!own[number]) {
      const std::vector<int> nodes = in_scales(kind, number, nodes_of(kind, number));
      own[number] = std::make_unique<const model::BlockProgram>(_own.graph, nodes);
    }
    return *own[number];
  }

  const Formulas& formulas(const std::vector<double>& values) {
    if (_formulas.field.empty()) make_formulas();
    _formulas.values = values;
    return _formulas;
  }

 private:
  [[nodiscard]] int dimension() const { return static_cast<int>(_own.field.size()); }

  std::vector<int> nodes_of(Kind kind, std::size_t number) {
    switch (kind) {
      case linear: return linear_nodes();
      case second: return second_nodes();
      case action: return {_own.action};
      case quantity: return {_own.conserved[number]};
      case gradient: return gradient_nodes(number);
      case guarded: return {_own.guards[number]};
      case by_parameter: return parameter_nodes(number);
      default: return _own.field;
    }
  }

  std::vector<int> linear_nodes() {
    std::vector<int> nodes = _own.field;
    const std::vector<int> slopes = model::jacobian(_own.graph, _own.field, dimension());
    nodes.insert(nodes.end(), slopes.begin(), slopes.end());
    return nodes;
  }
  std::vector<int> second_nodes() {
    model::Graph& graph = _own.graph;
    const auto d = static_cast<std::size_t>(dimension());
    int sum = graph.constant(0.0);
    for (std::size_t i = 0; i < d; ++i)
      sum = graph.add(sum, graph.multiply(graph.input(dimension() + static_cast<int>(i)), _own.field[i]));
    const std::vector<int> slopes = or_zero(model::gradient(graph, sum, states()));
    const std::vector<int> bends = model::jacobian(graph, slopes, dimension());
    std::vector<int> nodes(d * d);
    for (std::size_t l = 0; l < d; ++l)
      for (std::size_t m = 0; m < d; ++m) nodes[l * d + m] = bends[std::max(l, m) * d + std::min(l, m)];
    return nodes;
  }
  std::vector<int> parameter_nodes(std::size_t number) {
    model::Direction direction;
    direction.parameters.assign(_own.parameters.size(), -1);
    direction.parameters[number] = _own.graph.constant(1.0);
    return or_zero(model::derivatives_along(_own.graph, _own.field, direction));
  }
  std::vector<int> gradient_nodes(std::size_t number) {
    return or_zero(model::gradient(_own.graph, _own.conserved[number], states()));
  }

  [[nodiscard]] std::vector<int> states() const {
    std::vector<int> numbers;
    for (int i = 0; i < dimension(); ++i) numbers.push_back(i);
    return numbers;
  }
  std::vector<int> or_zero(std::vector<int> nodes) {
    for (int& node : nodes)
      if (node < 0) node = _own.graph.constant(0.0);
    return nodes;
  }

  /// x a / b: by one factor where a double has it, so that nothing is rounded where digits are many.
  int in_ratio(int x, double a, double b) {
    const double ratio = a / b;
    if (std::fma(ratio, b, -a) == 0.0) return _own.graph.multiply(x, _own.graph.constant(ratio));
    return _own.graph.divide(_own.graph.multiply(x, _own.graph.constant(a)), _own.graph.constant(b));
  }
  [[nodiscard]] double scale(std::size_t i) const { return _scales.coordinate(i); }
  [[nodiscard]] double unit(std::size_t k) const { return _scales.conserved.empty() ? 1.0 : _scales.conserved[k]; }

  /// The nodes, which a kind of program has in the units of the parameters, of a state and weights in scales.
  std::vector<int> in_scales(Kind kind, std::size_t number, const std::vector<int>& nodes) {
    if (_scales.are_one()) return nodes;
    const auto d = static_cast<std::size_t>(dimension());
    model::Direction inputs;
    for (std::size_t i = 0; i < d; ++i)
      inputs.inputs.push_back(in_ratio(_own.graph.input(static_cast<int>(i)), scale(i), 1.0));
    for (std::size_t i = 0; kind == second && i < d; ++i)
      inputs.inputs.push_back(in_ratio(_own.graph.input(static_cast<int>(d + i)), _scales.time, scale(i)));
    std::vector<int> out = model::substituted(_own.graph, nodes, inputs);
    for (std::size_t n = 0; n < out.size(); ++n) {
      const std::size_t entry = kind == linear ? n - d : n;
      if (kind == second) out[n] = in_ratio(out[n], scale(n / d) * scale(n % d), 1.0);
      if (kind == rate || kind == by_parameter || (kind == linear && n < d))
        out[n] = in_ratio(out[n], _scales.time, scale(n));
      if (kind == linear && n >= d) out[n] = in_ratio(out[n], _scales.time * scale(entry % d), scale(entry / d));
      if (kind == quantity) out[n] = in_ratio(out[n], 1.0, unit(number));
      if (kind == gradient) out[n] = in_ratio(out[n], scale(n), unit(number));
      if (kind == action) out[n] = in_ratio(out[n], 1.0, _scales.energy());
    }
    return out;
  }

  void make_formulas() {
    model::Graph& graph = _own.graph;
    const int d = dimension();
    _formulas.dimension = d;
    _formulas.field = _own.field;
    _formulas.parameters = _own.parameters;
    _formulas.conserved = _own.conserved;
    for (std::size_t k = 0; k < _own.conserved.size(); ++k) _formulas.conserved_gradients.push_back(gradient_nodes(k));
    _formulas.variations.resize(_own.field.size() * _own.field.size());
    for (int c = 0; c < d; ++c) {
      model::Direction direction;
      for (int i = 0; i < d; ++i) direction.inputs.push_back(graph.input(d + i * d + c));
      const std::vector<int> column = or_zero(model::derivatives_along(graph, _own.field, direction));
      for (int i = 0; i < d; ++i)
        _formulas.variations[static_cast<std::size_t>(i * d + c)] = column[static_cast<std::size_t>(i)];
    }
    formulas_in_scales();
    _formulas.graph = graph;
  }

  void formulas_in_scales() {
    if (_scales.are_one()) return;
    const auto d = static_cast<std::size_t>(dimension());
    model::Direction inputs;
    for (std::size_t n = 0; n < d * (1 + d); ++n)
      inputs.inputs.push_back(in_ratio(_own.graph.input(static_cast<int>(n)), scale(n < d ? n : (n - d) / d), 1.0));
    const auto tell = [&](std::vector<int>& nodes, const auto& told) {
      nodes = model::substituted(_own.graph, nodes, inputs);
      for (std::size_t n = 0; n < nodes.size(); ++n) nodes[n] = told(n, nodes[n]);
    };
    tell(_formulas.field, [&](std::size_t i, int node) { return in_ratio(node, _scales.time, scale(i)); });
    tell(_formulas.variations, [&](std::size_t n, int node) { return in_ratio(node, _scales.time, scale(n / d)); });
    tell(_formulas.conserved, [&](std::size_t k, int node) { return in_ratio(node, 1.0, unit(k)); });
    for (std::size_t k = 0; k < _formulas.conserved_gradients.size(); ++k)
      tell(_formulas.conserved_gradients[k],
           [&](std::size_t i, int node) { return in_ratio(node, scale(i), unit(k)); });
  }

  Equations _own;
  Scales _scales;
  std::array<std::vector<std::unique_ptr<const model::BlockProgram>>, kinds> _programs;
  Formulas _formulas;
};

GraphSystem::GraphSystem(Equations equations, Frame frame, std::vector<double> values,
                         std::map<std::string, double> sizes, FamilyScalars scalars)
    : _programs(std::make_shared<Programs>(std::move(equations), frame.scales)),
      _frame(std::make_shared<const Frame>(std::move(frame))),
      _values(std::move(values)),
      _sizes(std::move(sizes)),
      _scalars(std::move(scalars)) {
  name_parameters();
}

GraphSystem::GraphSystem(const std::shared_ptr<const GraphSystem>& whole, Equations equations,
                         const std::vector<double>& added, FamilyScalars scalars, const FrameOf& frame_of,
                         bool hangs_on_values)
    : GraphSystem(std::move(equations), frame_of(whole), whole->_values, whole->_sizes, std::move(scalars)) {
  _values.insert(_values.end(), added.begin(), added.end());
  name_parameters();
  if (!hangs_on_values && !whole->_frame_of) return;
  _whole = whole;
  _frame_of = frame_of;
}

GraphSystem::GraphSystem(const GraphSystem& other, std::shared_ptr<const GraphSystem> whole,
                         std::shared_ptr<const Frame> frame, std::vector<double> values)
    : _programs(other._programs),
      _frame(std::move(frame)),
      _whole(std::move(whole)),
      _frame_of(other._frame_of),
      _values(std::move(values)),
      _sizes(other._sizes),
      _scalars(other._scalars) {
  name_parameters();
}

void GraphSystem::name_parameters() {
  _parameters = _sizes;
  for (std::size_t n = 0; n < _values.size(); ++n) _parameters[equations().parameters[n]] = _values[n];
}

const Equations& GraphSystem::equations() const { return _programs->equations(); }

void GraphSystem::field(std::size_t nodes, const double* z, double* f) const {
  if (nodes == 1) return run_one(rate, 0, z, {{f, size()}});
  run(rate, 0, nodes, states(size(), nodes, z), results().add(f, size(), nodes));
}

void GraphSystem::field_jacobian(std::size_t nodes, const double* z, double* f, double* jacobian) const {
  if (nodes == 1) return run_one(linear, 0, z, {{f, size()}, {jacobian, size() * size()}});
  run(linear, 0, nodes, states(size(), nodes, z),
      results().add(f, size(), nodes).add(jacobian, size() * size(), nodes));
}

void GraphSystem::second_derivatives(std::size_t nodes, const double* z, const double* weights,
                                     double* contracted) const {
  run(second, 0, nodes, states(size(), nodes, z).add(weights, size(), nodes),
      results().add(contracted, size() * size(), nodes));
}

void GraphSystem::parameter_derivatives(const std::string& name, std::size_t nodes, const double* z,
                                        double* derivatives) const {
  const std::vector<std::string>& names = equations().parameters;
  const auto at = std::find(names.begin(), names.end(), name);
  core::require(at != names.end(), "a field is differentiated by a parameter that it has");
  run(by_parameter, static_cast<std::size_t>(at - names.begin()), nodes, states(size(), nodes, z),
      results().add(derivatives, size(), nodes));
  multiply(size() * nodes, derivatives, parameter_scale(name));
}

std::shared_ptr<const System> GraphSystem::with_parameters(const std::map<std::string, double>& values) const {
  const std::vector<std::string>& names = equations().parameters;
  std::vector<double> moved = _values;
  for (const auto& [name, value] : values) {
    if (const auto size = _sizes.find(name); size != _sizes.end() && size->second == value) continue;
    const auto at = std::find(names.begin(), names.end(), name);
    core::require(at != names.end(), "a system moves parameters that it has");
    moved[static_cast<std::size_t>(at - names.begin())] = value;
  }
  std::shared_ptr<const GraphSystem> whole;
  std::shared_ptr<const Frame> frame = _frame;
  if (_frame_of) {
    whole = graph_system(_whole->with_parameters(values));
    frame = std::make_shared<const Frame>(_frame_of(whole));
  }
  return std::shared_ptr<const System>(new GraphSystem(*this, std::move(whole), std::move(frame), std::move(moved)));
}

double GraphSystem::conserved(int k, std::span<const double> z) const {
  require_quantity(k);
  return one(quantity, k, z);
}

void GraphSystem::conserved_gradients(int k, std::size_t nodes, const double* z, double* gradients) const {
  require_quantity(k);
  if (nodes == 1) return run_one(gradient, static_cast<std::size_t>(k), z, {{gradients, size()}});
  run(gradient, static_cast<std::size_t>(k), nodes, states(size(), nodes, z), results().add(gradients, size(), nodes));
}

double GraphSystem::guard(int k, std::span<const double> z) const {
  if (k < 0 || k >= static_cast<int>(structure().guards.size())) return System::guard(k, z);
  return one(guarded, k, z);
}

double GraphSystem::action_density(std::span<const double> z) const {
  const bool is_known = equations().action >= 0 && _frame->has_action;
  return is_known ? one(action, 0, z) : std::numeric_limits<double>::quiet_NaN();
}

void GraphSystem::linearize(const numerics::QuadVector& z, numerics::QuadVector& f,
                            numerics::QuadMatrix& jacobian) const {
  linearize_formulas(_programs->formulas(_values), z, f, jacobian);
}

Formulas GraphSystem::formulas() const { return _programs->formulas(_values); }

void GraphSystem::require_quantity(int k) const {
  core::require(k >= 0 && k < static_cast<int>(structure().conserved.size()),
                "the structure names no such conserved quantity");
}

double GraphSystem::one(Kind kind, int number, std::span<const double> z) const {
  double value = 0.0;
  run_one(kind, static_cast<std::size_t>(number), z.data(), {{&value, 1}});
  return value;
}

void GraphSystem::run(Kind kind, std::size_t number, std::size_t nodes, std::span<const double* const> in,
                      std::span<double* const> out) const {
  _programs->program(kind, number).run(scalars_of(kind, number), nodes, in, out);
}

void GraphSystem::run_one(Kind kind, std::size_t number, const double* z,
                          std::initializer_list<std::span<double>> out) const {
  _programs->program(kind, number).run_one(scalars_of(kind, number), {z, size()}, out);
}

const std::vector<double>& GraphSystem::scalars_of(Kind kind, std::size_t number) const {
  std::vector<std::vector<double>>& own = _scalars_of[kind];
  if (own.size() <= number) own.resize(number + 1);
  if (own[number].empty()) own[number] = _programs->program(kind, number).scalars(_values);
  return own[number];
}

std::shared_ptr<const GraphSystem> graph_system(const std::shared_ptr<const System>& system) {
  auto found = std::dynamic_pointer_cast<const GraphSystem>(system);
  core::require(found != nullptr, "a system is transformed on its graph");
  return found;
}

}  // namespace orbweaver::systems
