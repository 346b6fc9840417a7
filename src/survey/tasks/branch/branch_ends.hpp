#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "orbweaver/bifurcation/symmetry_watch.hpp"
#include "orbweaver/continuation/family_curve.hpp"
#include "orbweaver/continuation/orbit.hpp"
#include "tasks/arrival.hpp"
#include "tasks/branch/branch_events.hpp"
#include "tasks/branch/followed_branch.hpp"

namespace orbweaver::survey {

/// First orbits from which, with the one where the family is born, those in between are predicted: a cubic.
inline constexpr std::size_t orbits_from_birth = 3;

/// The events at both ends of a branch, which neighbouring orbits do not show.
class BranchEnds {
 public:
  BranchEnds(FollowedBranch& followed, BranchEvents& events, const bifurcation::SymmetryWatch& symmetry)
      : _followed(followed), _events(events), _symmetry(symmetry) {}

  /// Between birth and first orbits. `arrival`: where the branch has met another family already.
  void look_before_first(const std::optional<Arrival>& arrival);
  /// Folds that no orbit behind the last one shows; on the way from there to a meeting zeros of test functions too.
  /// Returns the orbits on that way that are the family's, in their order.
  [[nodiscard]] std::vector<continuation::Orbit> look_behind_last(const std::optional<Arrival>& arrival);

 private:
  void detect_from_birth(const std::optional<Arrival>& arrival);
  /// `curve`: of the birth and the first orbits.
  void indices_from_birth(continuation::FamilyCurve& curve);
  void folds_from_birth(continuation::FamilyCurve& curve);
  void add_beyond_zeros(continuation::FamilyCurve& curve, double birth,
                        std::vector<continuation::CurvePoint>& places) const;
  void folds_at_start();
  void zeros_at_start();
  void add_behind(std::vector<continuation::CurvePoint>& places);
  void add_orbits(const std::vector<continuation::CurvePoint>& places, double to,
                  std::vector<continuation::Orbit>& orbits) const;
  [[nodiscard]] std::vector<continuation::Orbit> orbits_to_zeros(const std::vector<continuation::CurvePoint>& places);

  FollowedBranch& _followed;
  BranchEvents& _events;
  const bifurcation::SymmetryWatch& _symmetry;
};

}  // namespace orbweaver::survey
