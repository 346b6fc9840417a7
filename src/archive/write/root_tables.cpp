#include "root_tables.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <tuple>

namespace orbweaver::archive {

namespace {

std::int64_t index_of(const std::vector<std::string>& keys, const std::string& key) {
  if (key.empty()) return -1;
  return std::lower_bound(keys.begin(), keys.end(), key) - keys.begin();
}

auto order_of(const CrossingRecord& c) {
  const auto place = std::tie(c.family_key, c.arclength, c.sector_q, c.sector_j);
  const auto rest = std::tie(c.multiplicity, c.kernel_dimension, c.fundamental_order, c.state);
  return std::tuple_cat(place, std::tuple(name_of(c.kind)), rest);
}

// order[new row] = index as given.
std::vector<std::size_t> crossing_order(const std::vector<CrossingRecord>& crossings) {
  std::vector<std::size_t> order(crossings.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return order_of(crossings[a]) < order_of(crossings[b]); });
  return order;
}

std::vector<std::int64_t> inverse(const std::vector<std::size_t>& order) {
  std::vector<std::int64_t> rows(order.size());
  for (std::size_t row = 0; row < order.size(); ++row) rows[order[row]] = static_cast<std::int64_t>(row);
  return rows;
}

void fill_crossing(Table& table, std::size_t row, const CrossingRecord& crossing,
                   const std::vector<std::string>& keys) {
  table.integers("family")[row] = index_of(keys, crossing.family_key);
  table.reals("arclength")[row] = crossing.arclength;
  table.reals("period")[row] = crossing.period;
  table.reals("energy")[row] = crossing.energy;
  table.texts("kind")[row] = name_of(crossing.kind);
  table.integers("multiplicity")[row] = crossing.multiplicity;
  table.integers("kernel_dimension")[row] = crossing.kernel_dimension;
  table.reals("residual")[row] = crossing.residual;
  const auto width = crossing.state.size();
  std::copy(crossing.state.begin(), crossing.state.end(),
            table.reals("state").begin() + static_cast<std::ptrdiff_t>(row * width));
  table.integers("sector_j")[row] = crossing.sector_j;
  table.integers("sector_q")[row] = crossing.sector_q;
  table.integers("fundamental_order")[row] = crossing.fundamental_order;
  table.reals("test_value")[row] = crossing.test_value;
  table.reals("kernel_residual")[row] = crossing.kernel_residual;
}

void fill_family(Table& table, const FamilyRecord& family, const std::vector<std::string>& keys,
                 const std::vector<std::int64_t>& crossing_rows, const Numbering& numbering) {
  const std::int64_t index = index_of(keys, family.key);
  const auto row = static_cast<std::size_t>(index);
  const auto crossing_row = [&](int given) { return given < 0 ? -1 : crossing_rows[static_cast<std::size_t>(given)]; };
  table.texts("name")[row] = family.name;
  table.integers("parent")[row] = index_of(keys, family.parent_key);
  table.integers("crossing")[row] = crossing_row(family.crossing);
  table.integers("multiplicity")[row] = family.multiplicity;
  table.texts("isotropy")[row] = family.isotropy;
  table.integers("first_orbit")[row] = numbering.first_orbit(index);
  table.integers("orbit_count")[row] = numbering.first_orbit(index + 1) - numbering.first_orbit(index);
  table.texts("end_reason")[row] = family.end_reason;
  table.integers("end_family")[row] = index_of(keys, family.end_family_key);
  table.integers("end_crossing")[row] = crossing_row(family.end_crossing);
}

}  // namespace

Selection selection_of(const Records& tables) {
  std::map<std::string, StepRange> steps;
  for (const FamilyRecord& family : tables.families) steps[family.key] = {family.first_step, family.last_step};
  Selection selection;
  for (const auto& [key, range] : steps) {
    selection.keys.push_back(key);
    selection.steps.push_back(range);
  }
  selection.left_out = tables.left_out_keys;
  std::sort(selection.left_out.begin(), selection.left_out.end());
  std::multimap<std::string, VoidedSteps> voided;
  for (const VoidedRows& rows : tables.voided)
    voided.insert({rows.family_key, {{rows.first_step, rows.last_step}, rows.before_segment}});
  for (const auto& [key, rows] : voided) {
    selection.voided_keys.push_back(key);
    selection.voided.push_back(rows);
  }
  selection.earlier_scenes = tables.earlier_scenes;
  return selection;
}

RootTables make_root_tables(const Header& header, const Records& tables, const std::vector<std::string>& keys,
                            const Numbering& numbering) {
  RootTables root{Table(families_spec(), tables.families.size()),
                  Table(crossings_spec(header), tables.crossings.size())};
  const std::vector<std::size_t> order = crossing_order(tables.crossings);
  for (std::size_t row = 0; row < order.size(); ++row)
    fill_crossing(root.crossings, row, tables.crossings[order[row]], keys);
  const std::vector<std::int64_t> crossing_rows = inverse(order);
  for (const FamilyRecord& family : tables.families) fill_family(root.families, family, keys, crossing_rows, numbering);
  return root;
}

}  // namespace orbweaver::archive
