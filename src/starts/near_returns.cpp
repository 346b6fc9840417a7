#include "orbweaver/starts/near_returns.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include "orbweaver/core/error.hpp"
#include "orbweaver/core/interruption.hpp"
#include "orbweaver/loop/symmetry/symmetry_group.hpp"
#include "orbweaver/numerics/two_pi.hpp"
#include "orbweaver/systems/formulas.hpp"
#include "orbweaver/systems/scaled_system.hpp"
#include "orbweaver/taylor/flow.hpp"

namespace orbweaver::starts {

namespace {

using numerics::two_pi;

/// Radians by which the field may turn from one sample to the next, rms: returns are told by the sign of a product of
/// a distance and the field.
constexpr double turn_a_sample = 0.1;
/// Samples by which the time of a return may change from one sample of the trajectory to the next: both pieces run
/// nearly alike, so it changes by far less than one where they are near.
constexpr double same_return = 2.0;
/// Samples that the rate of turning is told from, and over how many of the longest periods.
constexpr int samples_of_rate = 1000;
constexpr double periods_of_rate = 100.0;
/// Least samples of the shortest time of a return.
constexpr double samples_a_return = 16.0;
/// Minima that are followed along the trajectory, in tolerances: from where a return may still come nearer.
constexpr double followed = 3.0;

struct Trajectory {
  double step = 0.0;
  std::size_t d = 0;
  std::vector<double> states;  ///< d a sample
  std::vector<double> fields;

