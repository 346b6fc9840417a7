#include <cmath>
#include <span>

#include "orbweaver/bifurcation/directions.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/loss/slice.hpp"
#include "orbweaver/loss/unknowns.hpp"

namespace orbweaver::bifurcation {

namespace {

corrector::Result correct_pinned(const systems::System& system, const loop::Loop& base,
                                 const std::vector<double>& modes, const loop::Isotropy& isotropy, double amplitude,
                                 const corrector::Options& options) {
  const loss::Unknowns unknowns{loop::Subspace(base.dimension, base.cutoff, isotropy), true};
  Eigen::MatrixXd conditions = Eigen::MatrixXd::Zero(unknowns.size(), 2);
  unknowns.subspace.project(modes,
                            std::span(conditions.col(0).data(), static_cast<std::size_t>(unknowns.subspace.size())));
  const Eigen::VectorXd move = amplitude * conditions.col(0);
  const loop::Loop guess = unknowns.moved(base, {move.data(), static_cast<std::size_t>(move.size())});
  // About an equilibrium only the small oscillation itself has a phase.
  const std::vector<double> shift = unknowns.time_shift_direction(guess);
  conditions.col(1) = Eigen::Map<const Eigen::VectorXd>(shift.data(), unknowns.size());
  const double length = conditions.col(1).norm();
  if (length < 1e-8 * loop::rms_amplitude(guess))
    conditions.conservativeResize(Eigen::NoChange, 1);
  else
    conditions.col(1) /= length;
  return corrector::correct(system, guess, unknowns, loss::Slice(unknowns.size(), conditions), options);
}

}  // namespace

corrector::Result born_orbit(const systems::System& system, const loop::Loop& base, const std::vector<double>& modes,
                             const loop::Isotropy& isotropy, double amplitude, const corrector::Options& options) {
  constexpr int most_raises = 4;
  core::require(modes.size() == base.modes.size(), "a direction needs the size of its base loop's modes");
  loop::Loop from = base;
  std::vector<double> direction = modes;
  for (int raises = 0;; ++raises) {
    corrector::Result result = correct_pinned(system, from, direction, isotropy, amplitude, options);
    if (result.outcome != corrector::Outcome::under_resolved || raises == most_raises) return result;
    from = loop::with_cutoff(base, loop::next_cutoff(from.cutoff));
    direction.resize(from.modes.size(), 0.0);
  }
}

}  // namespace orbweaver::bifurcation
