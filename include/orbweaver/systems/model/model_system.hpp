#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <type_traits>
#include <typeinfo>
#include <utility>

#include <boost/core/demangle.hpp>

#include "orbweaver/ad/derivatives.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/model/recorded.hpp"
#include "orbweaver/systems/formulas.hpp"
#include "orbweaver/systems/model/checks.hpp"
#include "orbweaver/systems/model/complex_system.hpp"
#include "orbweaver/systems/model/linearized_formulas.hpp"
#include "orbweaver/systems/model/registered.hpp"
#include "orbweaver/systems/quad_system.hpp"

namespace orbweaver::systems {

/// Adapts a model to the System interface, with derivatives by AD, over nodes in SIMD lanes. A model has
///   static constexpr int dimension;
///   static constexpr int quantities;                          // functions that may be conserved
///   static ModelInfo info();
///   static Structure structure(const Bound& bound);           // what holds with these parameters and effects; names
///                                                             // each of the functions that is conserved
///   static std::vector<EffectRules> effects();                // composed into it (effects/composition.hpp), if any
///   `template <class P> class With;`                          // the model with parameters of type P
/// and With<P>, P being double or (to differentiate by a parameter, in quadruple precision, and in formulas) the scalar
/// S of the field, has
///   explicit With(const BoundTo<P>& bound);
///   `template <class S> void field(const S* z, S* f) const;`
///   `template <int K, class S> S conserved(const S* z) const;` // quantity K of the structure, K < quantities
///   `template <class S> S action_density(const S* z) const;`   // if it conserves an energy; NaN where there is none
/// and, if its structure may name guards,
///   double guard(int k, const double* z) const;
/// Constants are doubles; what none is exactly (1/3) is written as S(1.0) / 3.0, so that more digits than those of a
/// double can be had.
template <class Model>
class ModelSystem final : public ComplexSystem, public QuadSystem, public FormulaSystem {
 public:
  explicit ModelSystem(const Bound& bound) : _model(bound), _structure(Model::structure(bound)), _bound(bound) {
    check(_structure, Registered<Model>::info(), Model::dimension, Model::quantities);
    if constexpr (!requires(const Numeric& model, const double* z) { model.guard(0, z); })
      check_without_guards(_structure);
    if constexpr (!has_action_density) check_without_action_density(_structure);
  }

  /// Throws StructureError if the field keeps a function of the model that the structure does not name. Asked once for
  /// each system that is made by name, not for those whose parameters have moved.
  void require_names() const {
    if constexpr (Model::quantities > 0)
      check_unnamed(_structure, Model::quantities, [this](int k, const double* z, double* f, double* gradient) {
        field(1, z, f);
        with_function(k, [&]<int K>(std::integral_constant<int, K>) { gradients_of<K>(1, z, gradient); });
      });
  }

  [[nodiscard]] const ModelInfo& info() const override { return Registered<Model>::info(); }
  [[nodiscard]] const Structure& structure() const override { return _structure; }
  [[nodiscard]] const std::map<std::string, double>& parameters() const override { return _bound.parameters; }
  [[nodiscard]] const FamilyScalars& family_scalars() const override { return _bound.scalars; }

  void field(std::size_t nodes, const double* z, double* f) const override {
    for_each_group(nodes, [=, this](std::size_t j, std::size_t count) {
      State value;
      _model.template field<ad::Lanes>(load(nodes, j, count, z).data(), value.data());
      store(nodes, j, count, value, f);
    });
  }

  void field_jacobian(std::size_t nodes, const double* z, double* f, double* jacobian) const override {
    for_each_group(nodes, [=, this](std::size_t j, std::size_t count) {
      const auto result = ad::field_jacobian<Model::dimension>(_field, load(nodes, j, count, z).data());
      store(nodes, j, count, result.value, f);
      store(nodes, j, count, result.jacobian, jacobian);
    });
  }

  void second_derivatives(std::size_t nodes, const double* z, const double* weights,
                          double* contracted) const override {
    for_each_group(nodes, [=, this](std::size_t j, std::size_t count) {
      const State state = load(nodes, j, count, z);
      const State weight = load(nodes, j, count, weights);
      store(nodes, j, count, ad::second_derivatives<Model::dimension>(_field, state.data(), weight.data()), contracted);
    });
  }

  void linearize(const numerics::QuadVector& z, numerics::QuadVector& f,
                 numerics::QuadMatrix& jacobian) const override {
    if (!_formulas) _formulas = std::make_unique<const Formulas>(formulas());
    linearize_formulas(*_formulas, z, f, jacobian);
  }

