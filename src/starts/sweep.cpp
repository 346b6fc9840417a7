#include "orbweaver/starts/sweep.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <set>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "constant_loop_hessian.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/core/interruption.hpp"
#include "orbweaver/core/log/log_stage.hpp"
#include "orbweaver/starts/sampled_eigenvalues.hpp"

namespace orbweaver::starts {

namespace {

constexpr std::string_view no_zero = "a dip that does not reach zero: no family starts here";

/// Kernel vectors of unit length: their entries, and equations between them, hold to rounding times the inverse of the
/// gap to the next singular value. What is larger is seen, what is smaller is taken for zero.
constexpr double negligible_entry = 1e-9;
constexpr double reversible = 1e-8;
/// Rounding of the ends of a range of periods, relative to them.
constexpr double at_range_end = 1e-12;
/// An automatic range: so much longer and shorter than the periods that it covers, so that the outermost dips are seen
/// whole, in so many steps.
constexpr double range_margin = 1.25;
constexpr int range_steps = 1000;

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

Eigen::MatrixXd constant_jacobian(const systems::System& system, std::span<const double> point) {
  const Eigen::Index d = system.dimension();
  core::require(static_cast<Eigen::Index>(point.size()) == d, "a fixed point of another dimension");
  Eigen::VectorXd f(d);
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> a(d, d);
  system.field_jacobian(1, point.data(), f.data(), a.data());
  return a;
}

/// The number of the last period in a range: period_from + n step.
int last_sample(const SweepOptions& range) {
  return static_cast<int>(std::floor((range.period_to - range.period_from) / range.step * (1.0 + at_range_end)));
}

class Sweep {
 public:
  Sweep(const systems::System& system, std::span<const double> fixed_point, const SweepOptions& options)
      : _system(system), _hessian(constant_jacobian(system, fixed_point), options.cutoff) {
    _result.fixed_point.assign(fixed_point.begin(), fixed_point.end());
    _result.range = options;
    _result.linear = linear_modes(system, fixed_point);
  }

  SweepResult run() {
    take_samples();
    const double amplitude = std::max(_result.range.amplitude, least_search_amplitude);
    for (SharedPeriod& shared : shared_periods(_system, _result.fixed_point, _result.linear, amplitude))
      if (is_inside(shared.period))
        add(std::move(shared));
      else
        _result.left_out.push_back(std::move(shared));
    explain_dips();
    add_doubts();
    return std::move(_result);
  }

 private:
  struct Sample {
    SweepPoint point;
    int harmonic;  // the one that carries the smallest eigenvector
  };

  [[nodiscard]] bool is_inside(double period) const {
    return period >= _result.range.period_from * (1.0 - at_range_end) &&
           period <= _result.range.period_to * (1.0 + at_range_end);
  }

  void take_samples() {
    const SweepOptions& range = _result.range;
    const int last = last_sample(range);
    // One sample beyond each end, so that a dip at an end is seen; only roots within the range count.
    const int first = range.period_from > range.step ? -1 : 0;
    for (int n = first; n <= last + 1; ++n) {
      core::interruption_point();
      const double period = range.period_from + n * range.step;
      const ConstantLoopHessian::Smallest smallest = _hessian.smallest(period);
      _samples.push_back({{period, smallest.eigenvalue}, smallest.harmonic});
      if (n >= 0 && n <= last) _result.table.push_back(_samples.back().point);
    }
  }

  // Of the two samples beside a period that with the smaller eigenvalue.
  [[nodiscard]] double grid_period(double period) const {
    const auto above = std::lower_bound(_samples.begin(), _samples.end(), period,
                                        [](const Sample& s, double value) { return s.point.period < value; });
    if (above == _samples.begin()) return above->point.period;
    const SweepPoint& below = std::prev(above)->point;
    if (above == _samples.end()) return below.period;
    return above->point.eigenvalue <= below.eigenvalue ? above->point.period : below.period;
  }

  void add(SharedPeriod shared) {
    const systems::Structure& structure = _system.structure();
    const int cutoff = _result.range.cutoff;
    const double seen = grid_period(shared.period);
    if (!shared.is_simple()) {
      _result.degenerate.push_back({std::move(shared), seen});
      return;
    }
    NormalMode mode;
    mode.period = shared.period;
    mode.grid_period = seen;
    mode.residual = shared.residual;
    mode.apart_below = shared.apart_below;
    mode.direction = direction_of(with_standard_phase(structure, shared.kernel.col(0)), cutoff);
    mode.grid_direction = direction_of(with_standard_phase(structure, _hessian.first_harmonic(seen)), cutoff);
    mode.isotropy = isotropy_of(structure, _result.fixed_point, mode.period, mode.direction, cutoff);
    _result.modes.push_back(std::move(mode));
  }

