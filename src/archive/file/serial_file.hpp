#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "h5_handle.hpp"
#include "orbweaver/archive/read/table.hpp"

namespace orbweaver::archive {

/// What a file is expected to be, and what to tell a user who has another one.
struct FileKind {
  const char* format;  ///< root attribute `format`
  const char* noun;    ///< "an Orbweaver atlas"
  const char* remedy;  ///< "Write it anew with ..."
};

[[nodiscard]] const FileKind& atlas_kind();
[[nodiscard]] const FileKind& segment_kind();

/// One HDF5 file of Orbweaver, opened for reading by this rank alone; no MPI is needed and no lock is taken. Whatever
/// is missing, torn or foreign throws InputError with the path, the problem and the remedy.
class SerialFile {
 public:
  /// Opens and checks the attributes; datasets are checked by `expect_table` and `expect_flat`.
  SerialFile(std::filesystem::path path, const FileKind& kind);

  [[nodiscard]] const std::filesystem::path& path() const noexcept { return _path; }
  [[nodiscard]] const Header& header() const noexcept { return _header; }

  /// Its format_minor.
  [[nodiscard]] std::int64_t minor() const noexcept { return _minor; }
  /// Whether its rows carry checksums: those of older versions do not.
  [[nodiscard]] bool has_checksums() const noexcept { return _minor >= checksums_since; }
  /// What is wrong with the root attributes, for `expect`; empty: they give their checksum, or there is none.
  [[nodiscard]] std::string change_in_header() const;

  /// Whether the file has this table: one that older versions did not write.
  [[nodiscard]] bool has_table(const std::string& name) const;
  /// Reads /model, where the file has one, into the header. What is wrong with its text, for `expect`; empty: it
  /// gives the hash that stands on the root group.
  [[nodiscard]] std::string read_model();
  /// Checks that all columns exist with the right type and shape and equally many rows; fills in the text widths and
  /// returns the number of rows. Only columns that were checked can be read.
  std::uint64_t expect_table(TableSpec& spec);
  /// The same for a flat float64 dataset of the root group; returns its length.
  std::uint64_t expect_flat(const std::string& name);

  /// Rows [first, first + count) of a column of `table`.
  [[nodiscard]] Column read(const std::string& table, const ColumnSpec& spec, std::uint64_t first,
                            std::uint64_t count) const;
  [[nodiscard]] Table read_table(const TableSpec& spec, std::uint64_t rows) const;
  [[nodiscard]] std::vector<double> read_flat(const std::string& name, std::uint64_t first, std::uint64_t count) const;

  /// Throws InputError unless `condition`: "'path' <problem>. <remedy>".
  void expect(bool condition, const std::string& problem) const;

 private:
  void open();
  void read_header();
  [[nodiscard]] H5Handle attribute(const char* name, H5T_class_t type) const;
  [[nodiscard]] std::int64_t integer_attribute(const char* name) const;
  [[nodiscard]] std::vector<std::string> text_attribute(const char* name) const;
  [[nodiscard]] std::vector<double> real_attribute(const char* name) const;
  [[nodiscard]] std::vector<int> whole_attribute(const char* name) const;
  [[nodiscard]] std::string single_text_attribute(const char* name) const;
  const H5Handle& dataset(const std::string& name);
  [[nodiscard]] std::vector<hsize_t> extents(const H5Handle& dataset) const;
  void expect_type(const std::string& name, ColumnSpec& spec);
  /// Throws InputError where values of `bytes` bytes would take more than the file has: a forged extent.
  void expect_room(const std::string& name, const std::vector<hsize_t>& extents, std::size_t bytes) const;
  void read_rows(const std::string& name, hid_t memory_type, std::uint64_t first, const std::vector<hsize_t>& counts,
                 void* data) const;

  std::filesystem::path _path;
  const FileKind* _kind;
  Header _header;
  std::int64_t _minor = 0;
  std::uint64_t _bytes = 0;  // of the file
  H5Handle _file;
  std::map<std::string, H5Handle> _datasets;
};

}  // namespace orbweaver::archive
