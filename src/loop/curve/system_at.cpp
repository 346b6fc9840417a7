#include "orbweaver/loop/curve/system_at.hpp"

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "orbweaver/core/error.hpp"

namespace orbweaver::loop {

std::shared_ptr<const systems::System> system_at(const systems::System& system, const Loop& loop) {
  const std::vector<std::string>& free = system.family_scalars().free;
  core::require(loop.parameters.size() == free.size(),
                "a loop has a value for every parameter that moves along the families of its system");
  std::map<std::string, double> moved;
  for (std::size_t n = 0; n < free.size(); ++n) {
    const double value = loop.parameters[n] * system.scales().parameter(n);
    if (system.parameters().at(free[n]) != value) moved[free[n]] = value;
  }
  if (moved.empty()) return {std::shared_ptr<const systems::System>(), &system};
  return system.with_parameters(moved);
}

}  // namespace orbweaver::loop
