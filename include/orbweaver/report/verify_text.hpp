#pragma once

#include <filesystem>
#include <string>

#include "orbweaver/survey/verify/verify.hpp"

namespace orbweaver::report {

/// What does not hold, a line each, and a summary; with `margins` a line for each column as well.
[[nodiscard]] std::string to_text(const survey::Verification& verification, const std::filesystem::path& atlas,
                                  bool margins);

}  // namespace orbweaver::report
