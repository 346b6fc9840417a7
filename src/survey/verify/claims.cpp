#include "verify/claims.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace orbweaver::survey {

namespace {

Margin& margin_of(Findings& findings, const std::string& column) {
  for (Margin& margin : findings.margins)
    if (margin.column == column) return margin;
  return findings.margins.emplace_back(Margin{column, 0.0, -1, 0});
}

}  // namespace

void Claims::note(const std::string& column, double excess) {
  Margin& margin = margin_of(_findings, _table + "/" + column);
  ++margin.compared;
  if (margin.row >= 0 && !(excess > margin.worst)) return;
  margin.worst = excess;
  margin.row = _row;
}

void Claims::object(const std::string& column, const std::string& text) {
  _findings.objections.push_back({_table, _row, column, text});
}

void Claims::agree(const std::string& column, double stored, double found, double allowed) {
  if (std::isnan(stored) && std::isnan(found)) return;
  const double deviation = std::abs(stored - found);
  if (std::isnan(deviation)) return object(column, fmt::format("is {:.17g}, found {:.17g}", stored, found));
  note(column, deviation == 0.0 ? 0.0 : deviation / allowed);
  if (deviation > allowed)
    object(column, fmt::format("is {:.17g}, found {:.17g}: they differ by {:.2g}, {:.2g} is allowed", stored, found,
                               deviation, allowed));
}

void Claims::agree_within(double factor, const std::string& column, double stored, double found, double negligible) {
  if (std::isnan(stored) && std::isnan(found)) return;
  const double less = std::max(std::min(stored, found), negligible);
  const double more = std::max(std::max(stored, found), negligible);
  const double ratio = more / less;
  if (std::isnan(stored) || std::isnan(found))
    return object(column, fmt::format("is {:.17g}, found {:.17g}", stored, found));
  note(column, (ratio - 1.0) / (factor - 1.0));
  if (!(ratio <= factor))
    object(column, fmt::format("is {:.3g}, found {:.3g}: a factor of {:g} is allowed", stored, found, factor));
}

void Claims::below(const std::string& column, double found, double allowed, const std::string& what) {
  note(column, found / allowed);
  if (!(found <= allowed)) object(column, fmt::format("{} is {:.3g}; {:.3g} is allowed", what, found, allowed));
}

void merge(Findings& into, Findings&& from) {
  for (Objection& objection : from.objections) into.objections.push_back(std::move(objection));
  for (const Margin& margin : from.margins) {
    Margin& sum = margin_of(into, margin.column);
    const std::int64_t compared = sum.compared + margin.compared;
    if (sum.row < 0 || margin.worst > sum.worst || (margin.worst == sum.worst && margin.row < sum.row)) sum = margin;
    sum.compared = compared;
  }
  into.uninformative += from.uninformative;
}

}  // namespace orbweaver::survey