  [[nodiscard]] std::size_t count() const { return states.size() / d; }
};

Trajectory sampled(const systems::System& system, std::vector<double> state, double time, std::size_t steps) {
  const auto* formulas = dynamic_cast<const systems::FormulaSystem*>(&system);
  core::require(formulas != nullptr, "a trajectory takes a system with formulas");
  const systems::Formulas written = formulas->formulas();
  taylor::Flow<double> flow(written, written.values, {});
  Trajectory out;
  out.d = state.size();
  out.step = time / static_cast<double>(steps);
  try {
    for (std::size_t n = 0;; ++n) {
      core::interruption_point();
      out.states.insert(out.states.end(), state.begin(), state.end());
      if (n == steps) break;
      flow.advance(state, out.step);
    }
  } catch (const core::NumericalError& error) {
    throw core::InputError(
        fmt::format("starts.recurrences: expected a trajectory over the whole time, got {}; give "
                    "another state or a shorter time",
                    error.what()));
  }
  out.fields.resize(out.states.size());
  std::vector<double> field(out.d);
  for (std::size_t n = 0; n < out.count(); ++n) {
    system.field(1, out.states.data() + n * out.d, field.data());
    std::copy(field.begin(), field.end(), out.fields.begin() + static_cast<std::ptrdiff_t>(n * out.d));
  }
  return out;
}

/// By which the field of the trajectory turns in unit time, rms, from its change along itself.
double rate_of_turning(const systems::System& system, const Trajectory& trajectory) {
  constexpr double part = 1e-6;  // of a state, or of 1: half of the digits
  double change = 0.0;
  double size = 0.0;
  std::vector<double> moved(trajectory.d);
  std::vector<double> field(trajectory.d);
  for (std::size_t n = 0; n < trajectory.count(); ++n) {
    const double* z = trajectory.states.data() + n * trajectory.d;
    const double* f = trajectory.fields.data() + n * trajectory.d;
    double state_square = 1.0;
    double field_square = 0.0;
    for (std::size_t i = 0; i < trajectory.d; ++i) {
      state_square += z[i] * z[i];
      field_square += f[i] * f[i];
    }
    if (field_square == 0.0) continue;
    const double time = part * std::sqrt(state_square / field_square);
    for (std::size_t i = 0; i < trajectory.d; ++i) moved[i] = z[i] + time * f[i];
    system.field(1, moved.data(), field.data());
    for (std::size_t i = 0; i < trajectory.d; ++i) change += std::pow((field[i] - f[i]) / time, 2);
    size += field_square;
  }
  return size > 0.0 ? std::sqrt(change / size) : 0.0;
}

/// A minimum over time of the distance to the image of one state.
struct Minimum {
  double time = 0.0;  ///< in steps
  double square = 0.0;
};

/// Those below `greatest` at times from `from` to `to`, in steps.
std::vector<Minimum> minima(const Trajectory& trajectory, const std::vector<double>& image,
                            const std::vector<char>& angle, std::size_t at, std::size_t from, std::size_t to,
                            double greatest) {
  std::vector<Minimum> found;
  const std::size_t d = trajectory.d;
  double slope_before = 0.0;
  double square_before = 0.0;
  for (std::size_t lag = from; lag <= to; ++lag) {
    const double* z = trajectory.states.data() + (at + lag) * d;
    const double* f = trajectory.fields.data() + (at + lag) * d;
    double square = 0.0;
    double slope = 0.0;
    for (std::size_t i = 0; i < d; ++i) {
      double away = z[i] - image[i];
      if (angle[i] != 0) away -= two_pi * std::nearbyint(away / two_pi);
      square += away * away;
      slope += away * f[i];
    }
    slope *= 2.0 * trajectory.step;  // of the square, a step
    if (lag > from && slope_before < 0.0 && slope >= 0.0) {
      const double share = slope_before / (slope_before - slope);
      // The cubic with these values and slopes at both ends.
      const double u = 1.0 - share;
      const double least = square_before * u * u * (1.0 + 2.0 * share) + square * share * share * (3.0 - 2.0 * share) +
                           slope_before * share * u * u - slope * share * share * u;
      if (least < greatest) found.push_back({static_cast<double>(lag - 1) + share, std::max(least, 0.0)});
    }
    slope_before = slope;
    square_before = square;
  }
  return found;
}

int order_of(const systems::AffineMap& map, const std::vector<int>& angles) {
  const systems::AffineMap identity = systems::AffineMap::identity(map.dimension());
  systems::AffineMap power = map;
  int order = 1;
  for (; !power.is_same(identity, angles); ++order) power = map * power;
  return order;
}

}  // namespace

systems::Scales trajectory_scales(const systems::System& system, const std::vector<double>& state,
                                  const NearReturnOptions& options) {
  const double part = std::min(options.time, periods_of_rate * options.period_to);
  const Trajectory trajectory = sampled(system, state, part, samples_of_rate);
  const auto count = static_cast<double>(trajectory.count());
  const std::vector<std::size_t> first = systems::mixed_coordinates(system.structure());
  std::vector<double> spread(trajectory.d, 0.0);  // squares, of all coordinates that go together
  std::vector<double> rate(trajectory.d, 0.0);
  std::vector<double> members(trajectory.d, 0.0);
  for (std::size_t i = 0; i < trajectory.d; ++i) {
    double mean = 0.0;
    for (std::size_t n = 0; n < trajectory.count(); ++n) mean += trajectory.states[n * trajectory.d + i] / count;
    for (std::size_t n = 0; n < trajectory.count(); ++n) {
      spread[first[i]] += std::pow(trajectory.states[n * trajectory.d + i] - mean, 2) / count;
      rate[first[i]] += std::pow(trajectory.fields[n * trajectory.d + i], 2) / count;
    }
    members[first[i]] += 1.0;
  }
  const auto nearest_power = [](double value) { return std::exp2(std::round(std::log2(value))); };
  systems::Scales scales;
  double square = 0.0;
  double moving = 0.0;
  for (std::size_t i = 0; i < trajectory.d; ++i) {
    const double of_one = spread[first[i]] / members[first[i]];
    const bool is_still = system.structure().is_angle(i) || !(of_one > 0.0) || !std::isfinite(of_one);
    scales.coordinates.push_back(is_still ? 1.0 : nearest_power(std::sqrt(of_one)));
    if (is_still) continue;
    square += rate[first[i]] / spread[first[i]];
    moving += 1.0;
  }
  if (square > 0.0) scales.time = nearest_power(std::sqrt(moving / square));
  scales.conserved.assign(system.structure().conserved.size(), 1.0);
  return scales;
}

std::vector<NearReturn> near_returns(const systems::System& system, const std::vector<double>& state,
                                     const NearReturnOptions& options) {
  const systems::Structure& structure = system.structure();
  const double part = std::min(options.time, periods_of_rate * options.period_to);
  const double rate = rate_of_turning(system, sampled(system, state, part, samples_of_rate));
  const loop::Isotropy symmetries = loop::SymmetryGroup::of_space(structure).elements();
  int highest = 1;
  int returning = 0;
  for (const loop::SymmetryElement& element : symmetries) {
    if (element.reversing) continue;
    highest = std::max(highest, order_of(element.map, structure.angles));
    ++returning;
  }
  const double shortest = options.period_from / highest;
  const double step = std::min(shortest / samples_a_return, rate > 0.0 ? turn_a_sample / rate : shortest);
  const double steps = std::ceil(options.time / step);
  const double pairs = steps * (options.period_to - options.period_from) / step * returning;
  if (!(pairs <= most_pairs))
    throw core::InputError(
        fmt::format("starts.recurrences: expected at most {:g} pairs of samples, {:g} apart, to "
                    "compare, got {:g}; give a shorter time, or longer or fewer periods",
                    most_pairs, step * system.scales().time, pairs));
  const Trajectory trajectory = sampled(system, state, options.time, static_cast<std::size_t>(steps));
  std::vector<char> angle(trajectory.d);
  for (std::size_t i = 0; i < trajectory.d; ++i) angle[i] = structure.is_angle(i) ? 1 : 0;

  std::vector<NearReturn> found;
  for (std::size_t n = 0; n < symmetries.size(); ++n) {
    if (symmetries[n].reversing) continue;
    const systems::AffineMap& map = symmetries[n].map;
    const int order = order_of(map, structure.angles);
    const auto from = static_cast<std::size_t>(options.period_from / order / trajectory.step);
    const auto to = static_cast<std::size_t>(std::ceil(options.period_to / order / trajectory.step));
    const double greatest = std::pow(followed * options.tolerance, 2);
    std::vector<Minimum> before;
    std::vector<Minimum> here;
    const auto near = [](const std::vector<Minimum>& list, const Minimum& of) {  // of the same return
      double least = std::numeric_limits<double>::infinity();
      for (const Minimum& other : list)
        if (std::abs(other.time - of.time) <= same_return) least = std::min(least, other.square);
      return least;
    };
    for (std::size_t at = 0; at + from < trajectory.count(); ++at) {
      core::interruption_point();
      const Eigen::Map<const Eigen::VectorXd> z(trajectory.states.data() + at * trajectory.d,
                                                static_cast<Eigen::Index>(trajectory.d));
      const Eigen::VectorXd mapped = map(z);
      std::vector<Minimum> next = minima(trajectory, {mapped.begin(), mapped.end()}, angle, at, from,
                                         std::min(to, trajectory.count() - 1 - at), greatest);
      for (const Minimum& minimum : here) {
        if (!(minimum.square < std::pow(options.tolerance, 2)) || near(before, minimum) <= minimum.square ||
            near(next, minimum) < minimum.square)
          continue;
        const double period = minimum.time * trajectory.step * order;
        if (period < options.period_from || period > options.period_to) continue;
        const auto first = trajectory.states.begin() + static_cast<std::ptrdiff_t>((at - 1) * trajectory.d);
        found.push_back({at - 1,
                         {first, first + static_cast<std::ptrdiff_t>(trajectory.d)},
                         minimum.time * trajectory.step,
                         static_cast<int>(n),
                         order,
                         std::sqrt(minimum.square)});
      }
      before = std::exchange(here, std::move(next));
    }
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const NearReturn& a, const NearReturn& b) { return a.begin < b.begin; });
  return found;
}

}  // namespace orbweaver::starts