  [[nodiscard]] Formulas formulas() const override {
    using S = model::Recorded;
    using First = ad::First<Model::dimension, S>;
    model::Recording recording;
    Formulas formulas;
    formulas.dimension = Model::dimension;
    BoundTo<First> bound{{}, _bound.effects, {}};
    for (const auto& [name, value] : _bound.parameters) {
      First parameter(0.0);
      parameter.value = recording.parameter(static_cast<int>(formulas.parameters.size()));
      bound.parameters.emplace(name, parameter);
      formulas.parameters.push_back(name);
      formulas.values.push_back(value);
    }
    std::array<S, size> z;
    for (std::size_t i = 0; i < size; ++i) z[i] = recording.input(static_cast<int>(i));
    const typename Model::template With<First> model(bound);
    const auto whole = [&model](const First* state, First* value) { model.field(state, value); };
    const auto linear = ad::field_jacobian<Model::dimension>(whole, z.data());
    for (std::size_t i = 0; i < size; ++i) formulas.field.push_back(linear.value[i].node());
    for (std::size_t i = 0; i < size; ++i)
      for (std::size_t c = 0; c < size; ++c) {
        S sum(0.0);
        for (std::size_t l = 0; l < size; ++l)
          sum += linear.jacobian[i * size + l] * recording.input(static_cast<int>(size + l * size + c));
        formulas.variations.push_back(sum.node());
      }
    for (int k = 0; k < static_cast<int>(_structure.conserved.size()); ++k)
      with_quantity(k, [&]<int K>(std::integral_constant<int, K>) {
        const auto quantity = [&model](const First* state) { return model.template conserved<K, First>(state); };
        const auto result = ad::value_gradient<Model::dimension>(quantity, z.data());
        formulas.conserved.push_back(result.value.node());
        std::vector<int>& gradient = formulas.conserved_gradients.emplace_back();
        for (const S& derivative : result.gradient) gradient.push_back(derivative.node());
      });
    formulas.graph = recording.graph();
    return formulas;
  }

  void parameter_derivatives(const std::string& name, std::size_t nodes, const double* z,
                             double* derivatives) const override {
    using S = ad::First<1, ad::Lanes>;
    core::require(_bound.parameters.contains(name), "a field is differentiated by a parameter that it has");
    BoundTo<S> bound{{}, _bound.effects, {}};
    for (const auto& [other, value] : _bound.parameters)
      bound.parameters.emplace(other, other == name ? S::variable(ad::Lanes(value), 0) : S(value));
    const typename Model::template With<S> model(bound);
    for_each_group(nodes, [=, &model](std::size_t j, std::size_t count) {
      const State state = load(nodes, j, count, z);
      std::array<S, size> at;
      std::array<S, size> f;
      for (std::size_t i = 0; i < size; ++i) {
        at[i] = S(0.0);
        at[i].value = state[i];
      }
      model.field(at.data(), f.data());
      State out;
      for (std::size_t i = 0; i < size; ++i) out[i] = f[i].derivatives[0];
      store(nodes, j, count, out, derivatives);
    });
  }

  [[nodiscard]] std::shared_ptr<const System> with_parameters(
      const std::map<std::string, double>& values) const override {
    Bound bound = _bound;
    for (const auto& [name, value] : values) {
      core::require(bound.parameters.contains(name), "a system moves parameters that it has");
      bound.parameters[name] = value;
    }
    return std::make_shared<const ModelSystem>(bound);
  }

  void conserved_gradients(int k, std::size_t nodes, const double* z, double* gradients) const override {
    with_quantity(k, [&]<int K>(std::integral_constant<int, K>) { gradients_of<K>(nodes, z, gradients); });
  }

  [[nodiscard]] double conserved(int k, std::span<const double> z) const override {
    double value = 0.0;
    with_quantity(k, [&]<int K>(std::integral_constant<int, K>) { value = _model.template conserved<K>(z.data()); });
    return value;
  }

  void conserved_gradient(int k, std::span<const double> z, std::span<double> gradient) const override {
    conserved_gradients(k, 1, z.data(), gradient.data());
  }

  [[nodiscard]] double guard(int k, std::span<const double> z) const override {
    if constexpr (requires { _model.guard(k, z.data()); }) {
      core::require(k >= 0 && k < static_cast<int>(_structure.guards.size()), "the structure names no such guard");
      return _model.guard(k, z.data());
    } else {
      return System::guard(k, z);
    }
  }

