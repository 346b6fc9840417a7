#include "orbweaver/archive/schema/schema.hpp"

#include <functional>
#include <numeric>

namespace orbweaver::archive {

namespace {

ColumnSpec integer(std::string name) { return {std::move(name), ColumnType::integer, {}}; }
ColumnSpec text(std::string name) { return {std::move(name), ColumnType::text, {}}; }
ColumnSpec real(std::string name, std::vector<std::size_t> row_shape = {}) {
  return {std::move(name), ColumnType::real, std::move(row_shape)};
}

ColumnSpec stability(std::string name, const Header& header) {
  const auto pairs = static_cast<std::size_t>(header.pairs);
  return has_complex_stability(header) ? real(std::move(name), {pairs, 2}) : real(std::move(name), {pairs});
}

ColumnSpec state(const Header& header) { return real("state", {header.state_names.size()}); }

std::vector<ColumnSpec> orbit_columns(ColumnSpec family, const Header& header) {
  return {std::move(family),
          integer("step"),
          real("arclength"),
          real("period"),
          real("energy"),
          real("action"),
          real("parameter"),
          integer("cutoff"),
          real("loss_rms"),
          real("off_branch_eigenvalue"),
          stability("stability", header),
          stability("fundamental_stability", header),
          real("stability_error"),
          state(header),
          real("closure"),
          real("single_shot"),
          real("energy_drift"),
          real("tail"),
          integer("modes_begin"),
          integer("modes_count"),
          integer("time_map_begin"),
          integer("time_map_count"),
          real("winding", {header.winding_names.size()})};
}

}  // namespace

std::size_t ColumnSpec::width() const {
  return std::accumulate(row_shape.begin(), row_shape.end(), std::size_t{1}, std::multiplies<>());
}

bool has_complex_stability(const Header& header) { return !header.symplectic || header.pairs > 1; }

std::size_t stability_width(const Header& header) {
  return static_cast<std::size_t>(header.pairs) * (has_complex_stability(header) ? 2 : 1);
}

TableSpec families_spec() {
  return {"families",
          {text("name"), integer("parent"), integer("crossing"), integer("multiplicity"), text("isotropy"),
           integer("first_orbit"), integer("orbit_count"), text("end_reason"), integer("end_family"),
           integer("end_crossing")}};
}

TableSpec orbits_spec(const Header& header) { return {"orbits", orbit_columns(integer("family"), header)}; }

TableSpec crossings_spec(const Header& header) {
  return {"crossings",
          {integer("family"), real("arclength"), real("period"), real("energy"), text("kind"), integer("multiplicity"),
           integer("kernel_dimension"), real("residual"), state(header), integer("sector_j"), integer("sector_q"),
           integer("fundamental_order"), real("test_value"), real("kernel_residual")}};
}

TableSpec sections_spec(const Header& header) { return {"sections", {integer("orbit"), real("time"), state(header)}}; }

TableSpec segment_orbits_spec(const Header& header) { return {"orbits", orbit_columns(text("family_key"), header)}; }

TableSpec segment_sections_spec(const Header& header) {
  return {"sections", {text("family_key"), integer("step"), real("time"), state(header)}};
}

}  // namespace orbweaver::archive
