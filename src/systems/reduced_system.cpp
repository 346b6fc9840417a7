#include "orbweaver/systems/reduced_system.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "linear_quantities.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/model/derivatives.hpp"
#include "orbweaver/model/evaluate.hpp"
#include "orbweaver/systems/formulas.hpp"
#include "linearized_formulas.hpp"
#include "orbweaver/systems/quad_system.hpp"
#include "reduced_formulas.hpp"
#include "reduced_structure.hpp"
#include "with_totals.hpp"

namespace orbweaver::systems {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Relative: a state's value of a quantity may be told in some digits.
constexpr double same_value = 1e-6;
/// What is gained by another frame is of order 1.
constexpr double less_skew = 1e-6;

double* space(std::size_t size, std::vector<double>& buffer) {
  if (buffer.size() < size) buffer.resize(size);
  return buffer.data();
}

void add(std::size_t nodes, double factor, const double* from, double* to) {
  for (std::size_t j = 0; j < nodes; ++j) to[j] += factor * from[j];
}

/// The coordinates of `terms` times their factors: a row of a matrix without its zeros.
struct Term {
  std::size_t at;
  double factor;
};
using Row = std::vector<Term>;

std::vector<Row> rows_without_zeros(const MatrixXd& matrix) {
  std::vector<Row> rows(static_cast<std::size_t>(matrix.rows()));
  for (Index i = 0; i < matrix.rows(); ++i)
    for (Index l = 0; l < matrix.cols(); ++l)
      if (matrix(i, l) != 0.0) rows[static_cast<std::size_t>(i)].push_back({static_cast<std::size_t>(l), matrix(i, l)});
  return rows;
}

class ReducedSystem final : public System, public QuadSystem, public FormulaSystem {
 public:
  ReducedSystem(std::shared_ptr<const System> whole, LinearQuantities linear,
                const std::optional<Straightening>& straightening)
      : _whole(std::move(whole)),
        _linear(std::move(linear)),
        _chart(chart_of(*_whole, _linear, straightening)),
        _structure(reduced_structure(*_whole, _linear, _chart)),
        _info(reduced_info(*_whole, _linear, _chart)),
        _outer(rows_without_zeros(_chart.states)),
        _inner(rows_without_zeros(_chart.rates)) {}

  [[nodiscard]] const ModelInfo& info() const override { return _info; }
  [[nodiscard]] const Structure& structure() const override { return _structure; }
  [[nodiscard]] const std::map<std::string, double>& parameters() const override { return _whole->parameters(); }
  [[nodiscard]] const FamilyScalars& family_scalars() const override { return _whole->family_scalars(); }
  [[nodiscard]] const System& whole() const { return *_whole; }
  [[nodiscard]] const LinearQuantities& linear() const { return _linear; }
  [[nodiscard]] const Chart& chart() const { return _chart; }

  void field(std::size_t nodes, const double* z, double* f) const override {
    thread_local std::vector<double> buffer;
    double* whole_field = space(whole_size() * nodes, buffer);
    _whole->field(nodes, whole_states(nodes, z), whole_field);
    to_rates(nodes, whole_field, f);
  }

  void field_jacobian(std::size_t nodes, const double* z, double* f, double* jacobian) const override {
    thread_local std::vector<double> field_buffer, jacobian_buffer, column_buffer;
    const std::size_t n = size(), d = whole_size();
    double* whole_field = space(d * nodes, field_buffer);
    double* whole_jacobian = space(d * d * nodes, jacobian_buffer);
    double* columns = space(d * n * nodes, column_buffer);  // d f_i / d y_c
    _whole->field_jacobian(nodes, whole_states(nodes, z), whole_field, whole_jacobian);
    to_rates(nodes, whole_field, f);
    std::fill_n(columns, d * n * nodes, 0.0);
    for (std::size_t i = 0; i < d; ++i)
      for (std::size_t l = 0; l < d; ++l)
        for (const Term& term : _outer[l])
          add(nodes, term.factor, whole_jacobian + (i * d + l) * nodes, columns + (i * n + term.at) * nodes);
    std::fill_n(jacobian, n * n * nodes, 0.0);
    for (std::size_t r = 0; r < n; ++r)
      for (const Term& term : _inner[r])
        for (std::size_t c = 0; c < n; ++c)
          add(nodes, term.factor, columns + (term.at * n + c) * nodes, jacobian + (r * n + c) * nodes);
  }

