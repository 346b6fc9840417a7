#include "locus_work.hpp"

#include "keys.hpp"
#include "payload.hpp"

namespace orbweaver::survey {

queue::Task task_of(const LocusWork& work) {
  return {locus_key(work.crossing, work.entry), priority_of(TaskKind::locus, work.depth), name_of(TaskKind::locus),
          pack(work)};
}

std::string pack(const LocusWork& work) { return to_payload(work); }
std::string pack(const LocusOutcome& outcome) { return to_payload(outcome); }
LocusWork unpack_locus_work(const std::string& bytes) { return from_payload<LocusWork>(bytes); }
LocusOutcome unpack_locus_outcome(const std::string& bytes) { return from_payload<LocusOutcome>(bytes); }

}  // namespace orbweaver::survey
