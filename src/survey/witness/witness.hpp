#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "orbweaver/archive/schema/records.hpp"
#include "orbweaver/core/mpi/communicator.hpp"
#include "orbweaver/survey/run/survey.hpp"
#include "witness/check.hpp"

namespace orbweaver::survey {

/// What the witness found; the lists are on rank 0.
struct Testimony {
  std::vector<archive::FindingRecord> records;  ///< contradictions first, then failures, undecided, cut
  std::vector<FindingSummary> summaries;        ///< the same
  std::map<std::string, std::string> doubts;    ///< by family key: how many orbits' certificates do not hold, and why
  unsigned long wrong = 0;                      ///< contradictions and failures; on all ranks
};

/// Checks the whole tree: `atlas` on the disk, and on rank 0 what it does not hold. Collective; loops are compared as
/// tasks of the queue, and the result does not depend on the number of ranks. None where the run was asked to stop
/// meanwhile. Where it had been stopped before, no loops are compared.
[[nodiscard]] std::optional<Testimony> testify(const core::Communicator& comm, const std::filesystem::path& atlas,
                                               const scene::Scene& scene,
                                               const std::shared_ptr<const systems::System>& system,
                                               WitnessInput input);

}  // namespace orbweaver::survey
