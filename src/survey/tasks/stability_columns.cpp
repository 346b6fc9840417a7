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

double stability_error(const spectrum::Stability& stability) {
  double largest = archive::not_computed;
  for (const double error : stability.full_error) largest = std::fmax(largest, error);
  return largest;
}

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
  row.stability_error = stability_error(*stability);
}

}  // namespace orbweaver::survey
