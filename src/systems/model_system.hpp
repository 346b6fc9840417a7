#pragma once

#include <array>
#include <cstddef>

#include "complex_system.hpp"
#include "orbweaver/ad/derivatives.hpp"
#include "registered.hpp"

namespace orbweaver::systems {

/// Adapts a model to the System interface, with derivatives by AD. A model has
///   static constexpr int dimension;
///   static Description describe();
///   explicit Model(const std::map<std::string, double>& parameters);   // every parameter, checked
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
    State state;
    State value;
    for (std::size_t j = 0; j < nodes; ++j) {
      gather(nodes, j, z, state);
      _model.template field<double>(state.data(), value.data());
      scatter(nodes, j, value, f);
    }
  }

  void field_jacobian(std::size_t nodes, const double* z, double* f, double* jacobian) const override {
    State state;
    for (std::size_t j = 0; j < nodes; ++j) {
      gather(nodes, j, z, state);
      const auto result = ad::field_jacobian<Model::dimension>(_field, state.data());
      scatter(nodes, j, result.value, f);
      scatter(nodes, j, result.jacobian, jacobian);
    }
  }

  void second_derivatives(std::size_t nodes, const double* z, const double* weights,
                          double* contracted) const override {
    State state;
    State weight;
    for (std::size_t j = 0; j < nodes; ++j) {
      gather(nodes, j, z, state);
      gather(nodes, j, weights, weight);
      scatter(nodes, j, ad::second_derivatives<Model::dimension>(_field, state.data(), weight.data()), contracted);
    }
  }

  [[nodiscard]] double energy(std::span<const double> z) const override {
    return _model.template energy<double>(z.data());
  }

  void energy_gradient(std::span<const double> z, std::span<double> gradient) const override {
    const auto energy_of = [this]<class S>(const S* state) { return _model.template energy<S>(state); };
    const auto result = ad::value_gradient<Model::dimension>(energy_of, z.data());
    for (std::size_t i = 0; i < size; ++i) gradient[i] = result.gradient[i];
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
  using State = std::array<double, size>;

  struct Field {
    const Model& model;
    template <class S>
    void operator()(const S* z, S* f) const {
      model.field(z, f);
    }
  };

  static void gather(std::size_t nodes, std::size_t j, const double* nodal, State& state) {
    for (std::size_t i = 0; i < size; ++i) state[i] = nodal[i * nodes + j];
  }

  template <std::size_t Rows>
  static void scatter(std::size_t nodes, std::size_t j, const std::array<double, Rows>& values, double* nodal) {
    for (std::size_t i = 0; i < Rows; ++i) nodal[i * nodes + j] = values[i];
  }

  Model _model;
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
