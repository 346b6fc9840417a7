#include "orbweaver/continuation/ending.hpp"

#include <fmt/format.h>

#include "orbweaver/core/text.hpp"

namespace orbweaver::continuation {

std::string_view name_of(EndReason reason) {
  switch (reason) {
    case EndReason::period_limit: return "period limit";
    case EndReason::energy_limit: return "energy limit";
    case EndReason::parameter_limit: return "parameter limit";
    case EndReason::guard_limit: return "guard limit";
    case EndReason::step_limit: return "step limit";
    case EndReason::cutoff_limit: return "cutoff limit";
    case EndReason::period_divergence: return "period divergence";
    case EndReason::collision: return "collision";
    case EndReason::fixed_point: return "arrived at a fixed point";
    case EndReason::closed_loop: return "closed loop";
    case EndReason::strong_resonance: return "strong resonance";
    case EndReason::more_symmetry: return "met orbits of more symmetry";
    case EndReason::stopped: return "stopped";
    case EndReason::undecided: return "undecided";
    case EndReason::failure: return "failure";
  }
  return "unknown";
}

std::string Ending::text() const {
  std::string text(name_of(reason));
  if (!object.empty()) text += " " + object;
  if (!detail.empty()) text += fmt::format(" ({})", core::recordable(detail));  // a field that throws has its own words
  return text;
}

}  // namespace orbweaver::continuation
