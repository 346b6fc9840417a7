#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace orbweaver::archive {

/// A small HDF5 file beside an archive: one table, all of whose columns are texts.
struct TextTable {
  std::string format;                            ///< root attribute `format`
  int version = 1;                               ///< root attribute `format_version`
  std::string name;                              ///< of the group
  std::vector<std::string> columns;              ///< names
  std::vector<std::vector<std::string>> values;  ///< one list a column, one text a row
};

/// Writes PATH.part, syncs and renames; an older PATH stays until then. Each row gets a CRC-32 of its texts (column
/// `checksum`, eight hexadecimal digits). Not collective. Throws EnvironmentError if it cannot be written.
void write_text_table(const std::filesystem::path& path, const TextTable& table);

/// The columns that `expected` names. Throws InputError for a file that is absent, damaged, of another format, or whose
/// rows do not give their checksums, naming the row; NewerVersionError for one of a newer version.
[[nodiscard]] TextTable read_text_table(const std::filesystem::path& path, const TextTable& expected);

/// The root attribute `format` of an HDF5 file; none where there is no such file or attribute, or it is damaged.
[[nodiscard]] std::optional<std::string> format_of(const std::filesystem::path& path);

}  // namespace orbweaver::archive
