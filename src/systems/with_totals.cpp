#include "with_totals.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "orbweaver/core/error.hpp"
#include "orbweaver/model/evaluate.hpp"
#include "orbweaver/model/recorded.hpp"
#include "orbweaver/systems/formulas.hpp"
#include "orbweaver/systems/quad_system.hpp"

namespace orbweaver::systems {

namespace {

class WithTotals final : public System, public QuadSystem, public FormulaSystem {
 public:
  WithTotals(std::shared_ptr<const System> system, const std::vector<LinearTotal>& totals,
             std::map<std::string, double> values, FamilyScalars moving)
      : _system(std::move(system)),
        _totals(totals),
        _values(std::move(values)),
        _moving(std::move(moving)),
        _info(_system->info()),
        _structure(_system->structure()),
        _parameters(_system->parameters()) {
    constexpr double any = std::numeric_limits<double>::infinity();
    std::vector<std::string> told;
    for (const LinearTotal& total : _totals) {
      const std::string sum = sum_text(_info.state_names, total.weights);
      if (total.quantity < 0) {
        _named.push_back(total.weights);
        _structure.conserved.push_back(total.name);
        told.push_back(fmt::format("{} = {}", total.name, sum));
      }
      if (_parameters.contains(total.name)) continue;
      const double value = _values.at(total.name);
      _added.push_back(total.name);
      _parameters[total.name] = value;
      _info.parameters.push_back({total.name, value, -any, any, false, "1", "the total " + sum + ", which is kept"});
    }
    if (!told.empty()) _info.meaning += fmt::format("; found to be kept: {}", fmt::join(told, ", "));
  }

  [[nodiscard]] const ModelInfo& info() const override { return _info; }
  [[nodiscard]] const Structure& structure() const override { return _structure; }
  [[nodiscard]] const std::map<std::string, double>& parameters() const override { return _parameters; }
  [[nodiscard]] const FamilyScalars& family_scalars() const override { return _moving; }

  void field(std::size_t nodes, const double* z, double* f) const override { _system->field(nodes, z, f); }
  void field_jacobian(std::size_t nodes, const double* z, double* f, double* jacobian) const override {
    _system->field_jacobian(nodes, z, f, jacobian);
  }
  void second_derivatives(std::size_t nodes, const double* z, const double* weights,
                          double* contracted) const override {
    _system->second_derivatives(nodes, z, weights, contracted);
  }
  void parameter_derivatives(const std::string& name, std::size_t nodes, const double* z,
                             double* derivatives) const override {
    if (is_added(name))
      std::fill_n(derivatives, static_cast<std::size_t>(dimension()) * nodes, 0.0);
    else
      _system->parameter_derivatives(name, nodes, z, derivatives);
  }
  [[nodiscard]] std::shared_ptr<const System> with_parameters(
      const std::map<std::string, double>& values) const override {
    std::map<std::string, double> own = _values;
    std::map<std::string, double> others;
    for (const auto& [name, value] : values) (is_added(name) ? own : others)[name] = value;
    return std::make_shared<const WithTotals>(others.empty() ? _system : _system->with_parameters(others), _totals,
                                              std::move(own), _moving);
  }

  [[nodiscard]] double conserved(int k, std::span<const double> z) const override {
    const int declared = names();
    if (k < declared) return _system->conserved(k, z);
    return weights(k).dot(Eigen::Map<const Eigen::VectorXd>(z.data(), dimension()));
  }
  void conserved_gradient(int k, std::span<const double> z, std::span<double> gradient) const override {
    conserved_gradients(k, 1, z.data(), gradient.data());
  }
  void conserved_gradients(int k, std::size_t nodes, const double* z, double* gradients) const override {
    if (k < names()) return _system->conserved_gradients(k, nodes, z, gradients);
    for (int i = 0; i < dimension(); ++i)
      std::fill_n(gradients + static_cast<std::size_t>(i) * nodes, nodes, weights(k)(i));
  }
  [[nodiscard]] double guard(int k, std::span<const double> z) const override { return _system->guard(k, z); }
  [[nodiscard]] double action_density(std::span<const double> z) const override { return _system->action_density(z); }

  void linearize(const numerics::QuadVector& z, numerics::QuadVector& f,
                 numerics::QuadMatrix& jacobian) const override {
    dynamic_cast<const QuadSystem&>(*_system).linearize(z, f, jacobian);
  }

  [[nodiscard]] Formulas formulas() const override {
    using model::Recorded;
    Formulas formulas = dynamic_cast<const FormulaSystem&>(*_system).formulas();
    const model::Graph plain = formulas.graph;
    const auto d = static_cast<std::size_t>(dimension());
    model::Recording recording;
    std::vector<Recorded> inputs, parameters;
    for (std::size_t n = 0; n < d * (1 + d); ++n) inputs.push_back(recording.input(static_cast<int>(n)));
    for (std::size_t n = 0; n < formulas.parameters.size(); ++n)
      parameters.push_back(recording.parameter(static_cast<int>(n)));
    const auto copy = [&](std::vector<int>& nodes) {
      const std::vector<Recorded> values = model::evaluate<Recorded>(plain, nodes, inputs, parameters);
      for (std::size_t n = 0; n < values.size(); ++n) nodes[n] = values[n].node();
    };
    copy(formulas.field);
    copy(formulas.variations);
    copy(formulas.conserved);
    for (std::vector<int>& gradient : formulas.conserved_gradients) copy(gradient);
    for (const Eigen::VectorXd& weights : _named) {
      Recorded sum(0.0);
      std::vector<int>& gradient = formulas.conserved_gradients.emplace_back();
      for (std::size_t i = 0; i < d; ++i) {
        const double weight = weights(static_cast<Eigen::Index>(i));
        sum += inputs[i] * weight;
        gradient.push_back(Recorded(weight).node());
      }
      formulas.conserved.push_back(sum.node());
    }
    for (const std::string& name : _added) {
      formulas.parameters.push_back(name);
      formulas.values.push_back(_values.at(name));
    }
    formulas.graph = recording.graph();
    return formulas;
  }

 private:
  [[nodiscard]] bool is_added(const std::string& name) const {
    return std::find(_added.begin(), _added.end(), name) != _added.end();
  }
  [[nodiscard]] int names() const { return static_cast<int>(_system->structure().conserved.size()); }
  [[nodiscard]] const Eigen::VectorXd& weights(int k) const {
    core::require(k >= names() && k < static_cast<int>(_structure.conserved.size()),
                  "the structure names no such conserved quantity");
    return _named[static_cast<std::size_t>(k - names())];
  }

  std::shared_ptr<const System> _system;
  std::vector<LinearTotal> _totals;
  std::map<std::string, double> _values;
  FamilyScalars _moving;
  ModelInfo _info;
  Structure _structure;
  std::map<std::string, double> _parameters;
  std::vector<Eigen::VectorXd> _named;  // of the totals that the system does not name
  std::vector<std::string> _added;      // parameters that the system does not have
};

}  // namespace

std::shared_ptr<const System> with_totals(std::shared_ptr<const System> system, const std::vector<LinearTotal>& totals,
                                          const std::map<std::string, double>& values, const FamilyScalars& moving) {
  return std::make_shared<const WithTotals>(std::move(system), totals, values, moving);
}

}  // namespace orbweaver::systems
