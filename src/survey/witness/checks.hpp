#pragma once

#include <memory>
#include <vector>

#include "witness/check.hpp"

namespace orbweaver::survey {

/// All checks, in the order of their findings.
[[nodiscard]] std::vector<std::unique_ptr<Check>> all_checks();

}  // namespace orbweaver::survey
