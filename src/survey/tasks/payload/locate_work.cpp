#include "locate_work.hpp"

#include "keys.hpp"
#include "orbweaver/core/text.hpp"
#include "payload.hpp"

namespace orbweaver::survey {

queue::Task task_of(const LocateWork& work) {
  return {locate_key(work.key), priority_of(TaskKind::locate, work.lineage.depth), name_of(TaskKind::locate),
          pack(work)};
}

std::string pack(const LocateWork& work) { return to_payload(work); }
std::string pack(const LocateOutcome& outcome) { return to_payload(outcome); }
LocateWork unpack_locate_work(const std::string& bytes) { return from_payload<LocateWork>(bytes); }

LocateOutcome unpack_locate_outcome(const std::string& bytes) {
  LocateOutcome outcome = from_payload<LocateOutcome>(bytes);
  outcome.remark = core::recordable(outcome.remark);  // of any bytes
  return outcome;
}

std::string branch_key(const LeavingRecord& leaving, int side) {
  return leaving.key + (leaving.both_sides ? (side > 0 ? "+" : "-") : "");
}

}  // namespace orbweaver::survey
