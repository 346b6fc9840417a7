#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "orbweaver/ad/derivatives.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/model/recorded.hpp"
#include "orbweaver/systems/formulas.hpp"
#include "orbweaver/systems/model/checks.hpp"
#include "orbweaver/systems/model/complex_system.hpp"
#include "orbweaver/systems/model/linearized_formulas.hpp"
#include "orbweaver/systems/quad_system.hpp"

namespace orbweaver::systems {

/// Adapts a model whose dimension a parameter decides to the System interface. As ModelSystem for fixed dimensions, but
/// derivatives come a few columns at a time, so that one instantiation serves every dimension. A model has
///   static constexpr const char* count;                       // the parameter that decides, a whole number
///   static int count_of(const Bound& bound);                  // its value; throws core::InputError
///   static ModelInfo info(int count);
///   static Structure structure(int count);
///   template <class P> class With;
/// and With<P> has
///   With(const BoundTo<P>& bound, int count);
///   template <class S> void field(const S* z, S* f) const;
///   template <class S> S conserved(int k, const S* z) const;
///   template <class S> S action_density(const S* z) const;
template <class Model>
class SizedSystem final : public ComplexSystem, public QuadSystem, public FormulaSystem {
 public:
  /// Throws core::InputError where the count is none, or is to move along families.
  explicit SizedSystem(const Bound& bound)
      : _count(Model::count_of(bound)),
        _info(Model::info(_count)),
        _structure(Model::structure(_count)),
        _bound(bound),
        _model(bound, _count) {
    check(_structure, _info, _structure.dimension, static_cast<int>(_structure.conserved.size()));
    const std::vector<std::string>& moving = bound.scalars.free;
    if (std::count(moving.begin(), moving.end(), Model::count) > 0)
      throw core::InputError("parameter '" + std::string(Model::count) + "' of system '" + _info.name +
                             "' is a whole number, so that nothing can be continued in it; choose another parameter");
  }

  [[nodiscard]] const ModelInfo& info() const override { return _info; }
  [[nodiscard]] const Structure& structure() const override { return _structure; }
  [[nodiscard]] const std::map<std::string, double>& parameters() const override { return _bound.parameters; }
  [[nodiscard]] const FamilyScalars& family_scalars() const override { return _bound.scalars; }

  void field(std::size_t nodes, const double* z, double* f) const override {
    std::vector<ad::Lanes> state(size());
    std::vector<ad::Lanes> value(size());
    for_each_group(nodes, [&](std::size_t j, std::size_t count) {
      load(nodes, j, count, z, state);
      _model.field(state.data(), value.data());
      for (std::size_t i = 0; i < size(); ++i) store(value[i], count, f + i * nodes + j);
    });
  }

  void field_jacobian(std::size_t nodes, const double* z, double* f, double* jacobian) const override {
    using S = ad::First<columns, ad::Lanes>;
    std::vector<ad::Lanes> state(size());
    std::vector<S> value(size());
    for_each_group(nodes, [&](std::size_t j, std::size_t count) {
      load(nodes, j, count, z, state);
      for (std::size_t from = 0; from < size(); from += columns) {
        _model.field(variables(state, from).data(), value.data());
        for (std::size_t i = 0; i < size(); ++i) {
          if (from == 0) store(value[i].value, count, f + i * nodes + j);
          for (std::size_t c = 0; c < columns && from + c < size(); ++c)
            store(value[i].derivatives[c], count, jacobian + (i * size() + from + c) * nodes + j);
        }
      }
    });
  }