  void explain_dips() {
    std::set<std::pair<int, double>> told;
    for (std::size_t n = 1; n + 1 < _samples.size(); ++n) {
      const SweepPoint& here = _samples[n].point;
      const SweepPoint& before = _samples[n - 1].point;
      const SweepPoint& after = _samples[n + 1].point;
      if (!(here.eigenvalue < before.eigenvalue && here.eigenvalue <= after.eigenvalue)) continue;
      bool reaches_zero = false;
      // All harmonics, not only that of the smallest eigenvalue: dips that lie closer together than a step show as one.
      for (int k = 1; k <= _result.range.cutoff; ++k)
        for (const Oscillation& oscillation : _result.linear.oscillations) {
          const double period = k * oscillation.period;
          if (period < before.period || period > after.period) continue;
          reaches_zero = true;
          if (k > 1 && is_inside(period) && told.emplace(k, oscillation.period).second)
            _result.rejected.push_back({period, fmt::format("{} times around the oscillation with T = {:.12g}", k,
                                                            oscillation.period * _system.scales().time)});
        }
      // Harmonic 0 is the mean of the loop: it does not depend on T, its minima are rounding.
      if (!reaches_zero && _samples[n].harmonic > 0) {
        RejectedDip& dip = _result.rejected.emplace_back();
        dip.period = here.period;
        dip.reason = no_zero;
      }
    }
  }

  void add_doubts() {
    const LinearModes& linear = _result.linear;
    for (const Resonance& resonance : linear.resonances) {
      const double period = linear.oscillations[resonance.slow].period;
      if (resonance.ratio > strongest_harmonic && is_inside(period))
        _result.rejected.push_back(
            {period, fmt::format("a resonance: {} times the period of the oscillation with T = {:.12g}; families that "
                                 "start along combinations of the two are not looked for",
                                 resonance.ratio, linear.oscillations[resonance.fast].period * _system.scales().time)});
    }
    for (const UndecidedEigenvalues& eigenvalues : linear.undecided)
      _result.rejected.push_back({eigenvalues.period(), to_text(eigenvalues)});
  }

  const systems::System& _system;
  ConstantLoopHessian _hessian;
  SweepResult _result;
  std::vector<Sample> _samples;
};

}  // namespace

SweepOptions automatic_range(const LinearModes& modes) {
  std::vector<double> periods;
  const auto add = [&](double period) {
    if (std::isfinite(period)) periods.push_back(period);
  };
  for (const Oscillation& oscillation : modes.oscillations) add(oscillation.period);
  for (const UndecidedEigenvalues& eigenvalues : modes.undecided) add(eigenvalues.period());
  if (periods.empty())
    for (const std::complex<double>& value : modes.rest) add(2.0 * std::numbers::pi / std::abs(value));
  SweepOptions range;
  if (periods.empty()) return range;
  const auto [shortest, longest] = std::minmax_element(periods.begin(), periods.end());
  range.period_from = *shortest / range_margin;
  range.period_to = *longest * range_margin;
  range.step = (range.period_to - range.period_from) / range_steps;
  return range;
}

namespace {

void require_range(const SweepOptions& range) {
  core::require(range.step > 0.0 && range.period_from > 0.0 && range.period_to > range.period_from,
                "a sweep needs 0 < period_from < period_to and a positive step");
}

}  // namespace

SweepResult sweep(const systems::System& system, std::span<const double> fixed_point, const SweepOptions& options) {
  const core::LogStage stage(core::Stage::sweep);
  require_range(options);
  return Sweep(system, fixed_point, options).run();
}

std::vector<SweepPoint> sampled_eigenvalues(const systems::System& system, std::span<const double> fixed_point,
                                            const SweepOptions& range, Harmonics harmonics) {
  require_range(range);
  ConstantLoopHessian hessian(constant_jacobian(system, fixed_point), range.cutoff, harmonics);
  std::vector<SweepPoint> table;
  for (int n = 0; n <= last_sample(range); ++n) {
    const double period = range.period_from + n * range.step;
    table.push_back({period, hessian.smallest(period).eigenvalue});
  }
  return table;
}

}  // namespace orbweaver::starts
