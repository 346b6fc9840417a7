#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "orbweaver/model/recorded.hpp"
#include "orbweaver/systems/model/checks.hpp"
#include "orbweaver/systems/registry.hpp"
#include "orbweaver/systems/system.hpp"
#include "orbweaver/systems/text/system_of.hpp"

namespace orbweaver::systems {

/// The system of a model that a program writes in C++ (docs/api.md): its functions are called once, with a scalar that
/// writes down what they do. A model has
///   static constexpr int dimension;
///   static constexpr int quantities;                          // functions that may be conserved
///   static ModelInfo info();
///   static Structure structure(const Bound& bound);           // what holds with these parameters and effects; names
///                                                             // each of the functions that is conserved
///   `template <class P> class With;`                          // the model with parameters of type P
/// and With<P> has, S being P,
///   explicit With(const BoundTo<P>& bound);
///   `template <class S> void field(const S* z, S* f) const;`
///   `template <int K, class S> S conserved(const S* z) const;` // quantity K of the structure, K < quantities
///   `template <class S> S action_density(const S* z) const;`   // if it conserves an energy; NaN where there is none
///   `template <class S> S guard(int k, const S* z) const;`     // if its structure may name guards
/// Constants are doubles; what none is exactly (1/3) is written as S(1.0) / 3.0, so that more digits than those of a
/// double can be had. Throws StructureError where the structure does not fit the model.
template <class Model>
[[nodiscard]] std::shared_ptr<const System> recorded(const Bound& bound) {
  using model::Recorded;
  model::Recording recording;
  BuiltModel built;
  built.info = Model::info();
  built.effects = bound.effects;
  BoundTo<Recorded> values{{}, bound.effects, {}};
  for (const auto& [name, value] : bound.parameters) {
    values.parameters.emplace(name, recording.parameter(static_cast<int>(built.parameters.size())));
    built.parameters.push_back(name);
  }
  Structure structure = Model::structure(bound);
  const typename Model::template With<Recorded> own(values);
  std::vector<Recorded> z, f(Model::dimension, Recorded(0.0));
  for (int i = 0; i < Model::dimension; ++i) z.push_back(recording.input(i));
  own.field(z.data(), f.data());
  for (const Recorded& rate : f) built.field.push_back(rate.node());
  [&]<int... K>(std::integer_sequence<int, K...>) {
    (built.quantities.push_back({"", own.template conserved<K, Recorded>(z.data()).node(), true}), ...);
  }
  (std::make_integer_sequence<int, Model::quantities>{});
  if constexpr (requires { own.action_density(z.data()); }) built.action = own.action_density(z.data()).node();
  if constexpr (requires { own.guard(0, z.data()); })
    for (std::size_t k = 0; k < structure.guards.size(); ++k)
      built.guards.push_back(own.guard(static_cast<int>(k), z.data()).node());
  built.graph = recording.graph();
  return system_of(std::move(built), std::move(structure), bound);
}

/// From then on its name stands for it in scenes. Throws as add_recorded does.
template <class Model>
void add_recorded() {
  add_recorded(Model::info(), recorded<Model>);
}

}  // namespace orbweaver::systems
