#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <vector>

#include <mpi.h>

#include "orbweaver/archive/schema/records.hpp"

namespace orbweaver::archive {

struct ConsolidateOptions {
  /// Doubles that one rank holds of the rows at a time (8 MiB; a single larger orbit is held whole). The bytes of the
  /// archive do not depend on it.
  std::size_t block_values = std::size_t{1} << 20;
};

/// Looks at the whole atlas, under the name that it has before it is published, and says on rank 0 what stands in
/// /findings. Called collectively; none, on all ranks alike: the atlas is not to be published.
using Witness = std::function<std::optional<std::vector<FindingRecord>>(const std::filesystem::path& atlas)>;

/// The row of /crossings of each of `tables.crossings`. Pure.
[[nodiscard]] std::vector<int> rows_of_crossings(const Records& tables);

/// Makes the atlas OUTPUT from segments and from the tables that only rank 0 has. Collective over `comm`; only rank 0's
/// arguments count. Rows stand in canonical order: families by key, orbits by family and step, crossings by family and
/// arclength (then sector, kind), section points by orbit and time. So the bytes of every dataset are the same for any
/// number of ranks and for any distribution of the rows over segments and ranks.
///
/// `tables` holds families and crossings; its orbits and sections must be empty (write them to a segment). The fields
/// `crossing` and `end_crossing` of a family are indices into `tables.crossings` as given. Rows of the segments that
/// lie outside a family's first_step ... last_step, belong to one of `tables.left_out_keys` or are among
/// `tables.voided` are left out, with their section points. No family and no crossing may refer to a family that is
/// left out; which crossings a cut family keeps is the caller's to say. Each rank holds the numbering of the rows
/// (about 64 bytes an orbit) and one block of the rows themselves.
///
/// Writes OUTPUT.part, asks `witness`, syncs, renames. Returns whether OUTPUT was published. Throws, on all ranks
/// alike: InputError for a segment that is torn, foreign, of another scene (neither the header's nor one of
/// `tables.earlier_scenes`), has an orbit twice, an orbit of a family that is neither listed nor left out, or a section
/// point of an orbit that no segment holds; MisuseError for invalid tables; EnvironmentError if the file cannot be
/// written.
bool consolidate(MPI_Comm comm, const std::vector<std::filesystem::path>& segments, const std::filesystem::path& output,
                 const Header& header, const Records& tables, const ConsolidateOptions& options = {},
                 const Witness& witness = {});

}  // namespace orbweaver::archive
