#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "branch_graph.hpp"
#include "family.hpp"
#include "orbweaver/archive/schema/records.hpp"
#include "orbweaver/survey/run/survey.hpp"
#include "orbweaver/systems/structure.hpp"
#include "tasks/units.hpp"
#include "tree_evidence.hpp"

namespace orbweaver::survey {

/// Rows of the archive and of the summary, in the units of the scene: `units` are those of the outcomes' numbers.
struct TreeTables {
  archive::Records tables;              ///< families and crossings, and what of the rows does not belong to them
  std::vector<FamilySummary> families;  ///< parents before children
  std::vector<std::string> failures;    ///< name and reason
  std::vector<std::string> remarks;
  std::map<std::string, std::string> names{};  ///< of families by key
  TreeEvidence evidence;  ///< for the witness
};

/// Adds a row for every crossing (they lie on `families`) but for the second of two at one fold. Returns the rows by
/// key.
[[nodiscard]] std::map<std::string, int> add_crossings(const std::vector<Family>& families,
                                                       const std::vector<const LocateOutcome*>& crossings,
                                                       const Units& units, TreeTables& tables);

/// Adds the points of the loci that begin at crossings with rows. One that has come back to where another begins is the
/// same curve: of these the one from the first crossing stays.
void add_loci(const std::map<std::string, LocusOutcome>& loci, const Crossings& crossings,
              const std::map<std::string, int>& crossing_rows, const Units& units, TreeTables& tables);

/// Adds a row for every family. `arrival` says where the branch with a key has arrived; null if nowhere.
void add_families(const std::vector<Family>& families, const Crossings& crossings,
                  const std::map<std::string, int>& crossing_rows, const Units& units,
                  const std::function<const Meeting*(const std::string&)>& arrival, TreeTables& tables);

}  // namespace orbweaver::survey
