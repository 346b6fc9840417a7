#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "orbweaver/archive/read/table.hpp"

namespace orbweaver::archive {

/// CRC-32 (zlib's: ISO 3309, polynomial 0x04C11DB7) over little-endian bytes, the same on every machine: any change of
/// up to four neighbouring bytes is found, any other but one in 2^32 (docs/file_format.md, "Checksums").

/// Of real numbers, as they are bit by bit.
[[nodiscard]] std::int64_t values_checksum(std::span<const double> values);

/// Of what stands on the root group.
[[nodiscard]] std::int64_t header_checksum(const std::string& format, std::int64_t minor, const Header& header);

/// Fills the column `checksum`: of each row's number, counted from `first`, and its values in all other columns, texts
/// with their length before them.
void set_checksums(Table& table, std::uint64_t first);

/// The rows of a whole table, from a file of this format_minor, that do not give their checksum.
[[nodiscard]] std::vector<std::size_t> changed_rows(const Table& table, std::int64_t minor);

/// "has a changed row 17 of /orbits: ...", and the same of the row's part of a flat dataset.
[[nodiscard]] std::string changed_row(const std::string& table, std::size_t row);
[[nodiscard]] std::string changed_values(const std::string& name, std::size_t row);

}  // namespace orbweaver::archive
