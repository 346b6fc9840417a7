#include "branch_work.hpp"

#include "orbweaver/core/text.hpp"
#include "payload.hpp"

namespace orbweaver::survey {

queue::Task task_of(const BranchWork& work) {
  return {work.key, priority_of(TaskKind::branch, work.lineage.depth), name_of(TaskKind::branch), pack(work)};
}

std::string pack(const BranchWork& work) { return to_payload(work); }
std::string pack(const BranchOutcome& outcome) { return to_payload(outcome); }
BranchWork unpack_branch_work(const std::string& bytes) { return from_payload<BranchWork>(bytes); }

BranchOutcome unpack_branch_outcome(const std::string& bytes) {
  BranchOutcome outcome = from_payload<BranchOutcome>(bytes);
  outcome.end.detail = core::recordable(outcome.end.detail);  // of any bytes
  return outcome;
}

continuation::Start start_of(const BranchWork& work, const systems::Structure& system) {
  continuation::Start start;
  start.base = work.base;
  start.direction = work.direction;
  start.isotropy = loop::with_declared_matrices(work.isotropy, system);
  start.base_is_orbit = work.base_is_orbit;
  start.times = work.lineage.multiplicity;
  return start;
}

}  // namespace orbweaver::survey
