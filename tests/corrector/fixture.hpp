#pragma once

#include <cmath>
#include <memory>
#include <random>
#include <span>
#include <vector>

#include "orbweaver/corrector/correct.hpp"
#include "orbweaver/loop/curve/measures.hpp"
#include "orbweaver/loss/assembled.hpp"
#include "orbweaver/spectrum/singular_triplets.hpp"
#include "orbweaver/systems/registry.hpp"
#include "spectrum/pendulum_loops.hpp"

namespace orbweaver::test {

inline Eigen::VectorXd to_vector(const std::vector<double>& values) {
  return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

/// A pendulum loop to correct, in the symmetric subspace, held orthogonal to its own growth.
struct Problem {
  Problem(const PendulumMode& mode, double amplitude, int cutoff)
      : guess(linear_loop(mode, amplitude, cutoff)),
        unknowns{loop::Subspace(4, cutoff, pendulum_isotropy(*system)), {loss::Scalar::period()}} {
    const loop::Loop base = loop::constant_loop(mode.point, guess.period, cutoff);
    normal = to_vector(unknowns.difference(base, guess)).normalized();
  }

  /// The guess with the period and every coefficient of the subspace moved by up to `share` of the loop's size; the
  /// noise falls off with the harmonic as the modes of smooth loops do. It stays in the slice through the guess, so
  /// that all noisy guesses belong to one orbit.
  [[nodiscard]] loop::Loop noisy(double share, unsigned seed) const {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> uniform(-share, share);
    std::vector<double> u(static_cast<std::size_t>(unknowns.size()));
    for (int n = 0; n < unknowns.subspace.size(); ++n)
      u[static_cast<std::size_t>(n)] =
          uniform(random) * loop::rms_amplitude(guess) * std::pow(0.5, unknowns.subspace.harmonic(n) - 1);
    u.back() = uniform(random) * guess.period;
    Eigen::VectorXd in_slice = to_vector(u);
    in_slice -= normal.dot(in_slice) * normal;
    return unknowns.moved(guess, std::span<const double>(in_slice.data(), u.size()));
  }

  [[nodiscard]] loss::Slice slice() const { return {unknowns.size(), normal}; }

  [[nodiscard]] corrector::Result correct(const loop::Loop& from, const corrector::Options& options = {}) const {
    return corrector::correct(*system, from, unknowns, slice(), options, normal);
  }

  /// How far a loop of the slice with this sqrt(loss) can be from the orbit: rms / smallest singular value of J.
  [[nodiscard]] double distance_bound(const loop::Loop& orbit, double loss_rms) const {
    const loss::Linearization linearization(*system, orbit, loss::Linearization::Order::jacobian);
    const auto reduced = slice().reduce_columns(loss::assemble_jacobian(linearization, unknowns));
    return loss_rms / spectrum::smallest_singular_triplets(reduced, 1).values.front();
  }

  [[nodiscard]] double distance(const loop::Loop& a, const loop::Loop& b) const {
    return to_vector(unknowns.difference(a, b)).norm();
  }

  std::shared_ptr<const systems::System> system = systems::make_system("double_pendulum");
  loop::Loop guess;
  loss::Unknowns unknowns;
  Eigen::VectorXd normal;
};

}  // namespace orbweaver::test
