#include "stability_columns.hpp"

#include <cmath>
#include <complex>
#include <vector>

#include "orbweaver/archive/schema/schema.hpp"

namespace orbweaver::survey {

namespace {

std::vector<double> columns_of(const std::vector<std::complex<double>>& values, bool complex) {
  std::vector<double> columns;
  for (const std::complex<double>& value : values) {
    columns.push_back(value.real());
    if (complex) columns.push_back(value.imag());
  }
  return columns;
}

}  // namespace

void set_stability(const systems::Structure& system, const std::optional<spectrum::Stability>& stability,
                   archive::OrbitRecord& row) {
  archive::Header header;
  header.pairs = system.pairs();
  header.symplectic = system.symplectic;
  row.stability.assign(archive::stability_width(header), archive::not_computed);
  row.fundamental_stability = row.stability;
  row.stability_error = archive::not_computed;
  if (!stability) return;
  const bool complex = archive::has_complex_stability(header);
  row.stability = columns_of(stability->full, complex);
  row.fundamental_stability = columns_of(stability->fundamental, complex);
  for (const double error : stability->full_error) row.stability_error = std::fmax(row.stability_error, error);
}

}  // namespace orbweaver::survey
