#pragma once

#include <string>
#include <vector>

#include "orbweaver/archive/schema/records.hpp"
#include "orbweaver/loop/curve/loop.hpp"
#include "orbweaver/scene/scene.hpp"
#include "orbweaver/systems/system.hpp"

namespace orbweaver::survey {

/// Times at which an orbit passes the scene's Poincaré section, in both directions, in the system's scales and
/// ascending (loop::passages); none where the scene has no section. `stored`: the loop as the archive has it.
[[nodiscard]] std::vector<double> section_times(const scene::Section& section, const systems::System& system,
                                                const loop::Loop& stored);

/// How far a state lies from the section, in its coordinate.
[[nodiscard]] double section_distance(const scene::Section& section, const systems::System& system,
                                      const std::vector<double>& state);

/// The rows of these passages in the units of the archive.
[[nodiscard]] std::vector<archive::SectionRecord> section_rows(const scene::Section& section,
                                                               const systems::System& system, const loop::Loop& stored,
                                                               const std::string& family, int step);

}  // namespace orbweaver::survey
