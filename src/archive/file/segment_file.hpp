#pragma once

#include "serial_file.hpp"

namespace orbweaver::archive {

/// A segment opened for reading, all columns checked.
class SegmentFile {
 public:
  /// Opens and checks the columns, not yet the values. Throws InputError.
  explicit SegmentFile(const std::filesystem::path& path);

  /// Checks that modes and time maps lie row after row without gaps, and fill their datasets, and that attributes and
  /// rows give their checksums. Throws InputError.
  void check_values() const;
  /// Checks that the modes and time maps of every row give their checksums. Throws InputError.
  void check_loops() const;

  [[nodiscard]] const SerialFile& file() const noexcept { return _file; }
  [[nodiscard]] const TableSpec& orbits_spec() const noexcept { return _orbits; }
  [[nodiscard]] const TableSpec& sections_spec() const noexcept { return _sections; }
  [[nodiscard]] std::uint64_t orbits() const noexcept { return _orbit_rows; }
  [[nodiscard]] std::uint64_t sections() const noexcept { return _section_rows; }
  [[nodiscard]] std::uint64_t mode_values() const noexcept { return _mode_values; }

  /// A whole column of integers or texts.
  [[nodiscard]] std::vector<std::int64_t> orbit_integers(const char* name) const;
  [[nodiscard]] std::vector<std::string> orbit_texts(const char* name) const;

  /// Of the orbits it holds (WrittenSegment).
  [[nodiscard]] std::uint64_t fingerprint() const;

 private:
  void check_ranges(const char* begin, const char* count, std::uint64_t total) const;
  void check_rows(const TableSpec& spec, std::uint64_t rows) const;
  void check_loops(const std::string& name, const std::string& dataset) const;

  SerialFile _file;
  TableSpec _orbits;
  TableSpec _sections;
  std::uint64_t _orbit_rows = 0;
  std::uint64_t _section_rows = 0;
  std::uint64_t _mode_values = 0;
  std::uint64_t _map_values = 0;
};

}  // namespace orbweaver::archive
