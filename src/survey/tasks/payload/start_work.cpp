#include "start_work.hpp"

#include "keys.hpp"
#include "payload.hpp"

namespace orbweaver::survey {

queue::Task task_of(const StartWork& work) {
  // Among what is found on the parent, a generation earlier.
  return {start_key(work.branch.key), priority_of(TaskKind::start, work.branch.lineage.depth - 1),
          name_of(TaskKind::start), pack(work)};
}

std::string pack(const StartWork& work) { return to_payload(work); }
std::string pack(const StartOutcome& outcome) { return to_payload(outcome); }
StartWork unpack_start_work(const std::string& bytes) { return from_payload<StartWork>(bytes); }
StartOutcome unpack_start_outcome(const std::string& bytes) { return from_payload<StartOutcome>(bytes); }

}  // namespace orbweaver::survey
