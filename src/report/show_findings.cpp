#include "show_findings.hpp"

#include <cmath>

#include <fmt/format.h>

#include "orbweaver/core/styled.hpp"
#include "orbweaver/survey/witness/finding.hpp"

namespace orbweaver::report {

namespace {

core::Style style_of(const std::string& severity) {
  if (severity == survey::name_of(survey::Severity::contradiction) ||
      severity == survey::name_of(survey::Severity::failure))
    return core::Style::bad;
  return severity == survey::name_of(survey::Severity::undecided) ? core::Style::warning : core::Style::plain;
}

}  // namespace

void print_findings(std::ostream& out, const archive::Archive& atlas) {
  const archive::Table& findings = atlas.findings();
  for (std::size_t row = 0; row < findings.rows(); ++row) {
    const double deviation = findings.reals("deviation")[row];
    const std::string& severity = findings.texts("severity")[row];
    out << core::Styled{style_of(severity), fmt::format("{:<13}", severity)}
        << fmt::format("  {:<20}  {:>8}  {}\n", findings.texts("kind")[row],
                       std::isnan(deviation) ? "-" : fmt::format("{:.1e}", deviation), findings.texts("text")[row]);
  }
}

}  // namespace orbweaver::report
