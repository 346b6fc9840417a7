#pragma once

#include <ostream>

#include "orbweaver/archive/read/reader.hpp"

namespace orbweaver::report {

/// A line a finding: severity, kind, how far off, sentence.
void print_findings(std::ostream& out, const archive::Archive& atlas);

}  // namespace orbweaver::report
