#include "root_tables.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <tuple>

#include "orbweaver/archive/write/consolidate.hpp"
#include "schema/columns.hpp"
#include "schema/row_checksum.hpp"

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

void number_family(Table& table, std::size_t row, const FamilyRecord& family, const std::vector<std::string>& keys,
                   const std::vector<std::int64_t>& crossing_rows, const Numbering& numbering) {
  const auto index = static_cast<std::int64_t>(row);
  const auto crossing_row = [&](int given) { return given < 0 ? -1 : crossing_rows[static_cast<std::size_t>(given)]; };
  table.integers("parent")[row] = index_of(keys, family.parent_key);
  table.integers("crossing")[row] = crossing_row(family.crossing);
  table.integers("first_orbit")[row] = numbering.first_orbit(index);
  table.integers("orbit_count")[row] = numbering.first_orbit(index + 1) - numbering.first_orbit(index);
  table.integers("end_family")[row] = index_of(keys, family.end_family_key);
  table.integers("end_crossing")[row] = crossing_row(family.end_crossing);
}

// By the crossing where they begin, then along each curve.
void number_loci(Table& table, const std::vector<LocusRecord>& loci, const std::vector<std::string>& keys,
                 const std::vector<std::int64_t>& crossing_rows) {
  const auto curve = [&](const LocusRecord& point) {
    return std::tuple(crossing_rows[static_cast<std::size_t>(point.crossing)], point.locus);
  };
  std::vector<const LocusRecord*> order;
  for (const LocusRecord& point : loci) order.push_back(&point);
  std::stable_sort(order.begin(), order.end(), [&](const LocusRecord* a, const LocusRecord* b) {
    return std::tuple(curve(*a), a->step) < std::tuple(curve(*b), b->step);
  });
  fill_columns(table, locus_columns(), [&](std::size_t row) -> const LocusRecord& { return *order[row]; });
  std::int64_t number = -1;
  for (std::size_t row = 0; row < order.size(); ++row) {
    if (row == 0 || curve(*order[row]) != curve(*order[row - 1])) ++number;
    table.integers("locus")[row] = number;
    table.integers("crossing")[row] = std::get<0>(curve(*order[row]));
    table.integers("family")[row] = index_of(keys, order[row]->family_key);
  }
}

// By equilibrium, then along its curve.
Table equilibria_of(const Header& header, const std::vector<EquilibriumRecord>& equilibria) {
  std::vector<const EquilibriumRecord*> order;
  for (const EquilibriumRecord& point : equilibria) order.push_back(&point);
  std::sort(order.begin(), order.end(), [](const EquilibriumRecord* a, const EquilibriumRecord* b) {
    return std::tie(a->equilibrium, a->step) < std::tie(b->equilibrium, b->step);
  });
  Table table(equilibria_spec(header), order.size());
  fill_columns(table, equilibrium_columns(), [&](std::size_t row) -> const EquilibriumRecord& { return *order[row]; });
  set_checksums(table, 0);
  return table;
}

Table model_of(const std::string& text) {
  const ModelRecord record{text};
  Table table(model_spec(), text.empty() ? 0 : 1);
  fill_columns(table, model_columns(), [&](std::size_t) -> const ModelRecord& { return record; });
  set_checksums(table, 0);
  return table;
}

// In the order of the keys.
std::vector<const FamilyRecord*> family_order(const std::vector<FamilyRecord>& families,
                                              const std::vector<std::string>& keys) {
  std::vector<const FamilyRecord*> order(families.size());
  for (const FamilyRecord& family : families) order[static_cast<std::size_t>(index_of(keys, family.key))] = &family;
  return order;
}

}  // namespace

std::vector<int> rows_of_crossings(const Records& tables) {
  const std::vector<std::int64_t> rows = inverse(crossing_order(tables.crossings));
  return {rows.begin(), rows.end()};
}

Selection selection_of(const Records& tables) {
  std::map<std::string, const FamilyRecord*> families;
  for (const FamilyRecord& family : tables.families) families[family.key] = &family;
  Selection selection;
  for (const auto& [key, family] : families) {
    selection.keys.push_back(key);
    selection.steps.push_back({family->first_step, family->last_step});
    selection.births.push_back(family->birth_arclength);
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
                            const std::string& model, const Numbering& numbering) {
  RootTables root{Table(families_spec(), tables.families.size()),
                  Table(crossings_spec(header), tables.crossings.size()), Table(loci_spec(header), tables.loci.size()),
                  equilibria_of(header, tables.equilibria), model_of(model)};
  const std::vector<std::size_t> order = crossing_order(tables.crossings);
  const auto crossing = [&](std::size_t row) -> const CrossingRecord& { return tables.crossings[order[row]]; };
  fill_columns(root.crossings, crossing_columns(), crossing);
  for (std::size_t row = 0; row < order.size(); ++row)
    root.crossings.integers("family")[row] = index_of(keys, crossing(row).family_key);
  const std::vector<std::int64_t> crossing_rows = inverse(order);
  const std::vector<const FamilyRecord*> families = family_order(tables.families, keys);
  fill_columns(root.families, family_columns(), [&](std::size_t row) -> const FamilyRecord& { return *families[row]; });
  for (std::size_t row = 0; row < families.size(); ++row)
    number_family(root.families, row, *families[row], keys, crossing_rows, numbering);
  number_loci(root.loci, tables.loci, keys, crossing_rows);
  set_checksums(root.families, 0);
  set_checksums(root.crossings, 0);
  set_checksums(root.loci, 0);
  return root;
}

Table make_findings(const std::vector<FindingRecord>& findings) {
  Table table(findings_spec(), findings.size());
  fill_columns(table, finding_columns(), [&](std::size_t row) -> const FindingRecord& { return findings[row]; });
  set_checksums(table, 0);
  return table;
}

}  // namespace orbweaver::archive
