#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "orbweaver/archive/read/table.hpp"

namespace orbweaver::archive {

/// What a file holds before any row is written: attributes, and datasets of final size.
struct FileLayout {
  const char* format = "";
  Header header;
  std::vector<std::pair<TableSpec, std::uint64_t>> tables;  ///< with their rows; text widths are set
  std::vector<std::pair<ColumnSpec, std::uint64_t>> flats;  ///< float64 datasets of the root group with their lengths

  /// Bytes of all datasets.
  [[nodiscard]] std::uint64_t bytes() const;
};

/// Creates (or empties) `path` and lays out all attributes and datasets, contiguous, with their final place and disk
/// space taken. One rank alone. Throws EnvironmentError; a full disk is met before HDF5 writes anything.
void create_layout_file(const std::filesystem::path& path, const FileLayout& layout);

/// Lays out one more table, small beside the others, in a file that nobody has open. One rank alone. Throws
/// EnvironmentError.
void add_table_to_file(const std::filesystem::path& path, const TableSpec& table, std::uint64_t rows);

}  // namespace orbweaver::archive