  void second_derivatives(std::size_t nodes, const double* z, const double* weights,
                          double* contracted) const override {
    using S = ad::First<1, ad::First<columns, ad::Lanes>>;
    std::vector<ad::Lanes> state(size());
    std::vector<ad::Lanes> weight(size());
    std::vector<S> at(size());
    std::vector<S> value(size());
    for_each_group(nodes, [&](std::size_t j, std::size_t count) {
      load(nodes, j, count, z, state);
      load(nodes, j, count, weights, weight);
      for (std::size_t from = 0; from < size(); from += columns) {
        const auto inner = variables(state, from);
        for (std::size_t m = from; m < size(); ++m) {
          for (std::size_t i = 0; i < size(); ++i) {
            at[i] = S(0.0);
            at[i].value = inner[i];
            if (i == m) at[i].derivatives[0] = 1.0;
          }
          _model.field(at.data(), value.data());
          for (std::size_t c = 0; c < columns && from + c <= m; ++c) {
            const std::size_t l = from + c;
            ad::Lanes sum(0.0);
            for (std::size_t i = 0; i < size(); ++i) sum += weight[i] * value[i].derivatives[0].derivatives[c];
            store(sum, count, contracted + (l * size() + m) * nodes + j);
            store(sum, count, contracted + (m * size() + l) * nodes + j);
          }
        }
      }
    });
  }

  void linearize(const numerics::QuadVector& z, numerics::QuadVector& f,
                 numerics::QuadMatrix& jacobian) const override {
    if (!_formulas) _formulas = std::make_unique<const Formulas>(formulas());
    linearize_formulas(*_formulas, z, f, jacobian);
  }

  [[nodiscard]] Formulas formulas() const override {
    using S = ad::First<1, model::Recorded>;
    model::Recording recording;
    Formulas formulas;
    formulas.dimension = dimension();
    BoundTo<S> bound{{}, _bound.effects, {}};
    for (const auto& [name, value] : _bound.parameters) {
      S parameter(0.0);
      parameter.value = recording.parameter(static_cast<int>(formulas.parameters.size()));
      bound.parameters.emplace(name, parameter);
      formulas.parameters.push_back(name);
      formulas.values.push_back(value);
    }
    const typename Model::template With<S> model(bound, _count);
    std::vector<S> z(size());
    std::vector<S> f(size());
    for (std::size_t i = 0; i < size(); ++i) {
      z[i] = S(0.0);
      z[i].value = recording.input(static_cast<int>(i));
    }
    formulas.field.resize(size());
    formulas.variations.resize(size() * size());
    for (std::size_t c = 0; c < size(); ++c) {
      for (std::size_t i = 0; i < size(); ++i)
        z[i].derivatives[0] = recording.input(static_cast<int>(size() + i * size() + c));
      model.field(z.data(), f.data());
      for (std::size_t i = 0; i < size(); ++i) {
        formulas.field[i] = f[i].value.node();
        formulas.variations[i * size() + c] = f[i].derivatives[0].node();
      }
    }
    for (std::size_t k = 0; k < _structure.conserved.size(); ++k) {
      std::vector<int>& gradient = formulas.conserved_gradients.emplace_back();
      formulas.conserved.push_back(-1);
      for (std::size_t l = 0; l < size(); ++l) {
        for (std::size_t i = 0; i < size(); ++i) z[i].derivatives[0] = i == l ? 1.0 : 0.0;
        const S quantity = model.conserved(static_cast<int>(k), z.data());
        formulas.conserved.back() = quantity.value.node();
        gradient.push_back(quantity.derivatives[0].node());
      }
    }
    formulas.graph = recording.graph();
    return formulas;
  }

  void parameter_derivatives(const std::string& name, std::size_t nodes, const double* z,
                             double* derivatives) const override {
    using S = ad::First<1, ad::Lanes>;
    core::require(_bound.parameters.contains(name) && name != Model::count,
                  "a field is differentiated by a parameter that it has and that is no whole number");
    BoundTo<S> bound{{}, _bound.effects, {}};
    for (const auto& [other, value] : _bound.parameters)
      bound.parameters.emplace(other, other == name ? S::variable(ad::Lanes(value), 0) : S(value));
    const typename Model::template With<S> model(bound, _count);
    std::vector<ad::Lanes> state(size());
    std::vector<S> at(size());
    std::vector<S> f(size());
    for_each_group(nodes, [&](std::size_t j, std::size_t count) {
      load(nodes, j, count, z, state);
      for (std::size_t i = 0; i < size(); ++i) {
        at[i] = S(0.0);
        at[i].value = state[i];
      }
      model.field(at.data(), f.data());
      for (std::size_t i = 0; i < size(); ++i) store(f[i].derivatives[0], count, derivatives + i * nodes + j);
    });
  }

