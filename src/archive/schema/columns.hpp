#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <type_traits>
#include <variant>
#include <vector>

#include "orbweaver/archive/read/table.hpp"
#include "orbweaver/archive/schema/records.hpp"
#include "orbweaver/archive/schema/schema.hpp"

namespace orbweaver::archive {

/// How many values a row of a column has; the header tells the numbers.
enum class RowShape { one, state, winding, stability, eigenvalues, oscillations };

/// An integer that says where other rows lie: it is filled in when the rows are numbered, and -1 until then.
struct RowNumber {};

/// A checksum (row_checksum.hpp): it is filled in when the row is complete, and -1 until then.
struct Checksum {};

/// What the file says of a column (its attributes `unit`, where there is one, and `meaning`).
struct ColumnText {
  const char* unit = "";
  const char* meaning = "";
};

/// One column of a table: its name, the member of the record that a row is taken from, its meaning, and the shape of a
/// row. The lists below are the only place where a column is defined; the schema, the segments and the atlas follow
/// from them.
template <class Record>
struct ColumnDefinition {
  using Member =
      std::variant<RowNumber, Checksum, int Record::*, double Record::*, std::string Record::*, CrossingKind Record::*,
                   std::vector<double> Record::*, std::vector<std::int64_t> Record::*>;
  const char* name;
  Member member = RowNumber{};
  ColumnText text;
  RowShape shape = RowShape::one;
  int since = 0;  ///< ColumnSpec
};

template <class Record>
using ColumnDefinitions = std::vector<ColumnDefinition<Record>>;

[[nodiscard]] const ColumnDefinitions<FamilyRecord>& family_columns();
[[nodiscard]] const ColumnDefinitions<OrbitRecord>& orbit_columns();
/// Those of /orbits that a certificate fills.
[[nodiscard]] const ColumnDefinitions<CertificateRecord>& certificate_columns();
[[nodiscard]] const ColumnDefinitions<CrossingRecord>& crossing_columns();
[[nodiscard]] const ColumnDefinitions<SectionRecord>& section_columns();
[[nodiscard]] const ColumnDefinitions<LocusRecord>& locus_columns();
[[nodiscard]] const ColumnDefinitions<EquilibriumRecord>& equilibrium_columns();
[[nodiscard]] const ColumnDefinitions<FindingRecord>& finding_columns();
[[nodiscard]] const ColumnDefinitions<ModelRecord>& model_columns();
/// In segments, where rows have no numbers yet, orbits and sections name their family by its key.
[[nodiscard]] const ColumnDefinitions<OrbitRecord>& segment_orbit_columns();
[[nodiscard]] const ColumnDefinitions<SectionRecord>& segment_section_columns();

/// Fills the columns that are taken from members: row i from `record(i)`. An empty vector leaves its row as it is.
template <class Record, class RecordOf>
void fill_columns(Table& table, const ColumnDefinitions<Record>& columns, const RecordOf& record) {
  for (const ColumnDefinition<Record>& definition : columns)
    std::visit(
        [&](const auto& member) {
          using Member = std::decay_t<decltype(member)>;
          if constexpr (!std::is_same_v<Member, RowNumber> && !std::is_same_v<Member, Checksum>) {
            Column& column = table.column(definition.name);
            const std::size_t width = column.spec.width();
            for (std::size_t row = 0; row < table.rows(); ++row) {
              const Record& from = record(row);
              if constexpr (std::is_same_v<Member, std::vector<double> Record::*>)
                std::copy(
                    (from.*member).begin(), (from.*member).end(),
                    std::get<std::vector<double>>(column.values).begin() + static_cast<std::ptrdiff_t>(row * width));
              else if constexpr (std::is_same_v<Member, std::vector<std::int64_t> Record::*>)
                std::copy((from.*member).begin(), (from.*member).end(),
                          std::get<std::vector<std::int64_t>>(column.values).begin() +
                              static_cast<std::ptrdiff_t>(row * width));
              else if constexpr (std::is_same_v<Member, int Record::*>)
                std::get<std::vector<std::int64_t>>(column.values)[row] = from.*member;
              else if constexpr (std::is_same_v<Member, double Record::*>)
                std::get<std::vector<double>>(column.values)[row] = from.*member;
              else if constexpr (std::is_same_v<Member, CrossingKind Record::*>)
                std::get<std::vector<std::string>>(column.values)[row] = name_of(from.*member);
              else
                std::get<std::vector<std::string>>(column.values)[row] = from.*member;
            }
          }
        },
        definition.member);
}

}  // namespace orbweaver::archive
