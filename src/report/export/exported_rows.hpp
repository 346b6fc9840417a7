#pragma once

#include <cstddef>
#include <vector>

#include "orbweaver/archive/read/reader.hpp"
#include "orbweaver/report/export/export_orbits.hpp"

namespace orbweaver::report {

/// Rows of /orbits. Throws InputError as export_csv.
[[nodiscard]] std::vector<std::size_t> exported_rows(const archive::Archive& atlas, const ExportSelection& selection);

/// The values of the header's parameters at an orbit: the one that moves along the families has the orbit's.
[[nodiscard]] std::vector<double> parameters_at(const archive::Archive& atlas, std::size_t orbit);

}  // namespace orbweaver::report
