#pragma once

#include <optional>

#include "orbweaver/bifurcation/detector.hpp"
#include "orbweaver/continuation/orbit.hpp"
#include "orbweaver/loop/curve/loop.hpp"
#include "tasks/branch/followed_branch.hpp"

namespace orbweaver::survey {

/// Whether the first orbit of a family that begins at an equilibrium is near enough to it.
class FirstOrbit {
 public:
  explicit FirstOrbit(FollowedBranch& followed) : _followed(followed) {}

  /// Whether, between the equilibrium and the first orbit, lies what the survey looks for.
  [[nodiscard]] bool is_too_far(const continuation::Orbit& first);

 private:
  bool passes_index(const loop::Loop& small, const continuation::Orbit& first);
  [[nodiscard]] bool has_requested(const continuation::Orbit& first) const;
  [[nodiscard]] bool has_turned(const loop::Loop& small, const continuation::Orbit& first) const;

  FollowedBranch& _followed;
  std::optional<bifurcation::TestPoint> _at_rest;  // of an oscillation that is next to nothing
};

}  // namespace orbweaver::survey
