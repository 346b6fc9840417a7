#pragma once

#include <optional>
#include <ostream>
#include <string>

#include "orbweaver/archive/read/reader.hpp"

namespace orbweaver::report {

/// Which orbits of an archive: all, those of the family of this name, or one step of it.
struct ExportSelection {
  std::string family;       ///< empty: all
  std::optional<int> step;  ///< of that family
};

/// Initial states and periods for other programs, a line an orbit: family, step, period, energy, the values of all
/// parameters (`parameter_mu`), `linear_stability` (stable, unstable, unknown), the stability values as in /orbits,
/// the state at s = 0 (`state_th1`). RFC 4180, lines end with \n; numbers with 17 digits, `nan` where there is none.
/// In the units of the system. Throws InputError for a family or step that is not there, and where there are no orbits.
void export_csv(std::ostream& out, const archive::Archive& atlas, const ExportSelection& selection);

/// The same as one JSON object: `format` "orbweaver-orbits", `version` 1, `orbweaver_version`, `system`, `effects`,
/// `state_names`, `stability_values` ("indices" mu + 1/mu or "multipliers"), and `orbits`, a list of objects with
/// family, step, period, energy, parameters, linear_stability, stability (numbers, or pairs [re, im]), state; `null`
/// where there is no number. UTF-8. Throws as export_csv.
void export_json(std::ostream& out, const archive::Archive& atlas, const ExportSelection& selection);

}  // namespace orbweaver::report
