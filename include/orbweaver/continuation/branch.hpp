#pragma once

#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include <Eigen/Dense>

#include "orbweaver/continuation/ending.hpp"
#include "orbweaver/continuation/frontier.hpp"
#include "orbweaver/continuation/orbit.hpp"
#include "orbweaver/corrector/correct.hpp"
#include "orbweaver/loop/curve/tangent.hpp"
#include "orbweaver/loop/symmetry/isotropy.hpp"

namespace orbweaver::continuation {

/// How the next orbit of a branch is predicted.
enum class Predictor {
  polynomial,  ///< through the last orbits
  tangent,     ///< along the family's own direction, as in the paper
};

/// How to step along a branch and where to stop.
struct Options {
  corrector::Options corrector{};
  int cutoff_from = 8;
  int cutoff_to = 4096;
  /// Lengths at s = 0 are in the coordinates' units, radians where the system has angles.
  std::optional<double> fixed_step{};  ///< |dz(s = 0)| of every step (paper: 0.5 degrees); none = adaptive
  double start_amplitude = 8.7e-3;     ///< |dz(s = 0)| of the first orbit (paper: 0.5 degrees)
  /// Last harmonics, relative to min(1, rms amplitude): above it K is raised. Harmonic k weighs 2 pi k/T times in the
  /// residual, hence two digits below `corrector.tolerance`.
  double tail_tolerance = 1e-12;
  double largest_step = 1.0;  ///< in the length in which the corrector measures steps (docs/mathematics.md)
  /// Times (1 + amplitude) min(1, amplitude); below it the branch has failed. Sharper bends than that are crossings to
  /// double precision (docs/mathematics.md, "Families that nearly cross").
  double smallest_step = 1e-9;
  /// Cosine of the largest angle (60 degrees) that a step makes with the family's direction at its ends, its prediction
  /// and the last step: what turns further has left the family, unless a shorter step shows otherwise. Not measured.
  double least_cosine = 0.5;
  bool fit_time_map = true;     ///< let s run with the orbit's speed where that needs fewer harmonics
  int general_map_cells = 800;  ///< from which a general time map repays its fit (docs/performance.md)
  Predictor predictor = Predictor::polynomial;
  int predictor_order = 4;  ///< of the polynomial through the last orbits, at most
  /// Wanted largest error of a predicted coordinate, radians. Ten times more makes steps of degree 4 1.6 times longer.
  double prediction_error = 3e-3;
  double period_limit = std::numeric_limits<double>::infinity();
  double energy_from = -std::numeric_limits<double>::infinity();
  double energy_to = std::numeric_limits<double>::infinity();
  double parameter_from =
      -std::numeric_limits<double>::infinity();  ///< of the first parameter that moves, in its scale
  double parameter_to = std::numeric_limits<double>::infinity();
  /// Least values of the system's guards, by name: Branch throws MisuseError for one that it does not have.
  std::map<std::string, double> guard_limits{};
  int step_limit = 5000;             ///< orbits of the branch
  bool off_branch_spectrum = false;  ///< the paper's minimum off-branch eigenvalue at every orbit
  /// Whether a step has gone over to another family, which nothing but the two orbits may decide. Then a shorter one is
  /// tried: families that pass one another at a distance below `prediction_error` look like one to the corrector.
  std::function<bool(const Orbit& from, const Orbit& to)> jumped{};
  /// Whether the first orbit is so far from the start that something may lie in between, which nothing but the orbit
  /// may decide. Then a nearer one is taken, down to 1e-6 of `start_amplitude` or as near as rounding allows.
  std::function<bool(const Orbit& first)> too_far{};
  /// The start is a guess that may be far from any orbit: where the corrector fails, it is brought nearer by damped
  /// steps of Newton's method first (collocation only).
  bool base_is_far = false;
  double smallest_jump = 1e-7;  ///< steps below this arclength are not asked: families as near as that cross
};

/// A place to start from: a known loop (a fixed point as a constant loop, or an orbit) and a direction in which loops
/// near it are orbits. The isotropy is that of the born orbits and holds for the base loop as well.
struct Start {
  loop::Loop base;
  loop::Tangent direction;  ///< of any length > 0
  loop::Isotropy isotropy;
  /// `base` is (nearly) an orbit of the family and its first one, with the scalar held along which `direction` points:
  /// its modes are 0.
  bool base_is_orbit = false;
  int times = 1;  ///< the base goes so often around the orbit at which the family is born
};

class Tracer;

/// One family, traced orbit by orbit in the subspace of its isotropy (paper, section III B).
class Branch {
 public:
  /// Throws MisuseError for a start whose sizes disagree or whose direction is zero.
  Branch(std::shared_ptr<const systems::System> system, const Start& start, Options options);
  /// Goes on from where a branch with the same start was: `from` is its `restart_frontier` after some orbit. Further
  /// orbits have the same bits; limits may be wider.
  Branch(std::shared_ptr<const systems::System> system, const Start& start, Options options, Frontier from);
  ~Branch();
  Branch(Branch&&) noexcept;
  Branch& operator=(Branch&&) noexcept;
  Branch(const Branch&) = delete;
  Branch& operator=(const Branch&) = delete;

  /// The next accepted orbit (the first call gives orbit 0), or none when the branch has ended.
  [[nodiscard]] std::optional<Orbit> advance();
  /// Set once `advance` has returned none.
  [[nodiscard]] const std::optional<Ending>& ending() const;
  /// Where the branch is (after at least one orbit).
  [[nodiscard]] const Frontier& frontier();
  /// The same without a tangent that no step has needed yet: for checkpoints.
  [[nodiscard]] const Frontier& restart_frontier() const;
  /// Whether a step that the last `advance` tried led beyond a limit. It may have been taken back since, and what was
  /// tried after it depends on the limit all the same.
  [[nodiscard]] bool met_limit() const;

 private:
  std::unique_ptr<Tracer> _tracer;
};

/// Called after each orbit; false stops the branch.
using Observer = std::function<bool(const Orbit&)>;

/// Follows a branch to its end.
[[nodiscard]] Ending trace(std::shared_ptr<const systems::System> system, const Start& start, const Options& options,
                           const Observer& observer);

/// The orbit of the family through `near` that has exactly the period `period`, starting the correction from `near`.
[[nodiscard]] corrector::Result orbit_at_period(const systems::System& system, const loop::Loop& near,
                                                const loop::Isotropy& isotropy, double period, const Options& options);

}  // namespace orbweaver::continuation
