#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include <mpi.h>

#include "orbweaver/archive/schema/records.hpp"
#include "orbweaver/core/serialization.hpp"

namespace orbweaver::archive {

/// What tells a segment from others, for a checkpoint to list.
struct WrittenSegment {
  std::string name;  ///< of the file, without its folder
  std::uint64_t bytes = 0;
  std::uint64_t orbits = 0;
  std::uint64_t sections = 0;
  std::uint64_t fingerprint = 0;  ///< of which orbits it holds (keys, steps, arclengths, periods), in any order

  static constexpr int wire_version = 1;
  template <class Archive>
  void serialize(Archive& archive, unsigned /*version*/) {
    core::serialize_members(archive, name, bytes, orbits, sections, fingerprint);
  }
};

/// Writes the orbits and sections of all ranks together into a new segment file. Collective over `comm`.
///
/// Every rank gives its own rows, possibly none; the order of rows and which rank holds which does not matter for what
/// `consolidate` makes of them (the section points of one orbit keep the order in which they are given). The rows go to
/// PATH.part, which is flushed, synced and only then renamed: a file named PATH is whole. Segments hold the bulk only;
/// families and crossings are few, change until a survey ends, and are handed to `consolidate` by rank 0.
///
/// Returns on every rank what was written. Throws, on all ranks alike: MisuseError if a record of any rank is invalid
/// or the ranks' headers differ or a rank gives families or crossings; EnvironmentError if the file cannot be created,
/// written, synced or renamed (PATH.part is then removed and an older PATH is untouched).
WrittenSegment write_segment(MPI_Comm comm, const std::filesystem::path& path, const Header& header,
                             const Records& mine);

/// What a valid segment holds.
struct SegmentInfo {
  Header header;  ///< `symplectic` says whether stability is stored as one real a pair
  std::uint64_t orbits = 0;
  std::uint64_t sections = 0;
  std::uint64_t mode_values = 0;
  std::uint64_t fingerprint = 0;  ///< as in WrittenSegment
};

/// Checks a segment from end to end, except the numbers themselves: whole file, version, columns, lengths and indices.
/// Not collective. Throws InputError, with what is wrong, for a torn or foreign file.
SegmentInfo inspect_segment(const std::filesystem::path& path);

}  // namespace orbweaver::archive