  void second_derivatives(std::size_t nodes, const double* z, const double* weights,
                          double* contracted) const override {
    thread_local std::vector<double> weight_buffer, whole_buffer, column_buffer;
    const std::size_t n = size(), d = whole_size();
    double* whole_weights = space(d * nodes, weight_buffer);
    double* whole_contracted = space(d * d * nodes, whole_buffer);
    double* columns = space(d * n * nodes, column_buffer);
    std::fill_n(whole_weights, d * nodes, 0.0);
    for (std::size_t r = 0; r < n; ++r)
      for (const Term& term : _inner[r]) add(nodes, term.factor, weights + r * nodes, whole_weights + term.at * nodes);
    _whole->second_derivatives(nodes, whole_states(nodes, z), whole_weights, whole_contracted);
    std::fill_n(columns, d * n * nodes, 0.0);
    for (std::size_t l = 0; l < d; ++l)
      for (std::size_t m = 0; m < d; ++m)
        for (const Term& term : _outer[m])
          add(nodes, term.factor, whole_contracted + (l * d + m) * nodes, columns + (l * n + term.at) * nodes);
    std::fill_n(contracted, n * n * nodes, 0.0);
    for (std::size_t l = 0; l < d; ++l)
      for (const Term& term : _outer[l])
        for (std::size_t c = 0; c < n; ++c)
          add(nodes, term.factor, columns + (l * n + c) * nodes, contracted + (term.at * n + c) * nodes);
  }

  // At a fixed y the redundant coordinates move too: by the held value, and by what the quantity itself has of the
  // parameter.
  void parameter_derivatives(const std::string& name, std::size_t nodes, const double* z,
                             double* derivatives) const override {
    const std::size_t d = whole_size();
    const std::vector<double> states(whole_states(nodes, z), whole_states(nodes, z) + d * nodes);
    std::vector<double> slopes(d * nodes);
    _whole->parameter_derivatives(name, nodes, states.data(), slopes.data());
    std::vector<double> field(d * nodes), jacobian(d * d * nodes);
    _whole->field_jacobian(nodes, states.data(), field.data(), jacobian.data());
    for (std::size_t j = 0; j < nodes; ++j) {
      const VectorXd moves = _chart.from_values * values_by(name, nodes, j, states);
      for (std::size_t e = 0; e < _linear.redundant.size(); ++e) {
        const auto l = static_cast<std::size_t>(_linear.redundant[e]);
        for (std::size_t i = 0; i < d; ++i)
          slopes[i * nodes + j] += jacobian[(i * d + l) * nodes + j] * moves(static_cast<Index>(e));
      }
    }
    to_rates(nodes, slopes.data(), derivatives);
  }

  [[nodiscard]] std::shared_ptr<const System> with_parameters(
      const std::map<std::string, double>& values) const override {
    return std::make_shared<const ReducedSystem>(_whole->with_parameters(values), _linear, _chart.straightening);
  }

  [[nodiscard]] double conserved(int k, std::span<const double> z) const override {
    return _whole->conserved(other(k), {whole_states(1, z.data()), whole_size()});
  }

  void conserved_gradient(int k, std::span<const double> z, std::span<double> gradient) const override {
    conserved_gradients(k, 1, z.data(), gradient.data());
  }

