#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <vector>

#include "orbweaver/archive/read/table.hpp"
#include "orbweaver/archive/schema/crossing_kind.hpp"

namespace orbweaver::archive {

class SerialFile;

/// An atlas opened for reading by this rank alone (MPI need not be running). Modes stay in the file until they are
/// asked for; tables are read column by column, whole.
class Archive {
 public:
  /// Opens and checks everything but the numbers: format and version, that all columns of docs/file_format.md exist
  /// with the right type, shape and equal lengths, and that every index and every range of modes lies within its table.
  /// Throws InputError that says what is wrong, where, and what to do.
  explicit Archive(const std::filesystem::path& path);
  Archive(Archive&&) noexcept;
  Archive& operator=(Archive&&) noexcept;
  ~Archive();

  [[nodiscard]] const std::filesystem::path& path() const noexcept;

  /// `symplectic` is true where stability is stored as one real number a pair (schema.hpp, has_complex_stability).
  [[nodiscard]] const Header& header() const noexcept;

  [[nodiscard]] const Table& families() const noexcept { return _families; }
  [[nodiscard]] const Table& orbits() const noexcept { return _orbits; }
  [[nodiscard]] const Table& crossings() const noexcept { return _crossings; }
  [[nodiscard]] const Table& sections() const noexcept { return _sections; }
  /// Empty for an atlas of format_minor 0, which has no such table.
  [[nodiscard]] const Table& findings() const noexcept { return _findings; }
  /// The column `kind` of crossings().
  [[nodiscard]] const std::vector<CrossingKind>& crossing_kinds() const noexcept { return _crossing_kinds; }
  /// Values in /modes.
  [[nodiscard]] std::uint64_t mode_values() const noexcept { return _mode_values; }

  /// The Fourier coefficients of row `orbit` of /orbits: (2 cutoff + 1) x dimension, row after row: a0, a1, b1, a2, b2,
  /// ... Throws MisuseError if there is no such row, InputError if the file cannot be read.
  [[nodiscard]] std::vector<double> modes(std::size_t orbit) const;

  /// The numbers of the orbit's time map (loop::time_map_of; see loop_of for the whole loop); empty: the identity.
  [[nodiscard]] std::vector<double> time_map(std::size_t orbit) const;

 private:
  [[nodiscard]] std::vector<double> values(const char* dataset, const char* begin, const char* count,
                                           std::size_t orbit) const;

  std::unique_ptr<SerialFile> _file;
  Table _families;
  Table _orbits;
  Table _crossings;
  Table _sections;
  Table _findings;
  std::vector<CrossingKind> _crossing_kinds;
  std::uint64_t _mode_values = 0;
};

}  // namespace orbweaver::archive
