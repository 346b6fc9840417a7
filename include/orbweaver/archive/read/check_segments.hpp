#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <mpi.h>

#include "orbweaver/archive/write/segment.hpp"

namespace orbweaver::archive {

/// Whether the segments that a checkpoint lists still are in `folder` as they were written. Collective over `comm`,
/// each rank inspects its share; only rank 0's arguments count. Returns on all ranks, in the order listed, one sentence
/// for each segment that is missing, torn, foreign, or not the one that was listed; empty: all is well. `scenes`: the
/// texts for which segments may have been written. What is compared are the scene, the size, the number of rows and
/// which orbits they are; of the numbers, arclengths and periods.
[[nodiscard]] std::vector<std::string> check_segments(MPI_Comm comm, const std::filesystem::path& folder,
                                                      const std::vector<WrittenSegment>& listed,
                                                      const std::vector<std::string>& scenes);

}  // namespace orbweaver::archive
