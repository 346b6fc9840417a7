#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "h5_handle.hpp"
#include "orbweaver/archive/schema/schema.hpp"

namespace orbweaver::archive {

/// Fixed-length UTF-8, padded with zero bytes.
[[nodiscard]] H5Handle h5_text_type(std::size_t width);

/// The type of a column in a file (little-endian int64, float64, text), and in memory.
[[nodiscard]] H5Handle h5_file_type(const ColumnSpec& spec);
[[nodiscard]] H5Handle h5_memory_type(const ColumnSpec& spec);

/// Bytes of the longest text, at least 1.
[[nodiscard]] std::size_t longest_text(const std::vector<std::string>& texts);

/// The texts behind one another, each filled up to `width` bytes with zeros: what HDF5 takes as an array of texts.
[[nodiscard]] std::string padded_texts(const std::vector<std::string>& texts, std::size_t width);

}  // namespace orbweaver::archive
