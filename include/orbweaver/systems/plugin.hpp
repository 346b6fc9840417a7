#pragma once

/// What the source of a plugin includes: all that a model is written with, and the macro that ends it
/// (docs/your_own_system.md). `orbweaver build-system` compiles it.
#include <array>

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

}  // namespace orbweaver::systems

/// Exports models, of one name and with different effects, or of different names: ORBWEAVER_SYSTEMS(MyModel). At global
/// scope, once a plugin.
#define ORBWEAVER_SYSTEMS(...)                                                                             \
  extern "C" [[gnu::visibility("default")]] const orbweaver::systems::PluginTable orbweaver_plugin;        \
  const orbweaver::systems::PluginTable orbweaver_plugin {                                                 \
    .size = sizeof(orbweaver::systems::PluginTable), .version = ORBWEAVER_PLUGIN_VERSION,                  \
    .source = ORBWEAVER_PLUGIN_SOURCE, .line_count = orbweaver::systems::plugin_lines<__VA_ARGS__>.size(), \
    .lines = orbweaver::systems::plugin_lines<__VA_ARGS__>.data()                                          \
  }