  void conserved_gradients(int k, std::size_t nodes, const double* z, double* gradients) const override {
    thread_local std::vector<double> buffer;
    double* whole_gradients = space(whole_size() * nodes, buffer);
    _whole->conserved_gradients(other(k), nodes, whole_states(nodes, z), whole_gradients);
    std::fill_n(gradients, size() * nodes, 0.0);
    for (std::size_t l = 0; l < whole_size(); ++l)
      for (const Term& term : _outer[l])
        add(nodes, term.factor, whole_gradients + l * nodes, gradients + term.at * nodes);
  }

  [[nodiscard]] double guard(int k, std::span<const double> z) const override {
    return _whole->guard(k, {whole_states(1, z.data()), whole_size()});
  }

  // In the frame that goes along the action is less by the values times what the frame moves, and which multiple of
  // the action's momenta a quantity is, is not known.
  [[nodiscard]] double action_density(std::span<const double> z) const override {
    if (!_chart.values.isZero(0.0)) return std::numeric_limits<double>::quiet_NaN();
    return _whole->action_density({whole_states(1, z.data()), whole_size()});
  }

  void linearize(const numerics::QuadVector& z, numerics::QuadVector& f,
                 numerics::QuadMatrix& jacobian) const override {
    if (!_formulas) _formulas = std::make_unique<const Formulas>(formulas());
    linearize_formulas(*_formulas, z, f, jacobian);
  }

  [[nodiscard]] Formulas formulas() const override {
    return reduced_formulas(*_whole, whole_formulas(), _linear, _chart);
  }

 private:
  [[nodiscard]] std::size_t size() const { return _chart.kept.size(); }
  [[nodiscard]] std::size_t whole_size() const { return static_cast<std::size_t>(_whole->dimension()); }
  [[nodiscard]] int other(int k) const {
    core::require(k >= 0 && k < static_cast<int>(_chart.others.size()),
                  "the structure names no such conserved quantity");
    return _chart.others[static_cast<std::size_t>(k)];
  }
  [[nodiscard]] const Formulas& whole_formulas() const {
    if (!_plain) _plain = std::make_unique<const Formulas>(dynamic_cast<const FormulaSystem&>(*_whole).formulas());
    return *_plain;
  }

  /// Valid until the next call.
  [[nodiscard]] const double* whole_states(std::size_t nodes, const double* z) const {
    thread_local std::vector<double> buffer;
    double* states = space(whole_size() * nodes, buffer);
    for (std::size_t l = 0; l < whole_size(); ++l) {
      std::fill_n(states + l * nodes, nodes, _chart.origin(static_cast<Index>(l)));
      for (const Term& term : _outer[l]) add(nodes, term.factor, z + term.at * nodes, states + l * nodes);
    }
    return states;
  }

  void to_rates(std::size_t nodes, const double* whole_rates, double* rates) const {
    std::fill_n(rates, size() * nodes, 0.0);
    for (std::size_t r = 0; r < size(); ++r)
      for (const Term& term : _inner[r]) add(nodes, term.factor, whole_rates + term.at * nodes, rates + r * nodes);
  }

  /// d (value - Q) / d parameter at node j of the whole system's states.
  [[nodiscard]] VectorXd values_by(const std::string& name, std::size_t nodes, std::size_t j,
                                   const std::vector<double>& states) const {
    const Formulas& plain = whole_formulas();
    Slopes& slopes = _slopes[name];
    if (slopes.outputs.empty()) {
      slopes.graph = plain.graph;
      model::Direction direction;
      for (const std::string& parameter : plain.parameters)
        direction.parameters.push_back(parameter == name ? slopes.graph.constant(1.0) : -1);
      for (const int q : _linear.quantities) slopes.outputs.push_back(plain.conserved[static_cast<std::size_t>(q)]);
      slopes.outputs = model::derivatives_along(slopes.graph, slopes.outputs, direction);
      for (int& slope : slopes.outputs)
        if (slope < 0) slope = slopes.graph.constant(0.0);
    }
    std::vector<double> inputs;
    for (std::size_t i = 0; i < whole_size(); ++i) inputs.push_back(states[i * nodes + j]);
    const std::vector<double> own =
        model::evaluate<double>(slopes.graph, slopes.outputs, inputs, std::span<const double>(plain.values));
    VectorXd values(static_cast<Index>(own.size()));
    for (std::size_t a = 0; a < own.size(); ++a) {
      const auto q = static_cast<std::size_t>(_linear.quantities[a]);
      values(static_cast<Index>(a)) = (_whole->structure().conserved[q] == name ? 1.0 : 0.0) - own[a];
    }
    return values;
  }

