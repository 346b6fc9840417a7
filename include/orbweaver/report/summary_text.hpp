#pragma once

#include <ostream>
#include <string>

#include "orbweaver/survey/run/survey.hpp"

namespace orbweaver::report {

enum class Detail { brief, all };

/// The summary for people, what matters first: how much there is, what failed, what does not add up, what the survey
/// notes; then the families as a table, and where the archive is. Brief: of families, findings and notes the first
/// ones, and dips of sweeps that were passed over as a number.
void print(std::ostream& out, const survey::Summary& summary, Detail detail = Detail::brief);

/// The same as a text.
[[nodiscard]] std::string to_text(const survey::Summary& summary, Detail detail = Detail::brief);

}  // namespace orbweaver::report
