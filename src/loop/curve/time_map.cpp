#include "orbweaver/loop/curve/time_map.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include <boost/math/policies/error_handling.hpp>
#include <boost/math/tools/roots.hpp>

#include "orbweaver/core/error.hpp"
#include "orbweaver/loop/grid/fourier.hpp"
#include "orbweaver/numerics/two_pi.hpp"

namespace orbweaver::loop {

namespace {

using numerics::two_pi;

constexpr double below_rounding = 1e-17;   // of a density of mean 1
constexpr int most_inversion_steps = 200;  // of Newton's method: bisection alone needs 53
// Newton's method within a bracket, since the slope is at hand: 5 to 6 values, where TOMS 748 takes 9 to 10 and 1.5 to
// 3 times as long. A step of 2^-29 is the last: its square is rounding.
constexpr int newton_bits = 30;
constexpr int bracket_bits = 53;  // of the bracket that bisection and interpolation leave: neighbouring numbers
constexpr double whole = 1e-12;   // turns that differ from a whole number by less are rounding

// cos ks and sin ks, from k to k + 1 by one turn.
template <class Real>
struct Wave {
  Real cosine;
  Real sine;
  void turn(Real c, Real s) {
    const Real next = cosine * c - sine * s;
    sine = sine * c + cosine * s;
    cosine = next;
  }
};

template <class Real>
Real pulse_density(double kappa, Real cosine, Real sine) {
  return kappa / (cosine * cosine + kappa * kappa * sine * sine);
}

bool is_whole(double turns) { return std::abs(turns - std::round(turns)) < whole; }

// Harmonics 2, 4, ... of the pulse's density are 2 q, 2 q^2, ...; below rounding from this harmonic on.
double pulse_ratio(double kappa) { return (kappa - 1.0) / (kappa + 1.0); }
int pulse_harmonics(double kappa) {
  const double q = std::abs(pulse_ratio(kappa));
  return q == 0.0 ? 0 : 2 * static_cast<int>(std::ceil(std::log(below_rounding) / std::log(q)));
}

// Both at once: they share the harmonics.
template <class Real>
std::pair<Real, Real> phase_and_density(const TimeMap& map, Real s) {
  const Real sine = std::sin(s);
  const Real cosine = std::cos(s);
  Real phase = s;
  Real density = 1;
  if (map.kappa != 1.0) {
    phase += std::atan2((Real(map.kappa) - 1) * sine * cosine, cosine * cosine + map.kappa * sine * sine);
    density = pulse_density(map.kappa, cosine, sine);
  }
  Wave<Real> wave{cosine, sine};
  for (std::size_t n = 0; 2 * n + 1 < map.coefficients.size(); ++n) {
    const double c = map.coefficients[2 * n];
    const double d = map.coefficients[2 * n + 1];
    phase += (c * wave.sine + d * (1 - wave.cosine)) / static_cast<Real>(n + 1);
    density += c * wave.cosine + d * wave.sine;
    wave.turn(cosine, sine);
  }
  return {phase, density};
}

// Parameters whose harmonics are added side by side: what that takes stays in the first cache.
constexpr std::size_t parameters_together = 32;

// Both at up to `parameters_together` parameters.
struct PhasesAndDensities {
  double phase[parameters_together];
  double density[parameters_together];

