#include "sweep_work.hpp"

#include <fmt/format.h>

#include "payload.hpp"
#include "task_kind.hpp"

namespace orbweaver::survey {

queue::Task task_of(const SweepWork& work) {
  return {fmt::format("sweep.{:04}", work.index), priority_of(TaskKind::sweep, 0), name_of(TaskKind::sweep),
          pack(work)};
}

std::string pack(const SweepWork& work) { return to_payload(work); }
std::string pack(const SweepOutcome& outcome) { return to_payload(outcome); }
SweepWork unpack_sweep_work(const std::string& bytes) { return from_payload<SweepWork>(bytes); }
SweepOutcome unpack_sweep_outcome(const std::string& bytes) { return from_payload<SweepOutcome>(bytes); }

}  // namespace orbweaver::survey
