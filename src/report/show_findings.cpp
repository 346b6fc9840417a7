#include "show_findings.hpp"

#include <cmath>

#include <fmt/format.h>

namespace orbweaver::report {

void print_findings(std::ostream& out, const archive::Archive& atlas) {
  const archive::Table& findings = atlas.findings();
  for (std::size_t row = 0; row < findings.rows(); ++row) {
    const double deviation = findings.reals("deviation")[row];
    out << fmt::format("{:<13}  {:<20}  {:>8}  {}\n", findings.texts("severity")[row], findings.texts("kind")[row],
                       std::isnan(deviation) ? "-" : fmt::format("{:.1e}", deviation), findings.texts("text")[row]);
  }
}

}  // namespace orbweaver::report