  [[nodiscard]] double action_density(std::span<const double> z) const override {
    if constexpr (has_action_density)
      return _model.template action_density<double>(z.data());
    else
      return std::numeric_limits<double>::quiet_NaN();
  }

  void complex_field(const std::complex<double>* z, std::complex<double>* f) const override { _model.field(z, f); }

  [[nodiscard]] std::complex<double> complex_conserved(int k, const std::complex<double>* z) const override {
    std::complex<double> value;
    with_quantity(k, [&]<int K>(std::integral_constant<int, K>) { value = _model.template conserved<K>(z); });
    return value;
  }

 private:
  static constexpr auto size = static_cast<std::size_t>(Model::dimension);
  using State = std::array<ad::Lanes, size>;

  using Numeric = typename Model::template With<double>;
  static constexpr bool has_action_density = requires(const Numeric& model, const double* z) {
    model.template action_density<double>(z);
  };

  struct Field {
    const Numeric& model;
    template <class S>
    void operator()(const S* z, S* f) const {
      model.field(z, f);
    }
  };

  /// Calls `evaluate` with k as a constant.
  template <class Evaluate>
  void with_quantity(int k, const Evaluate& evaluate) const {
    core::require(k >= 0 && k < static_cast<int>(_structure.conserved.size()),
                  "the structure names no such conserved quantity");
    with_function(k, evaluate);
  }

  template <class Evaluate>
  static void with_function(int k, const Evaluate& evaluate) {
    [&]<int... K>(std::integer_sequence<int, K...>) {
      static_cast<void>(((k == K && (evaluate(std::integral_constant<int, K>{}), true)) || ...));
    }
    (std::make_integer_sequence<int, Model::quantities>{});
  }

  template <int K>
  void gradients_of(std::size_t nodes, const double* z, double* gradients) const {
    const auto quantity = [this]<class S>(const S* state) { return _model.template conserved<K, S>(state); };
    for_each_group(nodes, [=](std::size_t j, std::size_t count) {
      const auto result = ad::value_gradient<Model::dimension>(quantity, load(nodes, j, count, z).data());
      store(nodes, j, count, result.gradient, gradients);
    });
  }

  // One body serves full groups and the last one, so that a node's bits do not depend on where it stands.
  template <class Evaluate>
  [[gnu::flatten, gnu::noinline]] static void for_each_group(std::size_t nodes, const Evaluate& evaluate) {
    for (std::size_t j = 0; j < nodes; j += ad::Lanes::width) evaluate(j, std::min(ad::Lanes::width, nodes - j));
  }

  static State load(std::size_t nodes, std::size_t j, std::size_t count, const double* nodal) {
    State state;
    if (count == ad::Lanes::width) [[likely]]
      for (std::size_t i = 0; i < size; ++i) state[i] = ad::Lanes::load(nodal + i * nodes + j);
    else
      for (std::size_t i = 0; i < size; ++i) state[i] = ad::Lanes::load(nodal + i * nodes + j, count);
    return state;
  }

  template <std::size_t Rows>
  static void store(std::size_t nodes, std::size_t j, std::size_t count, const std::array<ad::Lanes, Rows>& values,
                    double* nodal) {
    if (count == ad::Lanes::width) [[likely]]
      for (std::size_t i = 0; i < Rows; ++i) values[i].store(nodal + i * nodes + j);
    else
      for (std::size_t i = 0; i < Rows; ++i) values[i].store(nodal + i * nodes + j, count);
  }

  Numeric _model;
  Field _field{_model};
  Structure _structure;
  Bound _bound;
  mutable std::unique_ptr<const Formulas> _formulas;  // recorded when they are first asked for
};

template <class Model>
const ModelInfo& Registered<Model>::info() {
  static const ModelInfo info = Model::info();
  return info;
}

template <class Model>
const std::vector<std::string>& Registered<Model>::effects() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> found;
    if constexpr (requires { Model::effects(); })
      for (const auto& effect : Model::effects()) found.push_back(effect.info().name);
    return found;
  }();
  return names;
}

template <class Model>
std::shared_ptr<const System> Registered<Model>::make(const Bound& bound) {
  const auto system = std::make_shared<const ModelSystem<Model>>(bound);
  system->require_names();
  return system;
}

template <class Model>
inline std::string Registered<Model>::type() {
  return boost::core::demangle(typeid(Model).name());
}

}  // namespace orbweaver::systems
