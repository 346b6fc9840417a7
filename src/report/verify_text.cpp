#include "orbweaver/report/verify_text.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace orbweaver::report {

namespace {

std::string line_of(const survey::Objection& objection) {
  const std::string column = objection.column.empty() ? "" : "/" + objection.column;
  if (objection.table.empty()) return fmt::format("root attributes{}: {}\n", column, objection.text);
  if (objection.row < 0) return fmt::format("/{}{}: {}\n", objection.table, column, objection.text);
  return fmt::format("/{}{} row {}: {}\n", objection.table, column, objection.row, objection.text);
}

}  // namespace

std::string to_text(const survey::Verification& verification, const std::filesystem::path& atlas, bool margins) {
  std::string text;
  for (const survey::Objection& objection : verification.objections) text += line_of(objection);
  if (margins) {
    text += fmt::format("{:<32} {:>10} {:>12} {:>8}\n", "column", "compared", "worst/bound", "row");
    for (const survey::Margin& margin : verification.margins)
      text += fmt::format("{:<32} {:>10} {:>12.3g} {:>8}\n", margin.column, margin.compared, margin.worst, margin.row);
  }
  if (!verification.has_checksums) text += "the archive carries no checksums: it was written before format_minor 2\n";
  if (!verification.is_computed)
    text += "nothing was computed again, since checksums do not hold: the rows above were changed\n";
  else if (verification.uninformative > 0)
    text += fmt::format(
        "{} orbits are so unstable that integrating them says nothing; their residual, closure by segment "
        "and multipliers were compared\n",
        verification.uninformative);
  text += fmt::format(
      "{}: {} families, {} orbits, {} crossings, {} section points{}{}: {}; {:.2f} s on {} rank{}\n", atlas.string(),
      verification.families, verification.orbits, verification.crossings, verification.sections,
      verification.loci > 0 ? fmt::format(", {} points of loci", verification.loci) : "",
      verification.equilibria > 0 ? fmt::format(", {} equilibria", verification.equilibria) : "",
      verification.holds() ? "all hold" : fmt::format("{} claims do not hold", verification.objections.size()),
      verification.seconds, verification.ranks, verification.ranks == 1 ? "" : "s");
  return text;
}

}  // namespace orbweaver::report
