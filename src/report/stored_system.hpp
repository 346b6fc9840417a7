#pragma once

#include <optional>
#include <string>
#include <vector>

#include "orbweaver/archive/read/reader.hpp"
#include "orbweaver/systems/model_info.hpp"

namespace orbweaver::report {

/// What may be asked of the system of an archive; null where this program does not know it.
[[nodiscard]] const systems::ModelInfo* info_of(const archive::Header& header);

/// Whether any orbit has an energy: none has where the system conserves none.
[[nodiscard]] bool has_energies(const archive::Archive& atlas);

/// One a parameter of the header; empty where it is not known.
[[nodiscard]] std::vector<std::string> units_of(const archive::Header& header);

/// What the system is and which coordinates tell its states, in words; empty where it is not known.
[[nodiscard]] std::string meaning_of(const archive::Header& header);

/// The coordinates that may wind, in the order of the header's winding_names: as the archive says, or as its system has
/// them where it is older than that (format_minor 11). None: such an archive, of a system that this program does not
/// know.
[[nodiscard]] std::optional<std::vector<int>> known_angles_of(const archive::Header& header);

/// The same. Throws InputError where they are not known.
[[nodiscard]] std::vector<int> angles_of(const archive::Archive& atlas);

}  // namespace orbweaver::report
