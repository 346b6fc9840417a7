#include "witness/checks.hpp"

#include "witness/checks/base_births.hpp"
#include "witness/checks/branch_counts.hpp"
#include "witness/checks/certificates.hpp"
#include "witness/checks/ends.hpp"
#include "witness/checks/equilibrium_branches.hpp"
#include "witness/checks/equilibrium_families.hpp"
#include "witness/checks/failed_tasks.hpp"
#include "witness/checks/index_changes.hpp"
#include "witness/checks/mirror_images.hpp"
#include "witness/checks/open_places.hpp"
#include "witness/checks/shared_points.hpp"
#include "witness/checks/stored_twice.hpp"

namespace orbweaver::survey {

namespace {

template <class... Checks>
std::vector<std::unique_ptr<Check>> list() {
  std::vector<std::unique_ptr<Check>> checks;
  (checks.push_back(std::make_unique<Checks>()), ...);
  return checks;
}

}  // namespace

std::vector<std::unique_ptr<Check>> all_checks() {
  return list<FailedTasks, StoredTwice, SharedPoints, BranchCounts, EquilibriumBranches, EquilibriumFamilies,
              BaseBirths, Ends, MirrorImages, OpenPlaces, IndexChanges, Certificates>();
}

}  // namespace orbweaver::survey