  /// d Q / d parameter of the quantities taken out.
  struct Slopes {
    model::Graph graph;
    std::vector<int> outputs;
  };

  std::shared_ptr<const System> _whole;
  LinearQuantities _linear;
  Chart _chart;
  Structure _structure;
  ModelInfo _info;
  std::vector<Row> _outer;  // of the whole state, by the reduced one
  std::vector<Row> _inner;  // of the reduced rates, by the whole ones
  // Recorded when they are first asked for.
  mutable std::unique_ptr<const Formulas> _plain;  // of the whole system
  mutable std::unique_ptr<const Formulas> _formulas;
  mutable std::map<std::string, Slopes> _slopes;
};

const ReducedSystem& as_reduced(const System& system) {
  const auto* found = dynamic_cast<const ReducedSystem*>(&system);
  core::require(found != nullptr, "a reduced system has a whole one");
  return *found;
}

/// Coordinates that follow from the others and the totals: those of the largest terms at `place`, since one that is
/// small beside others would be the difference of large ones. Elimination with complete pivoting.
std::vector<int> redundant_at(const std::vector<LinearTotal>& totals, const VectorXd& place) {
  const auto k = static_cast<Index>(totals.size());
  const double largest = place.cwiseAbs().maxCoeff();
  const VectorXd sizes = largest > 0.0
                             ? VectorXd(place.cwiseAbs().cwiseMax(std::numeric_limits<double>::epsilon() * largest))
                             : VectorXd(VectorXd::Ones(place.size()));
  MatrixXd terms(k, place.size());
  for (Index a = 0; a < k; ++a) {
    terms.row(a) = totals[static_cast<std::size_t>(a)].weights.cwiseProduct(sizes);
    terms.row(a) /= terms.row(a).cwiseAbs().maxCoeff();
  }
  std::vector<int> redundant;
  for (Index a = 0; a < k; ++a) {
    Index row = 0, column = 0;
    terms.bottomRows(k - a).cwiseAbs().maxCoeff(&row, &column);
    terms.row(a).swap(terms.row(a + row));
    for (Index b = a + 1; b < k; ++b) terms.row(b) -= terms(b, column) / terms(a, column) * terms.row(a);
    terms.bottomRows(k - a - 1).col(column).setZero();
    redundant.push_back(static_cast<int>(column));
  }
  return redundant;
}

}  // namespace

std::shared_ptr<const System> without_totals(std::shared_ptr<const System> system,
                                             const std::vector<LinearTotal>& totals, const HeldTotals& held) {
  const auto d = static_cast<std::size_t>(system->dimension());
  LinearQuantities linear;
  linear.place = held.place.size() == d ? held.place : std::vector<double>(d, 0.0);
  const VectorXd place = Eigen::Map<const VectorXd>(linear.place.data(), static_cast<Index>(d));
  std::map<std::string, double> values;
  auto next = static_cast<int>(system->structure().conserved.size());
  for (const LinearTotal& total : totals) {
    linear.quantities.push_back(total.quantity >= 0 ? total.quantity : next++);
    const auto given = held.values.find(total.name);
    values[total.name] = given != held.values.end() ? given->second
                         : total.quantity >= 0      ? system->conserved(total.quantity, linear.place)
                                                    : total.weights.dot(place);
  }
  linear.motions = MatrixXd::Zero(static_cast<Index>(d), 0);
  linear.redundant = redundant_at(totals, place);
  const std::shared_ptr<const System> whole = with_totals(std::move(system), totals, values, held.moving);
  std::optional<Straightening> straightening;
  const Chart plain = chart_of(*whole, linear, {});
  if (skewness(*whole, linear, plain) > 0.0) straightening = straightening_of(*whole, linear, plain);
  return std::make_shared<const ReducedSystem>(whole, std::move(linear), straightening);
}

