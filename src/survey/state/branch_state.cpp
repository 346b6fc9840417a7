#include "branch_state.hpp"

#include "tasks/payload/payload.hpp"

namespace orbweaver::survey {

std::string pack(const BranchState& state) { return to_payload(state); }
BranchState unpack_branch_state(const std::string& bytes) { return from_payload<BranchState>(bytes); }

}  // namespace orbweaver::survey
