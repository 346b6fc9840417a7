#pragma once

/// What the source of a plugin includes: all that a model is written with, and the macro that ends it
/// (docs/your_own_system.md). `orbweaver build-system` compiles it.
#include <array>
#include <utility>

#include "orbweaver/model/field_functions.hpp"
#include "orbweaver/systems/model/model_system.hpp"
#include "orbweaver/systems/model/plugin_table.hpp"

#ifndef ORBWEAVER_PLUGIN_SOURCE
#define ORBWEAVER_PLUGIN_SOURCE ""
#endif
#ifndef ORBWEAVER_PLUGIN_VERSION
#define ORBWEAVER_PLUGIN_VERSION "unknown"
#endif

namespace orbweaver::systems {

template <class... Models>
inline constexpr std::array plugin_lines{registry_line<Models>...};

/// Compiles the formulas of models for one scalar alone, so that what is wrong with them is said once.
template <class... Models>
struct OneScalar {
  template <class Model>
  static void formulas(const typename Model::template With<model::Recorded>& own, const model::Recorded* z,
                       model::Recorded* f) {
    static_assert(
        requires { own.field(z, f); },
        "a model has `template <class S> void field(const S* z, S* f) const`, f being dz/dt, a function of the "
        "present state: delays, differential-algebraic equations and maps are not done (docs/limits.md)");
    if constexpr (requires { own.field(z, f); }) own.field(z, f);
    [&]<int... K>(std::integer_sequence<int, K...>) {
      (static_cast<void>(own.template conserved<K, model::Recorded>(z)), ...);
    }
    (std::make_integer_sequence<int, Model::quantities>{});
  }
  static void all(const model::Recorded* z, model::Recorded* f,
                  const typename Models::template With<model::Recorded>&... models) {
    (formulas<Models>(models, z, f), ...);
  }
};

}  // namespace orbweaver::systems

#ifdef ORBWEAVER_ONE_SCALAR
#define ORBWEAVER_SYSTEMS(...) template struct orbweaver::systems::OneScalar<__VA_ARGS__>
#else
/// Exports models, of one name and with different effects, or of different names: ORBWEAVER_SYSTEMS(MyModel). At global
/// scope, once a plugin.
#define ORBWEAVER_SYSTEMS(...)                                                                             \
  extern "C" [[gnu::visibility("default")]] const orbweaver::systems::PluginTable orbweaver_plugin;        \
  const orbweaver::systems::PluginTable orbweaver_plugin {                                                 \
    .size = sizeof(orbweaver::systems::PluginTable), .version = ORBWEAVER_PLUGIN_VERSION,                  \
    .source = ORBWEAVER_PLUGIN_SOURCE, .line_count = orbweaver::systems::plugin_lines<__VA_ARGS__>.size(), \
    .lines = orbweaver::systems::plugin_lines<__VA_ARGS__>.data()                                          \
  }
#endif