std::shared_ptr<const System> reduced(std::shared_ptr<const System> system) {
  if (const std::vector<LinearTotal> totals = linear_totals(*system); !totals.empty()) {
    const FamilyScalars moving = system->family_scalars();
    return without_totals(std::move(system), totals, {.values = {}, .place = {}, .moving = moving});
  }
  if (system->structure().conserved.size() < 2) return system;
  const LinearSearch search = find_linear_quantities(*system);
  if (!search.obstacle.empty()) return system;
  LinearQuantities linear = search.found;
  const auto skew = [&](const LinearQuantities& choice) {
    return skewness(*system, choice, chart_of(*system, choice, {}));
  };
  // The frame in the middle of a free chain, say, keeps its mirror what it is.
  double least = skew(linear);
  const auto consider = [&](const LinearQuantities& choice) {
    const bool is_apart = std::none_of(choice.redundant.begin(), choice.redundant.end(), [&](int i) {
      return std::find(choice.frame.begin(), choice.frame.end(), i) != choice.frame.end();
    });
    if (least == 0 || !is_apart) return;
    const double found = skew(choice);
    if (found >= least - less_skew) return;
    linear = choice;
    least = found;
  };
  for (const LinearQuantities& frame : search.frames) consider(frame);
  for (const std::vector<int>& redundant : search.redundants) {
    LinearQuantities choice = linear;
    choice.redundant = redundant;
    consider(choice);
  }
  std::optional<Straightening> straightening;
  if (least > 0.0) straightening = straightening_of(*system, linear, chart_of(*system, linear, {}));
  return std::make_shared<const ReducedSystem>(std::move(system), std::move(linear), straightening);
}

std::string why_not_reduced(const System& system) {
  return system.structure().conserved.size() < 2 ? "" : find_linear_quantities(system).obstacle;
}

const System* whole_of(const System& system) {
  const auto* found = dynamic_cast<const ReducedSystem*>(&system);
  return found == nullptr ? nullptr : &found->whole();
}

std::vector<double> reduced_state(const System& system, std::span<const double> whole) {
  const ReducedSystem& to = as_reduced(system);
  const VectorXd z = Eigen::Map<const VectorXd>(whole.data(), static_cast<Index>(whole.size()));
  for (std::size_t a = 0; a < to.linear().quantities.size(); ++a) {
    const int quantity = to.linear().quantities[a];
    const std::string& name = to.whole().structure().conserved[static_cast<std::size_t>(quantity)];
    const double value = to.whole().conserved(quantity, whole);
    const double held = to.chart().values(static_cast<Index>(a));
    const double size = to.chart().gradients.col(static_cast<Index>(a)).cwiseAbs().dot(z.cwiseAbs());
    if (std::abs(value - held) <= same_value * std::max(size, std::abs(held))) continue;
    throw core::InputError(fmt::format(
        "expected a state with {} = {:g}, which is held, got one with {:.10g}; {}", name, held, value,
        to.parameters().contains(name)
            ? fmt::format("give the system the parameter `{}: {:.10g}`", name, value)
            : fmt::format("change the state, or give the model a parameter `{}`, which is then the value held", name)));
  }
  const VectorXd y = to.chart().rates * z;
  return {y.begin(), y.end()};
}

std::vector<double> whole_state(const System& system, std::span<const double> state) {
  const Chart& chart = as_reduced(system).chart();
  const VectorXd z =
      chart.states * Eigen::Map<const VectorXd>(state.data(), static_cast<Index>(state.size())) + chart.origin;
  return {z.begin(), z.end()};
}

}  // namespace orbweaver::systems
