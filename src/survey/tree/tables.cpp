#include "tables.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include <fmt/format.h>

#include "arclengths.hpp"
#include "end_text.hpp"
#include "family_names.hpp"
#include "orbweaver/loop/symmetry/isotropy.hpp"
#include "orbweaver/survey/tree/family_end.hpp"
#include "orbweaver/survey/tree/naming.hpp"

namespace orbweaver::survey {

namespace {

/// A fold shows twice: as an extremum and as a zero of the test function of q = 1. The first by key stays.
class FoldsOnce {
 public:
  /// False for a fold that has been: of the same kind on the same family with the same value, no farther along it than
  /// the orbits between which both were located, on curves through other orbits.
  bool is_new(const LocateOutcome& crossing, double arclength) {
    if (!is_fold(*crossing.kind)) return true;
    const double value = *crossing.kind == archive::CrossingKind::fold_period ? crossing.period : crossing.level();
    std::multimap<double, Place>& folds = _folds[{crossing.lineage.family, *crossing.kind}];
    const double beside = same_value * (1.0 + std::abs(value));
    const bool is_known =
        std::any_of(folds.lower_bound(value - beside), folds.upper_bound(value + beside), [&](const auto& fold) {
          return std::abs(fold.second.arclength - arclength) <= std::max(fold.second.within, crossing.within);
        });
    if (!is_known) folds.emplace(value, Place{arclength, crossing.within});
    return !is_known;
  }

