#pragma once

#include "orbweaver/bifurcation/test_functions.hpp"
#include "test_functions/rule.hpp"

namespace orbweaver::bifurcation {

[[nodiscard]] const Rule& rule_of(TestFunction::Kind kind);

}  // namespace orbweaver::bifurcation
