#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "orbweaver/systems/linear_totals.hpp"
#include "orbweaver/systems/system.hpp"

namespace orbweaver::systems {

/// The system with all its totals named in its structure, and a parameter for each that has its name and, where the
/// model has none, the value given. `moving` is what moves along its families, totals among it.
[[nodiscard]] std::shared_ptr<const System> with_totals(const std::shared_ptr<const System>& system,
                                                        const std::vector<LinearTotal>& totals,
                                                        const std::map<std::string, double>& values,
                                                        const FamilyScalars& moving);

}  // namespace orbweaver::systems
