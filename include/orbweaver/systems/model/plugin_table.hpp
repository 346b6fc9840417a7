#pragma once

#include <array>
#include <cstdint>

#include <Eigen/Core>

#include "orbweaver/model/graph.hpp"
#include "orbweaver/systems/formulas.hpp"
#include "orbweaver/systems/model/registered.hpp"

namespace orbweaver::systems {

/// Raised whenever what a plugin and the program share changes: this table, System and the types of its functions.
inline constexpr std::uint32_t plugin_abi = 2;

/// Sizes of the types that a plugin and the program share, and of the processor's vectors, on which Eigen's alignment
/// depends: they differ between compilers, their options and packages.
using PluginLayout = std::array<std::uint32_t, 8>;
inline constexpr PluginLayout plugin_layout{sizeof(RegistryLine), sizeof(Bound),        sizeof(ModelInfo),
                                            sizeof(Structure),    sizeof(Formulas),     sizeof(model::Node),
                                            sizeof(model::Graph), EIGEN_MAX_ALIGN_BYTES};

/// What a plugin exports as `orbweaver_plugin`. Its first three members stay as they are in every version.
struct PluginTable {
  std::uint32_t abi = plugin_abi;
  std::uint32_t size = 0;    ///< of this table, in bytes
  const char* version = "";  ///< of the package that it was built against
  const char* source = "";   ///< hash of its source; "" where it was not built by `orbweaver build-system`
  PluginLayout layout = plugin_layout;
  std::uint32_t line_count = 0;
  const RegistryLine* lines = nullptr;
};

}  // namespace orbweaver::systems
