#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <mpi.h>

#include "orbweaver/archive/schema/records.hpp"

namespace orbweaver::archive {

/// An orbit's place in the archive's order, and where its row lies.
struct OrbitRow {
  std::int64_t family = -1;  ///< index into the sorted family keys
  std::int64_t step = 0;
  std::int64_t segment = 0;
  std::int64_t row = 0;
  std::int64_t modes_begin = 0;  ///< in the segment
  std::int64_t modes_count = 0;
  std::int64_t map_begin = 0;
  std::int64_t map_count = 0;
};

struct SectionRow {
  std::int64_t family = -1;
  std::int64_t step = 0;
  std::int64_t segment = 0;
  std::int64_t row = 0;
  std::int64_t orbit = -1;  ///< row of /orbits
  double time = 0.0;
};

struct StepRange {
  std::int64_t first = 0;
  std::int64_t last = 0;
};

/// Steps that are left out of the segments before `before_segment`.
struct VoidedSteps {
  StepRange steps;
  std::int64_t before_segment = 0;
};

/// Which rows of the segments the archive takes.
struct Selection {
  std::vector<std::string> keys;         ///< of the families, sorted
  std::vector<StepRange> steps;          ///< one a key
  std::vector<double> births;            ///< arclengths, one a key; NaN: of none
  std::vector<std::string> left_out;     ///< keys of families whose rows are left out, sorted
  std::vector<std::string> voided_keys;  ///< of the families that have voided rows, sorted, one an entry of `voided`
  std::vector<VoidedSteps> voided;
  std::vector<std::string> earlier_scenes;  ///< besides the header's
};

/// All rows that are taken of all segments in canonical order, the same on every rank.
struct Numbering {
  std::vector<OrbitRow> orbits;
  std::vector<SectionRow> sections;
  std::vector<std::uint64_t> modes_at;  ///< where orbit i's modes begin in the archive; one more than orbits
  std::vector<std::uint64_t> maps_at;

  /// First row of /orbits of the family with index `family`, or of the next one that has any.
  [[nodiscard]] std::int64_t first_orbit(std::int64_t family) const;
};

/// Collective. Checks the segments (each by one rank) and numbers the rows that `selection`, the same
/// on all ranks, takes. Throws InputError on all ranks as `consolidate` says.
[[nodiscard]] Numbering number_rows(MPI_Comm comm, const std::vector<std::string>& segments, const Header& header,
                                    const Selection& selection);

}  // namespace orbweaver::archive
