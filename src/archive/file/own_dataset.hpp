#pragma once

#include <string>

#include <hdf5.h>

namespace orbweaver::archive {

/// Whether the name leads to something by hard links alone, of which each lies in the file itself: other links may lead
/// to another file, and a pipe in its place is waited for.
[[nodiscard]] bool is_in_file(hid_t file, const std::string& name);

/// The dataset of that name whose values lie in the file itself; negative where there is none, where they lie in
/// others, where fewer are stored than its extents claim, or where they are compressed: HDF5 1.10 reads on behind a
/// chunk that unpacks to fewer bytes than it should.
[[nodiscard]] hid_t open_own_dataset(hid_t file, const std::string& name);

}  // namespace orbweaver::archive
