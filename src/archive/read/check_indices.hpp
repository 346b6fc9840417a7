#pragma once

#include "file/serial_file.hpp"
#include "orbweaver/archive/read/table.hpp"

namespace orbweaver::archive {

/// What the indices of an atlas are checked against.
struct AtlasTables {
  const Table& families;
  const Table& orbits;
  const Table& crossings;
  const Table& sections;
  const Table& loci;
  const Table& findings;
  std::uint64_t mode_values = 0;
  std::uint64_t map_values = 0;
};

/// Throws InputError, naming dataset and row, for an index outside its table, modes outside /modes or of a number that
/// does not fit the cutoff, and families whose ranges of orbits do not agree with /orbits/family.
void check_indices(const SerialFile& file, const AtlasTables& tables);

}  // namespace orbweaver::archive