 private:
  struct Place {
    double arclength;
    double within;
  };
  /// The value at a fold is known to the square of its place, which is located to 1e-10 and seldom open by more than
  /// 1e-5. Not measured.
  static constexpr double same_value = 1e-9;
  std::map<std::pair<std::string, archive::CrossingKind>, std::multimap<double, Place>> _folds;  // by family and kind
};

archive::CrossingRecord row_of(const LocateOutcome& crossing, double arclength, const Units& units) {
  archive::CrossingRecord row;
  row.family_key = crossing.lineage.family;
  row.arclength = arclength;
  row.period = crossing.period * units.time;
  row.energy = crossing.energy * units.energy();
  if (units.in_parameter()) row.parameter = crossing.parameter * units.parameter(0);
  row.kind = *crossing.kind;
  row.multiplicity = crossing.multiplicity;
  row.kernel_dimension = crossing.kernel_dimension;
  row.residual = crossing.residual;
  row.state = crossing.state;
  for (std::size_t i = 0; i < row.state.size(); ++i) row.state[i] *= units.coordinate(i);
  row.sector_j = crossing.j;
  row.sector_q = crossing.q;
  row.fundamental_order = crossing.fundamental_order;
  row.test_value = crossing.test_value;
  row.kernel_residual = crossing.kernel_singular_value;
  row.place_error = crossing.place_error.arclength;
  row.place_error_period = crossing.place_error.period * units.time;
  row.place_error_energy = crossing.place_error.energy * units.energy();
  if (units.in_parameter()) row.place_error_parameter = crossing.place_error.parameter * units.parameter(0);
  return row;
}

/// Relative, of the period and what else moves: far above what locations are off.
constexpr double same_return = 1e-6;

/// Whether the locus passes the crossing where the second parameter has its value again.
bool comes_to(const LocusOutcome& locus, const LocateOutcome& crossing) {
  const auto same = [](double a, double b) { return std::abs(a - b) <= same_return * (std::abs(a) + std::abs(b)); };
  return std::any_of(locus.points.begin(), locus.points.end(), [&](const LocusPointRecord& point) {
    const double level = std::isnan(point.parameter) ? point.energy : point.parameter;
    return point.is_return && same(point.period, crossing.period) && same(level, crossing.level());
  });
}

archive::LocusRecord row_of(const LocusOutcome& locus, const LocusPointRecord& point, const LocateOutcome& born,
                            int row, const Units& units) {
  archive::LocusRecord record;
  record.family_key = born.lineage.family;
  record.crossing = row;
  record.locus = locus.entry;
  record.step = point.step;
  record.arclength = point.arclength;
  record.kind = locus.kind;
  record.period = point.period * units.time;
  record.energy = point.energy * units.energy();
  if (units.in_parameter()) record.parameter = point.parameter * units.parameter(0);
  record.second_parameter = point.second;
  record.second_name = locus.second_name;
  const bool by_sector = archive::has_sector(locus.kind);
  record.sector_j = by_sector ? locus.event.function.sector.j : 0;
  record.sector_q = by_sector ? locus.event.function.sector.q : 1;
  record.fundamental_order = locus.fundamental_order;
  record.state = point.state;
  for (std::size_t i = 0; i < record.state.size(); ++i) record.state[i] *= units.coordinate(i);
  record.note = point.note;
  return record;
}

/// The orbits of another side.
void add_orbits(const BranchOutcome& branch, FamilySummary& summary) {
  const bool first = summary.orbits == 0;
  summary.orbits += branch.orbits;
  summary.period_from = first ? branch.period_from : std::min(summary.period_from, branch.period_from);
  summary.period_to = first ? branch.period_to : std::max(summary.period_to, branch.period_to);
  summary.level_from = first ? branch.level_from : std::min(summary.level_from, branch.level_from);
  summary.level_to = first ? branch.level_to : std::max(summary.level_to, branch.level_to);
}

}  // namespace

std::map<std::string, int> add_crossings(const std::vector<Family>& families,
                                         const std::vector<const LocateOutcome*>& crossings, const Units& units,
                                         TreeTables& tables) {
  const Arclengths arclengths(families);
  std::map<std::string, int> rows;
  FoldsOnce folds;
  for (const LocateOutcome* crossing : crossings) {
    const double arclength = arclengths.of(*crossing);
    if (!folds.is_new(*crossing, arclength)) continue;
    rows[crossing->key] = static_cast<int>(tables.tables.crossings.size());
    tables.tables.crossings.push_back(row_of(*crossing, arclength, units));
  }
  return rows;
}

void add_loci(const std::map<std::string, LocusOutcome>& loci, const Crossings& crossings,
              const std::map<std::string, int>& crossing_rows, const Units& units, TreeTables& tables) {
  std::vector<const LocusOutcome*> kept;
  for (const auto& [key, locus] : loci) {
    const auto row = crossing_rows.find(locus.crossing);
    if (row == crossing_rows.end()) continue;
    const LocateOutcome& born = crossings.at(locus.crossing);
    const bool is_known = std::any_of(kept.begin(), kept.end(), [&](const LocusOutcome* other) {
      return other->entry == locus.entry && other->kind == locus.kind && comes_to(*other, born);
    });
    if (is_known) continue;
    kept.push_back(&locus);
    for (const LocusPointRecord& point : locus.points)
      tables.tables.loci.push_back(row_of(locus, point, born, row->second, units));
  }
}

void add_families(const std::vector<Family>& families, const Crossings& crossings,
                  const std::map<std::string, int>& crossing_rows, const Units& units,
                  const std::function<const Meeting*(const std::string&)>& arrival, TreeTables& tables) {
  const std::map<std::string, std::string> names = names_by_key(families);
  for (const Family& family : families) {
    archive::FamilyRecord record;
    FamilySummary summary;
    record.key = summary.key = family.key;
    record.name = summary.name = family.name;
    record.multiplicity = family.lineage.multiplicity;
    record.isotropy = summary.isotropy = loop::to_text(family.sides.front()->second.isotropy);
    if (family.lineage.depth > 0) {
      const LocateOutcome& born = crossings.at(family.lineage.crossing);
      record.parent_key = born.lineage.family;
      record.crossing = crossing_rows.at(born.key);
      record.birth_arclength = family.birth;
    }
    summary.depth = family.lineage.depth;
    for (const FamilySide entry : family.sides) {
      const auto& [key, side] = *entry;
      std::string reason = side.outcome ? end_text(*side.outcome, units) : failure_text(side.reason);
      if (const Meeting* meeting = arrival(key)) {
        const LocateOutcome& met = crossings.at(meeting->crossing);
        const auto row = crossing_rows.find(met.key);
        const auto name = names.find(met.lineage.family);
        if (row != crossing_rows.end() && name != names.end()) {
          record.end_family_key = met.lineage.family;
          record.end_crossing = row->second;
          reason = joined_text(name->second, met, units);
        }
      }
      record.end_reason = record.end_reason.empty() ? reason : both_ends_text(record.end_reason, reason);
      summary.failed = summary.failed || side.failed;
      if (side.outcome && side.outcome->orbits > 0) add_orbits(*side.outcome, summary);
    }
    if (family.sides.size() == 1) {  // of a family with two sides the other one may have been run as well
      if (family.lineage.side < 0) record.last_step = -1;
      if (family.lineage.side > 0) record.first_step = 0;
    }
    record.end_reason = summary.end_reason = limited(record.end_reason);
    tables.tables.families.push_back(std::move(record));
    tables.families.push_back(std::move(summary));
  }
}

}  // namespace orbweaver::survey
