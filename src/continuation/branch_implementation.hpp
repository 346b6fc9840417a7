#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "orbweaver/continuation/branch.hpp"

namespace orbweaver::continuation {

/// What the ways to follow a branch share: where it stands, its limits and its ends.
struct Branch::Implementation {
  Implementation(std::shared_ptr<const systems::System> of, Start from, Options with)
      : system(std::move(of)), start(std::move(from)), options(std::move(with)) {}
  virtual ~Implementation() = default;
  Implementation(const Implementation&) = delete;
  Implementation& operator=(const Implementation&) = delete;

  std::shared_ptr<const systems::System> system;
  Start start;
  Options options;
  Frontier frontier{};
  std::optional<Ending> ending{};

  std::optional<Orbit> advance() {
    if (ending) return std::nullopt;
    if (!begun()) return first_orbit();
    ending = end_at(frontier.orbit);
    return ending ? std::nullopt : next_on_family();
  }

  /// Sets the frontier's tangent if it is not known yet.
  virtual void complete_frontier() {}

  [[nodiscard]] bool begun() const { return !here().modes.empty(); }
  [[nodiscard]] const loop::Loop& here() const { return frontier.orbit.loop; }

 protected:
  virtual std::optional<Orbit> first_orbit() = 0;
  /// With a step of at most this length.
  virtual std::optional<Orbit> next_orbit(double at_most) = 0;
  /// Drops what has been made for a frontier that is replaced.
  virtual void forget() {}

  /// Ends the branch; a cutoff limit of a settled family is a divergence of the period.
  std::optional<Orbit> end(EndReason reason, std::string detail);
  /// The end where the first orbit lies beyond the scene's limits already; none if it does not.
  [[nodiscard]] std::optional<Ending> beyond_limits(double period, double energy) const;
  /// Makes `orbit`, whose loop and numbers are set, the frontier's; `increment`: arclength from the one before.
  void keep(Orbit& orbit, double increment, double amplitude);

 private:
  std::optional<Orbit> next_on_family();
  [[nodiscard]] std::optional<Ending> end_at(const Orbit& orbit) const;
  [[nodiscard]] bool period_diverges() const;
};

/// Any subspace, any corrector: one tangent, orbits corrected as loops.
[[nodiscard]] std::unique_ptr<Branch::Implementation> make_loop_branch(std::shared_ptr<const systems::System> system,
                                                                       const Start& start, const Options& options);

/// By collocation on the fundamental domain with a polynomial through the last orbits (the fast way). Null where the
/// equations there are not square.
[[nodiscard]] std::unique_ptr<Branch::Implementation> make_collocation_branch(
    std::shared_ptr<const systems::System> system, const Start& start, const Options& options);

}  // namespace orbweaver::continuation
