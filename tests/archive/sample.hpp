#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <mpi.h>

#include "orbweaver/archive/schema/records.hpp"

namespace orbweaver::test {

/// Two state coordinates and one angle of a made-up system; `pairs` and `symplectic` fix the width of the stability.
archive::Header sample_header(int pairs = 1, bool symplectic = true);

/// Five families (one without orbits), 29 orbits of cutoffs 0 to 6 with steps below and above zero, some with time
/// maps, two crossings, one or two section points an orbit, texts with letters outside ASCII. Families and orbits are
/// given out of order.
archive::Records sample_records(const archive::Header& header);

/// The families, crossings and what says which rows are left out, or the orbits and sections, of `records` alone.
archive::Records tables_of(const archive::Records& records);
archive::Records rows_of(const archive::Records& records);

/// Part `part` of the orbits and sections: those that a generator seeded with `seed` deals to it, in a shuffled order.
archive::Records deal(const archive::Records& records, int part, int parts, unsigned seed);

/// Writes the sample as one segment and one atlas on this rank alone and returns the atlas.
std::filesystem::path write_sample_atlas(const std::filesystem::path& folder, const archive::Header& header,
                                         const archive::Records& records);

/// Name -> extents, type and raw bytes of every dataset of an HDF5 file.
std::map<std::string, std::string> dataset_bytes(const std::filesystem::path& path);

/// Makes the archive one of format_minor 1, which had no checksums.
void remove_checksums(const std::filesystem::path& atlas);

/// An empty folder of this name, in the working folder that CTest gave the test, or among the temporary files where it
/// was started by hand. Collective over `comm`.
std::filesystem::path fresh_folder(const std::string& name, MPI_Comm comm = MPI_COMM_SELF);

}  // namespace orbweaver::test
