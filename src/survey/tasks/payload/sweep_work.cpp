#include "sweep_work.hpp"

#include "keys.hpp"
#include "payload.hpp"
#include "task_kind.hpp"

namespace orbweaver::survey {

queue::Task task_of(const SweepWork& work) {
  return {"sweep." + equilibrium_key(work.index), priority_of(TaskKind::sweep, 0), name_of(TaskKind::sweep),
          pack(work)};
}

std::string pack(const SweepWork& work) { return to_payload(work); }
std::string pack(const SweepOutcome& outcome) { return to_payload(outcome); }
SweepWork unpack_sweep_work(const std::string& bytes) { return from_payload<SweepWork>(bytes); }
SweepOutcome unpack_sweep_outcome(const std::string& bytes) { return from_payload<SweepOutcome>(bytes); }

}  // namespace orbweaver::survey
