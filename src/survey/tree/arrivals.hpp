#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "branch_graph.hpp"
#include "orbweaver/systems/structure.hpp"
#include "tasks/payload/work.hpp"

namespace orbweaver::survey {

/// Whether the period and energy where a branch arrived are those of what is born at the crossing, as far as
/// extrapolation along the branch goes. Where nothing is conserved the energies are NaN, and the period decides alone.
[[nodiscard]] bool within_window(const ArrivalRecord& arrival, const LocateOutcome& crossing);

/// Finds the crossings where branches have arrived, and the directions along which they came: by period and energy
/// first, then by loops. What is compared with what depends on neither order nor time; every pair that comes close is
/// compared once, when the second of them is added, and found among the others by period.
class Arrivals {
 public:
  explicit Arrivals(const systems::Structure& system) : _system(system) {}

  /// A branch has arrived somewhere: the crossings known so far where it may be.
  std::vector<Meeting> add_branch(const std::string& key, ArrivalRecord arrival);
  /// Directions leave a crossing: branches known so far that may have come along one, by key.
  std::vector<std::pair<std::string, Meeting>> add_crossing(const LocateOutcome& crossing);
  /// True where period and energy agree, and the orbit that the branch has arrived at is another than the crossing's.
  [[nodiscard]] bool are_apart(const std::string& branch, const std::string& crossing) const {
    return _apart.contains({branch, crossing});
  }

 private:
  struct Arrived {
    std::string key;
    ArrivalRecord at;
  };
  /// The nearest direction of the crossing, if any is near.
  [[nodiscard]] std::optional<Meeting> meeting(const ArrivalRecord& arrival, const LocateOutcome& crossing) const;
  /// Of the directions at a crossing the nearest to that in which an orbit of the branch lies, if it is near enough.
  [[nodiscard]] std::optional<Meeting> met_by(const loop::Loop& near, const LocateOutcome& crossing) const;

  void compare(const std::string& branch, const ArrivalRecord& arrival, const LocateOutcome& crossing);

  const systems::Structure& _system;
  std::set<std::pair<std::string, std::string>> _apart;  // a branch, a crossing
  std::multimap<double, Arrived> _arrived;               // by the period where they meet
  std::multimap<double, LocateOutcome> _crossings;       // by the period of the born orbits
};

}  // namespace orbweaver::survey
