#include "orbweaver/archive/schema/schema.hpp"

#include <functional>
#include <numeric>

#include "columns.hpp"

namespace orbweaver::archive {

namespace {

std::vector<std::size_t> extents_of(RowShape shape, const Header& header) {
  const auto pairs = static_cast<std::size_t>(header.pairs);
  switch (shape) {
    case RowShape::one: break;
    case RowShape::state: return {header.state_names.size()};
    case RowShape::winding: return {header.winding_names.size()};
    case RowShape::eigenvalues: return {header.state_names.size(), 2};
    case RowShape::oscillations: return {header.state_names.size() / 2};
    case RowShape::stability:
      if (has_complex_stability(header)) return {pairs, 2};
      return {pairs};
  }
  return {};
}

template <class Record>
ColumnSpec spec_of(const ColumnDefinition<Record>& column, const Header& header) {
  const auto& member = column.member;
  ColumnType type = ColumnType::integer;
  if (std::holds_alternative<std::string Record::*>(member)) type = ColumnType::text;
  if (std::holds_alternative<CrossingKind Record::*>(member)) type = ColumnType::text;
  if (std::holds_alternative<double Record::*>(member)) type = ColumnType::real;
  if (std::holds_alternative<std::vector<double> Record::*>(member)) type = ColumnType::real;
  const int since = std::holds_alternative<Checksum>(member) ? checksums_since : column.since;
  return {column.name, type, extents_of(column.shape, header), 0, since, column.text.unit, column.text.meaning};
}

template <class Record>
TableSpec spec_of(const char* name, const ColumnDefinitions<Record>& columns, const Header& header) {
  TableSpec spec{name, {}};
  for (const ColumnDefinition<Record>& column : columns) spec.columns.push_back(spec_of(column, header));
  return spec;
}

}  // namespace

std::size_t ColumnSpec::width() const {
  return std::accumulate(row_shape.begin(), row_shape.end(), std::size_t{1}, std::multiplies<>());
}

ColumnSpec modes_spec() {
  ColumnSpec spec{"modes", ColumnType::real, {}};
  spec.unit = "state";
  spec.meaning =
      "Fourier coefficients of all orbits: of each (2 K + 1) x dimension, rows a0, a1, b1, a2, b2, ...; "
      "z(s) = n s + a0 + sum of a_k cos ks + b_k sin ks";
  return spec;
}

ColumnSpec time_maps_spec() {
  ColumnSpec spec{"time_maps", ColumnType::real, {}};
  spec.meaning = "kappa, c_1, d_1, c_2, d_2, ... of each orbit that has a time map t = T phi(s) (docs/file_format.md)";
  return spec;
}

bool is_checksum(const ColumnSpec& spec) { return spec.name.ends_with("checksum"); }

bool has_complex_stability(const Header& header) { return !header.symplectic || header.pairs > 1; }

std::size_t stability_width(const Header& header) {
  return static_cast<std::size_t>(header.pairs) * (has_complex_stability(header) ? 2 : 1);
}

TableSpec families_spec() { return spec_of("families", family_columns(), {}); }

TableSpec orbits_spec(const Header& header) { return spec_of("orbits", orbit_columns(), header); }

TableSpec crossings_spec(const Header& header) { return spec_of("crossings", crossing_columns(), header); }

TableSpec sections_spec(const Header& header) { return spec_of("sections", section_columns(), header); }

TableSpec loci_spec(const Header& header) { return spec_of("loci", locus_columns(), header); }

TableSpec equilibria_spec(const Header& header) { return spec_of("equilibria", equilibrium_columns(), header); }

TableSpec findings_spec() { return spec_of("findings", finding_columns(), {}); }

TableSpec model_spec() { return spec_of("model", model_columns(), {}); }

TableSpec segment_orbits_spec(const Header& header) { return spec_of("orbits", segment_orbit_columns(), header); }

TableSpec segment_sections_spec(const Header& header) { return spec_of("sections", segment_section_columns(), header); }

}  // namespace orbweaver::archive
