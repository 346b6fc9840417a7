#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "orbweaver/archive/read/table.hpp"
#include "orbweaver/archive/schema/crossing_kind.hpp"

namespace orbweaver::archive {

class SerialFile;

/// What opening does where a checksum does not hold.
enum class ChangedRows { refused, listed };

/// A place of an archive whose values do not give the checksum stored with them.
struct ChangedRow {
  std::string table;    ///< empty: the root attributes
  std::size_t row = 0;  ///< of the table
  std::string text;     ///< "has a changed row 17 of /orbits: ..."
};

/// An atlas opened for reading by this rank alone (MPI need not be running). Modes stay in the file until they are
/// asked for; tables are read column by column, whole.
class Archive {
 public:
  /// `path` is an atlas, or the folder of a survey that has one (core::atlas_named).
  /// Opens and checks everything but the numbers: format and version, that all columns of docs/file_format.md exist
  /// with the right type, shape and equal lengths, and that every index and every range of modes lies within its table.
  /// The rows must give their checksums, where the file has any; with `listed` it opens all the same, and where
  /// any do not (changed_rows), indices are not checked. Throws InputError that says what is wrong, where, and what to
  /// do.
  explicit Archive(const std::filesystem::path& path, ChangedRows changed = ChangedRows::refused);
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
  /// Empty for an atlas from before there were loci (format_minor 6).
  [[nodiscard]] const Table& loci() const noexcept { return _loci; }
  /// Empty for an atlas from before they were stored (format_minor 7).
  [[nodiscard]] const Table& equilibria() const noexcept { return _equilibria; }
  /// Empty for an atlas of format_minor 0, which has no such table.
  [[nodiscard]] const Table& findings() const noexcept { return _findings; }
  /// The column `kind` of crossings().
  [[nodiscard]] const std::vector<CrossingKind>& crossing_kinds() const noexcept { return _crossing_kinds; }
  /// Whether the rows carry checksums: not before format_minor 2.
  [[nodiscard]] bool has_checksums() const noexcept;
  /// What the file says.
  [[nodiscard]] std::int64_t format_minor() const noexcept;
  /// The parameter that moves along the families (their column `parameter`); empty: none does.
  [[nodiscard]] std::string moving_parameter() const;
  /// Empty unless opened with ChangedRows::listed.
  [[nodiscard]] const std::vector<ChangedRow>& changed_rows() const noexcept { return _changed; }
  /// What is wrong with the checksums of the orbit's modes and time map, if anything.
  [[nodiscard]] std::vector<ChangedRow> changed_loop(std::size_t orbit) const;

  /// Values in /modes.
  [[nodiscard]] std::uint64_t mode_values() const noexcept { return _mode_values; }

  /// The Fourier coefficients of row `orbit` of /orbits: (2 cutoff + 1) x dimension, row after row: a0, a1, b1, a2, b2,
  /// ... Throws MisuseError if there is no such row, InputError if the file cannot be read or the numbers do not give
  /// the row's checksum.
  [[nodiscard]] std::vector<double> modes(std::size_t orbit) const;

  /// The numbers of the orbit's time map (loop::time_map_of; see loop_of for the whole loop); empty: the identity.
  [[nodiscard]] std::vector<double> time_map(std::size_t orbit) const;

 private:
  [[nodiscard]] std::vector<double> values(const char* dataset, const std::string& name, std::size_t orbit) const;
  [[nodiscard]] bool hold(const std::vector<double>& values, const std::string& name, std::size_t orbit) const;

  std::unique_ptr<SerialFile> _file;
  Table _families;
  Table _orbits;
  Table _crossings;
  Table _sections;
  Table _loci;
  Table _equilibria;
  Table _findings;
  std::vector<CrossingKind> _crossing_kinds;
  std::vector<ChangedRow> _changed;
  std::uint64_t _mode_values = 0;
};

}  // namespace orbweaver::archive
