#include "born_orbit.hpp"

#include <cmath>
#include <span>

#include "orbweaver/core/error.hpp"
#include "orbweaver/loop/curve/measures.hpp"
#include "orbweaver/loss/slice.hpp"
#include "orbweaver/loss/unknowns.hpp"

namespace orbweaver::bifurcation {

namespace {

constexpr int most_raises = 4;  // to 2 or 4 times the base's harmonics: orbits near it need no more

corrector::Result correct_held(const systems::System& system, const loop::Loop& guess,
                               const std::vector<loop::Tangent>& held, const std::vector<loss::Scalar>& scalars,
                               const loop::Isotropy& isotropy, const corrector::Options& options) {
  const loss::Unknowns unknowns{loop::Subspace(guess.dimension, guess.cutoff, isotropy), scalars};
  const auto count = static_cast<Eigen::Index>(held.size());
  Eigen::MatrixXd conditions = Eigen::MatrixXd::Zero(unknowns.size(), count + 1);
  for (Eigen::Index c = 0; c < count; ++c) {
    const std::vector<double> pinned = unknowns.coordinates_of({held[static_cast<std::size_t>(c)].modes, {}});
    conditions.col(c) = Eigen::Map<const Eigen::VectorXd>(pinned.data(), unknowns.size());  // T is free
  }
  // About an equilibrium only the small oscillation itself has a phase.
  const std::vector<double> shift = unknowns.time_shift_direction(guess);
  conditions.col(count) = Eigen::Map<const Eigen::VectorXd>(shift.data(), unknowns.size());
  const double length = conditions.col(count).norm();
  if (length < loss::Unknowns::least_time_shift * loop::rms_amplitude(guess))
    conditions.conservativeResize(Eigen::NoChange, count);
  else
    conditions.col(count) /= length;
  return corrector::correct(system, guess, unknowns, loss::Slice(unknowns.size(), conditions), options);
}

loop::Loop projected(const loop::Loop& base, const loop::Tangent& along, const loop::Isotropy& isotropy,
                     double amplitude) {
  const loss::Unknowns unknowns{loop::Subspace(base.dimension, base.cutoff, isotropy), {loss::Scalar::period()}};
  const std::vector<double> pinned = unknowns.coordinates_of({along.modes, {}});
  const Eigen::VectorXd move = amplitude * Eigen::Map<const Eigen::VectorXd>(pinned.data(), unknowns.size());
  return unknowns.moved(base, {move.data(), static_cast<std::size_t>(move.size())});
}

}  // namespace

corrector::Result born_orbit(const systems::System& system, const loop::Loop& base, const loop::Tangent& along,
                             const loop::Isotropy& isotropy, double amplitude, const corrector::Options& options) {
  core::require(along.modes.size() == base.modes.size(), "a direction needs the size of its base loop's modes");
  loop::Loop from = base;
  loop::Tangent direction = along;
  for (int raises = 0;; ++raises) {
    corrector::Result result = correct_held(system, projected(from, direction, isotropy, amplitude), {direction},
                                            {loss::Scalar::period()}, isotropy, options);
    if (result.outcome != corrector::Outcome::under_resolved || raises == most_raises) return result;
    from = loop::with_cutoff(base, loop::next_cutoff(from.cutoff));
    direction = loop::with_cutoff(std::move(direction), from.cutoff, from.dimension);
  }
}

corrector::Result held_orbit(const systems::System& system, const loop::Loop& guess,
                             const std::vector<loop::Tangent>& held, std::vector<loss::Scalar> scalars,
                             const loop::Isotropy& isotropy, const corrector::Options& options) {
  scalars.insert(scalars.begin(), loss::Scalar::period());
  loop::Loop from = guess;
  for (int raises = 0;; ++raises) {
    std::vector<loop::Tangent> here;
    for (const loop::Tangent& t : held) here.push_back(loop::with_cutoff(t, from.cutoff, from.dimension));
    corrector::Result result = correct_held(system, from, here, scalars, isotropy, options);
    if (result.outcome != corrector::Outcome::under_resolved || raises == most_raises) return result;
    from = loop::with_cutoff(guess, loop::next_cutoff(from.cutoff));
  }
}

}  // namespace orbweaver::bifurcation
