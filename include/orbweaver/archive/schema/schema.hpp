#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "orbweaver/archive/schema/records.hpp"

namespace orbweaver::archive {

/// What stands in the root attribute `format`, and the only `format_version` that this Orbweaver writes and reads.
inline constexpr const char* atlas_format = "orbweaver-atlas";
inline constexpr const char* segment_format = "orbweaver-segment";
inline constexpr int format_version = 1;
/// Root attribute `format_minor`: it rises with every table, column or attribute that is added; older files of the
/// version are read. 1: /findings, system, effects, parameters, scales. 2: checksums. 3: what certificates say. 4:
/// /sections is filled. 5: the parameter at crossings and findings. 6: /loci. 7: /equilibria. 8:
/// `log_volume` of /orbits. 9: the attributes `unit` and `meaning` of datasets. 10:
/// `birth_arclength` of /families. 11: the errors of places of /crossings, winding_coordinates, /model.
inline constexpr int format_minor = 11;
/// The first with checksums.
inline constexpr int checksums_since = 2;
/// The first with verdicts.
inline constexpr int certificates_since = 3;
/// The first whose /sections has what the scene asks for.
inline constexpr int sections_since = 4;
/// The first with the parameter of families in one.
inline constexpr int parameters_since = 5;
/// The first with log_volume.
inline constexpr int volumes_since = 8;
/// The first that says where on a family it was born.
inline constexpr int births_since = 10;
/// The first that says how well places of crossings are known.
inline constexpr int place_errors_since = 11;
/// The first that says which coordinates the winding numbers belong to.
inline constexpr int winding_coordinates_since = 11;

/// Bytes of a model's text.
inline constexpr std::size_t longest_model = 1'000'000;

enum class ColumnType { integer, real, text };

/// One dataset of a table: its extents are the number of rows followed by `row_shape` (empty: one value a row).
struct ColumnSpec {
  std::string name;
  ColumnType type = ColumnType::real;
  std::vector<std::size_t> row_shape;
  std::size_t text_width = 0;  ///< bytes of a text; set when the column is written
  int since = 0;          ///< the first format_minor that has it: read from an older file, it is NaN or -1 throughout
  const char* unit = "";  ///< attribute of the dataset: "time", "energy", "state"; empty: it has none
  const char* meaning = "";  ///< attribute of the dataset: one phrase

  /// Values in one row.
  [[nodiscard]] std::size_t width() const;
};

/// The flat datasets of the root group, float64.
[[nodiscard]] ColumnSpec modes_spec();
[[nodiscard]] ColumnSpec time_maps_spec();

/// A column that says nothing of the orbits: it is there to find changed bytes.
[[nodiscard]] bool is_checksum(const ColumnSpec& spec);

/// One group of datasets with a common number of rows.
struct TableSpec {
  std::string name;  ///< the group without its slash: "orbits"
  std::vector<ColumnSpec> columns;
};

/// True where a stability value is a complex number, stored as re, im: multipliers of a system that is not symplectic,
/// and the indices of two or more symplectic pairs, which leave the real axis in a Krein collision. One pair's index is
/// real.
[[nodiscard]] bool has_complex_stability(const Header& header);

/// Doubles in OrbitRecord::stability and OrbitRecord::fundamental_stability: pairs, or 2 pairs (re, im, re, im, ...)
/// where complex.
[[nodiscard]] std::size_t stability_width(const Header& header);

/// The tables of an atlas (docs/file_format.md). Widths of vector columns come from the header.
[[nodiscard]] TableSpec families_spec();
[[nodiscard]] TableSpec orbits_spec(const Header& header);
[[nodiscard]] TableSpec crossings_spec(const Header& header);
[[nodiscard]] TableSpec sections_spec(const Header& header);
[[nodiscard]] TableSpec loci_spec(const Header& header);
[[nodiscard]] TableSpec equilibria_spec(const Header& header);
[[nodiscard]] TableSpec findings_spec();
[[nodiscard]] TableSpec model_spec();

/// The tables of a segment: orbits and sections name their family by its key, since rows are not numbered yet.
[[nodiscard]] TableSpec segment_orbits_spec(const Header& header);
[[nodiscard]] TableSpec segment_sections_spec(const Header& header);

}  // namespace orbweaver::archive
