#pragma once

#include <string>
#include <utility>

#include "orbweaver/systems/system.hpp"

namespace orbweaver::survey {

/// The units of the outcomes' numbers, and what the level of an orbit is (continuation::level_of).
struct Units : systems::Scales {
  Units() = default;
  Units(systems::Scales scales) : systems::Scales(std::move(scales)) {}  // NOLINT: told apart by nothing but the level
  explicit Units(const systems::System& system) : systems::Scales(system.scales()) {
    if (!system.family_scalars().free.empty()) parameter_name = system.family_scalars().free.front();
  }

  std::string parameter_name{};  ///< of the one that moves along families; empty: none does

  [[nodiscard]] bool in_parameter() const { return !parameter_name.empty(); }
  [[nodiscard]] double level() const { return in_parameter() ? parameter(0) : energy(); }
  [[nodiscard]] std::string level_name() const { return in_parameter() ? parameter_name : "E"; }
  /// ", E = 0.5", of a value in the system's units; nothing where it is no number, since nothing is conserved.
  [[nodiscard]] std::string level_text(double value, int digits = 9) const;
};

}  // namespace orbweaver::survey