  PhasesAndDensities(const TimeMap& map, const double* s, std::size_t count) {
    double sine[parameters_together] = {}, cosine[parameters_together] = {}, wave_sine[parameters_together],
           wave_cosine[parameters_together];
    for (std::size_t j = 0; j < count; ++j) {
      sine[j] = std::sin(s[j]);
      cosine[j] = std::cos(s[j]);
      phase[j] = s[j];
      density[j] = 1.0;
      if (map.kappa == 1.0) continue;
      phase[j] +=
          std::atan2((map.kappa - 1.0) * sine[j] * cosine[j], cosine[j] * cosine[j] + map.kappa * sine[j] * sine[j]);
      density[j] = pulse_density(map.kappa, cosine[j], sine[j]);
    }
    std::fill(phase + count, phase + parameters_together, 0.0);
    std::fill(density + count, density + parameters_together, 1.0);
    std::copy(sine, sine + parameters_together, wave_sine);
    std::copy(cosine, cosine + parameters_together, wave_cosine);
    for (std::size_t n = 0; 2 * n + 1 < map.coefficients.size(); ++n) {
      const double c = map.coefficients[2 * n];
      const double d = map.coefficients[2 * n + 1];
      for (std::size_t j = 0; j < parameters_together; ++j) {
        phase[j] += (c * wave_sine[j] + d * (1.0 - wave_cosine[j])) / static_cast<double>(n + 1);
        density[j] += c * wave_cosine[j] + d * wave_sine[j];
        const double next = wave_cosine[j] * cosine[j] - wave_sine[j] * sine[j];
        wave_sine[j] = wave_sine[j] * cosine[j] + wave_cosine[j] * sine[j];
        wave_cosine[j] = next;
      }
    }
  }
};

// A density that is a small difference of its coefficients, which are about 1, is summed in long double: to double the
// rounding of its terms, over the density, would show as noise in the harmonics of what runs under the map.
constexpr double small_density = 0.019;  // below the least that maps have where nothing is guarded (time_map_fit.hpp)
bool needs_more_digits(const TimeMap& map, double density) {
  return density < small_density && !map.coefficients.empty();
}
constexpr int polishing_steps = 2;  // of Newton's method from a parameter that is right but for rounding

// The parameter of `map` at which its time is that of `other` at s, from one that is right but for rounding.
double polished(const TimeMap& map, const TimeMap& other, double s, double rounded) {
  const long double wanted = phase_and_density<long double>(other, s).first;
  long double better = rounded;
  for (int n = 0; n < polishing_steps; ++n) {
    const auto [phase, slope] = phase_and_density<long double>(map, better);
    better += (wanted - phase) / slope;
  }
  return static_cast<double>(better);
}

// Newton's method without a bracket: where it has not converged by then, one is needed.
constexpr int most_common_steps = 8;
const double last_step = std::ldexp(1.0, 1 - newton_bits);

// The parameters in [0, 2 pi] of these phases, at most `parameters_together`; `density` takes the densities there,
// `converged` which of them are right.
void invert_together(const TimeMap& map, const double* wanted, std::size_t count, double* s, double* density,
                     bool* converged) {
  std::copy(wanted, wanted + count, s);
  std::fill(converged, converged + count, false);
  for (int step = 0; step < most_common_steps; ++step) {
    const PhasesAndDensities here(map, s, count);
    bool all = true;
    for (std::size_t j = 0; j < count; ++j) {
      density[j] = here.density[j];
      if (converged[j]) continue;
      const double change = (wanted[j] - here.phase[j]) / here.density[j];
      s[j] = std::clamp(s[j] + change, 0.0, two_pi);
      converged[j] = std::abs(change) <= last_step * std::abs(s[j]);
      all = all && converged[j];
    }
    if (all) return;
  }
}

// The parameter in [0, 2 pi] of a phase in [0, 2 pi], by bisection and interpolation. The map increases from 0 to
// 2 pi, so that one exists; where the density is no more than rounding, any on the flat is right.
double inverse_between_signs(const TimeMap& map, double wanted) {
  const auto excess = [&](double s) { return phase_and_density(map, s).first - wanted; };
  const double at_start = excess(0.0);
  const double at_end = excess(two_pi);
  if (at_start >= 0.0) return 0.0;
  if (at_end <= 0.0) return two_pi;
  std::uintmax_t steps = most_inversion_steps;
  const auto [lower, upper] = boost::math::tools::toms748_solve(
      excess, 0.0, two_pi, at_start, at_end, boost::math::tools::eps_tolerance<double>(bracket_bits), steps);
  return 0.5 * (lower + upper);
}

// The same by Newton's method where it arrives: Boost's throws where its first steps leave the bracket on a flat before
// it has seen both signs.
double inverse_in_a_turn(const TimeMap& map, double wanted) {
  const auto excess = [&](double s) {
    auto [here, slope] = phase_and_density(map, s);
    return std::pair(here - wanted, slope);
  };
  std::uintmax_t steps = most_inversion_steps;
  try {
    const double s = boost::math::tools::newton_raphson_iterate(excess, wanted, 0.0, two_pi, newton_bits, steps);
    if (steps < most_inversion_steps) return s;
  } catch (const boost::math::evaluation_error&) {  // it knows no other way to say so
  }
  return inverse_between_signs(map, wanted);
}

}  // namespace

bool TimeMap::is_identity() const {
  return kappa == 1.0 && std::all_of(coefficients.begin(), coefficients.end(), [](double c) { return c == 0.0; });
}

double TimeMap::phase(double s) const { return phase_and_density(*this, s).first; }

double TimeMap::density(double s) const {
  const double rounded = phase_and_density(*this, s).second;
  return needs_more_digits(*this, rounded) ? static_cast<double>(phase_and_density<long double>(*this, s).second)
                                           : rounded;
}

double TimeMap::parameter_at(const TimeMap& other, double s) const {
  const double rounded = inverse(other.phase(s));
  if (!needs_more_digits(*this, phase_and_density(*this, rounded).second)) return rounded;
  return polished(*this, other, s, rounded);
}

std::vector<double> TimeMap::phases(std::span<const double> s) const {
  std::vector<double> out(s.size());
  for (std::size_t first = 0; first < s.size(); first += parameters_together) {
    const std::size_t count = std::min(parameters_together, s.size() - first);
    const PhasesAndDensities here(*this, s.data() + first, count);
    std::copy(here.phase, here.phase + count, out.begin() + static_cast<std::ptrdiff_t>(first));
  }
  return out;
}

std::vector<double> TimeMap::parameters_at(const TimeMap& other, std::span<const double> s) const {
  if (*this == other) return {s.begin(), s.end()};
  std::vector<double> out = other.phases(s);
  if (coefficients.empty()) {
    for (double& each : out) each = inverse(each);
    return out;
  }
  double wanted[parameters_together], turns[parameters_together], found[parameters_together],
      density[parameters_together];
  bool converged[parameters_together];
  for (std::size_t first = 0; first < s.size(); first += parameters_together) {
    const std::size_t count = std::min(parameters_together, s.size() - first);
    for (std::size_t j = 0; j < count; ++j) {
      turns[j] = std::floor(out[first + j] / two_pi);
      wanted[j] = out[first + j] - two_pi * turns[j];
    }
    invert_together(*this, wanted, count, found, density, converged);
    for (std::size_t j = 0; j < count; ++j) {
      const double here = converged[j] ? found[j] + two_pi * turns[j] : inverse(out[first + j]);
      const double slope = converged[j] ? density[j] : phase_and_density(*this, here).second;
      out[first + j] = needs_more_digits(*this, slope) ? polished(*this, other, s[first + j], here) : here;
    }
  }
  return out;
}

double TimeMap::inverse(double phase_wanted) const {
  const double turns = std::floor(phase_wanted / two_pi);
  const double wanted = phase_wanted - two_pi * turns;
  if (coefficients.empty())  // tan s = tan(phase) / kappa, on the same branch
    return wanted +
           std::atan2((1.0 / kappa - 1.0) * std::sin(wanted) * std::cos(wanted),
                      std::cos(wanted) * std::cos(wanted) + std::sin(wanted) * std::sin(wanted) / kappa) +
           two_pi * turns;
  return inverse_in_a_turn(*this, wanted) + two_pi * turns;
}

bool TimeMap::is_invariant_under_shift(double turns) const {
  if (kappa != 1.0 && !is_whole(2.0 * turns)) return false;
  for (std::size_t n = 0; n < coefficients.size(); ++n)
    if (coefficients[n] != 0.0 && !is_whole(static_cast<double>(n / 2 + 1) * turns)) return false;
  return true;
}

TimeMap TimeMap::shifted(double shift) const {
  if (is_invariant_under_shift(shift / two_pi)) return *this;
  TimeMap out = *this;
  if (kappa != 1.0 && !is_whole(2.0 * shift / two_pi)) {
    const auto harmonics = static_cast<std::size_t>(pulse_harmonics(kappa));
    out.kappa = 1.0;
    out.coefficients.resize(std::max(coefficients.size(), 2 * harmonics), 0.0);
    double power = 2.0;
    for (std::size_t k = 2; k <= harmonics; k += 2) {
      power *= pulse_ratio(kappa);
      out.coefficients[2 * (k - 1)] += power;
    }
  }
  for (std::size_t n = 0; 2 * n + 1 < out.coefficients.size(); ++n) {
    const double turns = static_cast<double>(n + 1) * (shift / two_pi);
    const double angle = two_pi * (turns - std::floor(turns));
    const double c = out.coefficients[2 * n];
    const double d = out.coefficients[2 * n + 1];
    out.coefficients[2 * n] = c * std::cos(angle) + d * std::sin(angle);
    out.coefficients[2 * n + 1] = d * std::cos(angle) - c * std::sin(angle);
  }
  return out;
}

TimeMap TimeMap::reversed() const {
  TimeMap out = *this;
  for (std::size_t n = 1; n < out.coefficients.size(); n += 2) out.coefficients[n] = -out.coefficients[n];
  return out;
}

std::vector<double> densities(const TimeMap& map, int nodes) {
  std::vector<double> out(static_cast<std::size_t>(nodes), 1.0);
  if (!map.coefficients.empty()) {
    const auto highest = static_cast<int>(map.coefficients.size() / 2);
    core::require(2 * highest < nodes, "too few nodes for this time map");
    std::vector<double> modes{1.0};
    modes.insert(modes.end(), map.coefficients.begin(), map.coefficients.end());
    FourierGrid::of_size(nodes).synthesize(highest, 1, modes.data(), out.data());
  }
  if (map.kappa != 1.0)
    for (std::size_t j = 0; j < out.size(); ++j) {
      const double s = two_pi * static_cast<double>(j) / nodes;
      out[j] += pulse_density(map.kappa, std::cos(s), std::sin(s)) - 1.0;
    }
  for (std::size_t j = 0; j < out.size(); ++j)
    if (needs_more_digits(map, out[j])) out[j] = map.density(two_pi * static_cast<double>(j) / nodes);
  return out;
}

int nodes_to_resolve(const TimeMap& map) {
  return std::max(pulse_harmonics(map.kappa), static_cast<int>(map.coefficients.size()) + 2);
}

std::vector<double> to_numbers(const TimeMap& map) {
  if (map.is_identity()) return {};
  std::vector<double> out{map.kappa};
  out.insert(out.end(), map.coefficients.begin(), map.coefficients.end());
  return out;
}

TimeMap time_map_of(const std::vector<double>& numbers) {
  if (numbers.empty()) return {};
  core::require(numbers.size() % 2 == 1, "a time map needs kappa and pairs of coefficients");
  core::require(std::all_of(numbers.begin(), numbers.end(), [](double v) { return std::isfinite(v); }),
                "a time map's numbers must be finite");
  core::require(numbers.front() > 0.0, "a time map's kappa must be positive");
  TimeMap map{numbers.front(), {numbers.begin() + 1, numbers.end()}};
  const auto samples = static_cast<int>(16 * (numbers.size() + 1));
  for (int n = 0; n < samples; ++n)
    core::require(map.density(two_pi * n / samples) > 0.0, "a time map must run forward everywhere");
  return map;
}

}  // namespace orbweaver::loop
