#include "summary_status.hpp"

namespace orbweaver::drivers {

core::ExitStatus status_of(const survey::Summary& summary) {
  if (summary.stopped_early) return core::ExitStatus::stopped_early;
  return summary.failures > 0 ? core::ExitStatus::goal_missed : core::ExitStatus::done;
}

}  // namespace orbweaver::drivers
