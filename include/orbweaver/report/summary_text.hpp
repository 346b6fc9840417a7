#pragma once

#include <string>

#include "orbweaver/survey/run/survey.hpp"

namespace orbweaver::report {

/// The summary as a table for people.
[[nodiscard]] std::string to_text(const survey::Summary& summary);

}  // namespace orbweaver::report