  [[nodiscard]] std::shared_ptr<const System> with_parameters(
      const std::map<std::string, double>& values) const override {
    Bound bound = _bound;
    for (const auto& [name, value] : values) {
      core::require(bound.parameters.contains(name), "a system moves parameters that it has");
      core::require(name != Model::count || value == bound[name], "a system keeps its dimension");
      bound.parameters[name] = value;
    }
    return std::make_shared<const SizedSystem>(bound);
  }

  [[nodiscard]] double conserved(int k, std::span<const double> z) const override {
    require_quantity(k);
    return _model.conserved(k, z.data());
  }
  void conserved_gradient(int k, std::span<const double> z, std::span<double> gradient) const override {
    conserved_gradients(k, 1, z.data(), gradient.data());
  }
  void conserved_gradients(int k, std::size_t nodes, const double* z, double* gradients) const override {
    require_quantity(k);
    std::vector<ad::Lanes> state(size());
    for_each_group(nodes, [&](std::size_t j, std::size_t count) {
      load(nodes, j, count, z, state);
      for (std::size_t from = 0; from < size(); from += columns) {
        const auto value = _model.conserved(k, variables(state, from).data());
        for (std::size_t c = 0; c < columns && from + c < size(); ++c)
          store(value.derivatives[c], count, gradients + (from + c) * nodes + j);
      }
    });
  }

  [[nodiscard]] double action_density(std::span<const double> z) const override {
    return _model.action_density(z.data());
  }
  void complex_field(const std::complex<double>* z, std::complex<double>* f) const override { _model.field(z, f); }
  [[nodiscard]] std::complex<double> complex_conserved(int k, const std::complex<double>* z) const override {
    require_quantity(k);
    return _model.conserved(k, z);
  }

 private:
  /// Of a matrix of derivatives, at a time: more would not stay in registers.
  static constexpr std::size_t columns = 4;

  [[nodiscard]] std::size_t size() const { return static_cast<std::size_t>(_structure.dimension); }

  void require_quantity(int k) const {
    core::require(k >= 0 && k < static_cast<int>(_structure.conserved.size()),
                  "the structure names no such conserved quantity");
  }

  /// The coordinates `from` and those after it are the variables.
  static std::vector<ad::First<columns, ad::Lanes>> variables(const std::vector<ad::Lanes>& state, std::size_t from) {
    using S = ad::First<columns, ad::Lanes>;
    std::vector<S> at(state.size());
    for (std::size_t i = 0; i < state.size(); ++i) {
      at[i] = S(0.0);
      at[i].value = state[i];
      if (i >= from && i < from + columns) at[i].derivatives[i - from] = 1.0;
    }
    return at;
  }

  // One body serves full groups and the last one, so that a node's bits do not depend on where it stands.
  template <class Evaluate>
  [[gnu::noinline]] static void for_each_group(std::size_t nodes, const Evaluate& evaluate) {
    for (std::size_t j = 0; j < nodes; j += ad::Lanes::width) evaluate(j, std::min(ad::Lanes::width, nodes - j));
  }
  static void load(std::size_t nodes, std::size_t j, std::size_t count, const double* nodal,
                   std::vector<ad::Lanes>& state) {
    for (std::size_t i = 0; i < state.size(); ++i)
      state[i] = count == ad::Lanes::width ? ad::Lanes::load(nodal + i * nodes + j)
                                           : ad::Lanes::load(nodal + i * nodes + j, count);
  }
  static void store(const ad::Lanes& value, std::size_t count, double* place) {
    if (count == ad::Lanes::width)
      value.store(place);
    else
      value.store(place, count);
  }

  int _count;
  ModelInfo _info;
  Structure _structure;
  Bound _bound;
  typename Model::template With<double> _model;
  mutable std::unique_ptr<const Formulas> _formulas;  // recorded when they are first asked for
};

}  // namespace orbweaver::systems
