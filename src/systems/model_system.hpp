#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <map>
#include <memory>
#include <string>

#include "complex_system.hpp"
#include "orbweaver/ad/derivatives.hpp"
#include "orbweaver/core/error.hpp"
#include "registered.hpp"

namespace orbweaver::systems {

/// Adapts a model to the System interface, with derivatives by AD, over nodes in SIMD lanes. A model has
///   static constexpr int dimension;
///   static Description describe();
///   template <class P> class With;   // the model with parameters of type P
/// and With<P>, P being double or (to differentiate by a parameter) the scalar S of the field, has
///   explicit With(const std::map<std::string, P>& parameters);   // every parameter, checked
///   template <class S> void field(const S* z, S* f) const;
///   template <class S> S energy(const S* z) const;           // NaN where there is none
///   template <class S> S action_density(const S* z) const;   // NaN where there is none
template <class Model>
class ModelSystem final : public ComplexSystem {
 public:
  explicit ModelSystem(const std::map<std::string, double>& parameters) : _model(parameters), _parameters(parameters) {}

  [[nodiscard]] const Description& description() const override { return Registered<Model>::describe(); }
  [[nodiscard]] const std::map<std::string, double>& parameters() const override { return _parameters; }

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

  void parameter_derivatives(const std::string& name, std::size_t nodes, const double* z,
                             double* derivatives) const override {
    using S = ad::First<1, ad::Lanes>;
    core::require(_parameters.contains(name), "a field is differentiated by a parameter that it has");
    std::map<std::string, S> parameters;
    for (const auto& [other, value] : _parameters)
      parameters.emplace(other, other == name ? S::variable(ad::Lanes(value), 0) : S(value));
    const typename Model::template With<S> model(parameters);
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
    std::map<std::string, double> parameters = _parameters;
    for (const auto& [name, value] : values) {
      core::require(parameters.contains(name), "a system moves parameters that it has");
      parameters[name] = value;
    }
    return std::make_shared<const ModelSystem>(parameters);
  }

  void energy_gradients(std::size_t nodes, const double* z, double* gradients) const override {
    const auto energy_of = [this]<class S>(const S* state) { return _model.template energy<S>(state); };
    for_each_group(nodes, [=](std::size_t j, std::size_t count) {
      const auto result = ad::value_gradient<Model::dimension>(energy_of, load(nodes, j, count, z).data());
      store(nodes, j, count, result.gradient, gradients);
    });
  }

  [[nodiscard]] double energy(std::span<const double> z) const override {
    return _model.template energy<double>(z.data());
  }

  void energy_gradient(std::span<const double> z, std::span<double> gradient) const override {
    energy_gradients(1, z.data(), gradient.data());
  }

  [[nodiscard]] double action_density(std::span<const double> z) const override {
    return _model.template action_density<double>(z.data());
  }

  void complex_field(const std::complex<double>* z, std::complex<double>* f) const override { _model.field(z, f); }

  [[nodiscard]] std::complex<double> complex_energy(const std::complex<double>* z) const override {
    return _model.energy(z);
  }

 private:
  static constexpr auto size = static_cast<std::size_t>(Model::dimension);
  using State = std::array<ad::Lanes, size>;

  using Bound = typename Model::template With<double>;

  struct Field {
    const Bound& model;
    template <class S>
    void operator()(const S* z, S* f) const {
      model.field(z, f);
    }
  };

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

  Bound _model;
  Field _field{_model};
  std::map<std::string, double> _parameters;
};

template <class Model>
const Description& Registered<Model>::describe() {
  static const Description description = Model::describe();
  return description;
}

template <class Model>
std::shared_ptr<const System> Registered<Model>::make(const std::map<std::string, double>& parameters) {
  return std::make_shared<const ModelSystem<Model>>(parameters);
}

}  // namespace orbweaver::systems
