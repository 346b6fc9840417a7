#include "orbweaver/starts/sweep.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <string_view>

#include <fmt/format.h>

#include "linear_modes.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/core/log/log_stage.hpp"
#include "orbweaver/loss/assembled.hpp"
#include "orbweaver/loss/linearization.hpp"
#include "orbweaver/spectrum/eigenpairs.hpp"

namespace orbweaver::starts {

namespace {

constexpr std::string_view no_zero =
    "a dip that does not reach zero, or zeros too close together to tell apart: no family starts here";

/// Kernel vectors of unit length come out of an SVD: their entries, and equations between them, hold to rounding times
/// the inverse of the gap to the next singular value. What is larger is seen, what is smaller is taken for zero.
constexpr double negligible_entry = 1e-9;
constexpr double reversible = 1e-8;
/// Roots of neighbouring dips that are nearer, relative to the period, are one: brackets overlap, roots are right to
/// rounding.
constexpr double same_root = 1e-9;
/// Rounding of the ends of a range of periods, relative to them.
constexpr double at_range_end = 1e-12;

struct Sample {
  SweepPoint point;
  int harmonic;  // the one that carries the smallest eigenvector
};

Sample sample(const systems::System& system, std::span<const double> fixed_point, double period, int cutoff) {
  const loop::Loop loop = loop::constant_loop(fixed_point, period, cutoff);
  const loss::Linearization linearization(system, loop, loss::Linearization::Order::jacobian);
  const loss::Unknowns unknowns{loop::Subspace::unrestricted(loop.dimension, cutoff), {}};
  const spectrum::Eigenpairs pairs = spectrum::smallest_eigenpairs(
      loss::assemble_hessian(linearization, unknowns, loss::Curvature::gauss_newton), {.count = 1});
  std::vector<double> weight(static_cast<std::size_t>(cutoff) + 1, 0.0);
  for (int n = 0; n < unknowns.subspace.size(); ++n)
    weight[static_cast<std::size_t>(unknowns.subspace.harmonic(n))] += pairs.vectors(n, 0) * pairs.vectors(n, 0);
  const auto strongest = std::max_element(weight.begin(), weight.end());
  return {{period, pairs.values.front()}, static_cast<int>(strongest - weight.begin())};
}

// A phase e^{i alpha} of the mode v so that s = 0 lies on the fixed set of the system's first reversor that the mode
// has, else at the largest first coordinate; the sign so that the first coordinate that moves does so upwards.
Eigen::VectorXcd with_standard_phase(const systems::Structure& system, Eigen::VectorXcd v) {
  v.normalize();
  for (const systems::Symmetry& r : system.reversors) {
    const Eigen::VectorXcd image = r.map.matrix.cast<std::complex<double>>() * v.conjugate();
    const std::complex<double> phase = v.dot(image);  // image = phase * v if the mode is reversible
    if (std::abs(std::abs(phase) - 1.0) > negligible_entry || (image - phase * v).norm() > reversible) continue;
    v *= std::sqrt(phase);
    for (const std::complex<double>& c : v)
      if (std::abs(c.real()) > negligible_entry) return c.real() > 0.0 ? v : Eigen::VectorXcd(-v);
  }
  for (const std::complex<double>& c : v)
    if (std::abs(c) > negligible_entry) return v * (std::conj(c) / std::abs(c));
  return v;
}

// z = Re(v e^{is}) as modes, scaled to |dz(s = 0)| = 1.
loop::Tangent direction_of(const Eigen::VectorXcd& v, int cutoff) {
  loop::Loop loop = loop::constant_loop(std::vector<double>(static_cast<std::size_t>(v.size()), 0.0), 1.0, cutoff);
  const double scale = v.real().norm() > still_at_start ? 1.0 / v.real().norm() : 1.0;
  for (int i = 0; i < loop.dimension; ++i) {
    loop.cosine(1, i) = scale * v(i).real();
    loop.sine(1, i) = -scale * v(i).imag();
  }
  return {loop.modes, {}};
}

loop::Isotropy isotropy_of(const systems::Structure& system, std::span<const double> fixed_point, double period,
                           const loop::Tangent& direction, int cutoff) {
  const loop::Loop loop = loop::moved(loop::constant_loop(fixed_point, period, cutoff), direction, 1.0);
  return loop::find_isotropy(system, loop, loop::symmetry_tolerance);
}

NormalMode normal_mode(const systems::System& system, std::span<const double> fixed_point, const LinearModes& linear,
                       const LinearModes::Root& root, double grid_period, int cutoff) {
  const systems::Structure& structure = system.structure();
  NormalMode mode;
  mode.period = root.period;
  mode.grid_period = grid_period;
  mode.residual = root.residual;
  mode.direction = direction_of(with_standard_phase(structure, root.kernel.col(0)), cutoff);
  mode.grid_direction =
      direction_of(with_standard_phase(structure, linear.smallest_right_singular_vector(1, grid_period)), cutoff);
  mode.isotropy = isotropy_of(structure, fixed_point, mode.period, mode.direction, cutoff);
  return mode;
}

}  // namespace

SweepResult sweep(const systems::System& system, std::span<const double> fixed_point, const SweepOptions& options) {
  const core::LogStage stage(core::Stage::sweep);
  core::require(options.step > 0.0 && options.period_from > 0.0 && options.period_to > options.period_from,
                "a sweep needs 0 < period_from < period_to and a positive step");
  SweepResult result;
  result.fixed_point.assign(fixed_point.begin(), fixed_point.end());
  const LinearModes linear(system, fixed_point);

  const auto last =
      static_cast<int>(std::floor((options.period_to - options.period_from) / options.step * (1.0 + at_range_end)));
  // One sample beyond each end, so that a dip at an end is seen; only roots within the range count.
  const int first = options.period_from > options.step ? -1 : 0;
  std::vector<Sample> samples;
  for (int n = first; n <= last + 1; ++n)
    samples.push_back(sample(system, fixed_point, options.period_from + n * options.step, options.cutoff));
  for (int n = 0; n <= last; ++n) result.table.push_back(samples[static_cast<std::size_t>(n - first)].point);

  std::vector<std::vector<double>> known(static_cast<std::size_t>(options.cutoff) + 1);
  for (std::size_t n = 1; n + 1 < samples.size(); ++n) {
    const SweepPoint& here = samples[n].point;
    const double low = samples[n - 1].point.period;
    const double high = samples[n + 1].point.period;
    if (!(here.eigenvalue < samples[n - 1].point.eigenvalue && here.eigenvalue <= samples[n + 1].point.eigenvalue))
      continue;
    bool reaches_zero = false;
    // All harmonics, not only that of the smallest eigenvalue: dips that lie closer together than a step show as one.
    for (int k = 1; k <= options.cutoff; ++k)
      for (const LinearModes::Root& root : linear.roots(k, low, here.period, high)) {
        reaches_zero = true;
        std::vector<double>& found = known[static_cast<std::size_t>(k)];
        const auto is_same = [&](double period) { return std::abs(root.period - period) < same_root * period; };
        const bool outside = root.period < options.period_from * (1.0 - at_range_end) ||
                             root.period > options.period_to * (1.0 + at_range_end);
        if (outside || std::any_of(found.begin(), found.end(), is_same)) continue;
        found.push_back(root.period);
        if (k == 1 && root.multiplicity == 1)
          result.modes.push_back(normal_mode(system, fixed_point, linear, root, here.period, options.cutoff));
        else if (k == 1)
          result.degenerate.push_back({root.period, here.period, root.residual, root.kernel});
        else
          result.rejected.push_back(
              {root.period, fmt::format("{} times around the oscillation with T = {:.12g}", k, root.period / k)});
      }
    // Harmonic 0 is the mean of the loop: it does not depend on T, its minima are rounding.
    if (!reaches_zero && samples[n].harmonic > 0) {
      RejectedDip& dip = result.rejected.emplace_back();
      dip.period = here.period;
      dip.reason = no_zero;
    }
  }
  std::stable_sort(result.modes.begin(), result.modes.end(),
                   [](const NormalMode& a, const NormalMode& b) { return a.period > b.period; });
  return result;
}

}  // namespace orbweaver::starts
