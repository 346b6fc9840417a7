#pragma once

#include "orbweaver/core/error.hpp"
#include "orbweaver/survey/run/survey.hpp"

namespace orbweaver::drivers {

/// What a program ends with that has come to this summary: of a survey, or of an archive made of one.
[[nodiscard]] core::ExitStatus status_of(const survey::Summary& summary);

}  // namespace orbweaver::drivers
