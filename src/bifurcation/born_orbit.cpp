#include "born_orbit.hpp"

#include <cmath>
#include <span>

#include "orbweaver/core/error.hpp"
#include "orbweaver/loop/curve/measures.hpp"
#include "orbweaver/loss/slice.hpp"
#include "orbweaver/loss/unknowns.hpp"

namespace orbweaver::bifurcation {

namespace {

corrector::Result correct_pinned(const systems::System& system, const loop::Loop& base, const loop::Tangent& along,
                                 const loop::Isotropy& isotropy, double amplitude, const corrector::Options& options) {
  const loss::Unknowns unknowns{loop::Subspace(base.dimension, base.cutoff, isotropy), {loss::Scalar::period()}};
  Eigen::MatrixXd conditions = Eigen::MatrixXd::Zero(unknowns.size(), 2);
  const std::vector<double> pinned = unknowns.coordinates_of({along.modes, {}});  // T is free
  conditions.col(0) = Eigen::Map<const Eigen::VectorXd>(pinned.data(), unknowns.size());
  const Eigen::VectorXd move = amplitude * conditions.col(0);
  const loop::Loop guess = unknowns.moved(base, {move.data(), static_cast<std::size_t>(move.size())});
  // About an equilibrium only the small oscillation itself has a phase.
  const std::vector<double> shift = unknowns.time_shift_direction(guess);
  conditions.col(1) = Eigen::Map<const Eigen::VectorXd>(shift.data(), unknowns.size());
  const double length = conditions.col(1).norm();
  if (length < loss::Unknowns::least_time_shift * loop::rms_amplitude(guess))
    conditions.conservativeResize(Eigen::NoChange, 1);
  else
    conditions.col(1) /= length;
  return corrector::correct(system, guess, unknowns, loss::Slice(unknowns.size(), conditions), options);
}

}  // namespace

corrector::Result born_orbit(const systems::System& system, const loop::Loop& base, const loop::Tangent& along,
                             const loop::Isotropy& isotropy, double amplitude, const corrector::Options& options) {
  constexpr int most_raises = 4;  // to 2 or 4 times the base's harmonics: orbits near it need no more
  core::require(along.modes.size() == base.modes.size(), "a direction needs the size of its base loop's modes");
  loop::Loop from = base;
  loop::Tangent direction = along;
  for (int raises = 0;; ++raises) {
    corrector::Result result = correct_pinned(system, from, direction, isotropy, amplitude, options);
    if (result.outcome != corrector::Outcome::under_resolved || raises == most_raises) return result;
    from = loop::with_cutoff(base, loop::next_cutoff(from.cutoff));
    direction = loop::with_cutoff(std::move(direction), from.cutoff, from.dimension);
  }
}

}  // namespace orbweaver::bifurcation
