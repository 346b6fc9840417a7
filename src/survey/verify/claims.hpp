#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "orbweaver/survey/verify/verify.hpp"

namespace orbweaver::survey {

/// What one task has found.
struct Findings {
  static constexpr const char* payload_name = "verified rows";
  std::vector<Objection> objections;
  std::vector<Margin> margins;  ///< one a column
  std::int64_t uninformative = 0;

  static constexpr int wire_version = 1;
  template <class Archive>
  void serialize(Archive& archive, unsigned /*version*/) {
    core::serialize_members(archive, objections, margins, uninformative);
  }
};

/// Holds the claims of one row against what was found.
class Claims {
 public:
  Claims(Findings& findings, std::string table, std::int64_t row)
      : _findings(findings), _table(std::move(table)), _row(row) {}

  /// Two numbers that may differ by `allowed`; NaN agrees with NaN only.
  void agree(const std::string& column, double stored, double found, double allowed);
  /// Two positive numbers that may differ by a factor, or both lie below `negligible`.
  void agree_within(double factor, const std::string& column, double stored, double found, double negligible);
  /// At most `allowed`.
  void below(const std::string& column, double found, double allowed, const std::string& what);
  void object(const std::string& column, const std::string& text);
  void expect(bool holds, const std::string& column, const std::string& text) {
    if (!holds) object(column, text);
  }

 private:
  void note(const std::string& column, double excess);

  Findings& _findings;
  std::string _table;
  std::int64_t _row;
};

void merge(Findings& into, Findings&& from);

}  // namespace orbweaver::survey
