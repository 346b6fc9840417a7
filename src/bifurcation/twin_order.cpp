#include "twin_order.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <utility>

#include "orbweaver/continuation/orbit.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/loop/curve/measures.hpp"

namespace orbweaver::bifurcation {

namespace {

/// How far to both sides of a base its numbers are compared, in parts of its amplitude where that is below 1: far above
/// what kernel vectors are off by (1e-6), and near enough to tell on which side they grow.
constexpr double beside = 0.01;
/// A rotation with a smaller sine is none, or half a turn.
constexpr double no_sense = 1e-3;

double length_of(const std::vector<double>& v) {
  return std::sqrt(std::inner_product(v.begin(), v.end(), v.begin(), 0.0));
}

}  // namespace

bool stands_before(const std::vector<double>& a, const std::vector<double>& b, double apart) {
  core::require(a.size() == b.size(), "twins are told apart by the same numbers");
  for (std::size_t n = 0; n < a.size(); ++n)
    if (std::abs(a[n] - b[n]) > apart * std::max(std::abs(a[n]), std::abs(b[n]))) return a[n] > b[n];
  return false;
}

std::vector<double> at_symmetric_instants(const systems::System& system, const loop::Loop& loop) {
  const auto n = static_cast<std::size_t>(system.dimension());
  std::vector<double> speeds;
  std::vector<double> accelerations;
  for (const double fraction : {0.0, 0.5}) {
    const std::vector<double> z = loop::state_at(loop, fraction * loop.period);
    std::vector<double> f(n);
    std::vector<double> jacobian(n * n);
    std::vector<double> acceleration(n, 0.0);
    system.field_jacobian(1, z.data(), f.data(), jacobian.data());
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t l = 0; l < n; ++l) acceleration[i] += jacobian[i * n + l] * f[l];
    speeds.push_back(length_of(f));
    accelerations.push_back(length_of(acceleration));
  }
  std::vector<double> numbers;
  for (std::vector<double>* values : {&speeds, &accelerations}) {
    std::sort(values->begin(), values->end(), std::greater<>());
    numbers.insert(numbers.end(), values->begin(), values->end());
  }
  return numbers;
}

int rising_side(const systems::System& system, const loop::Loop& base, const loop::Tangent& line, bool is_reversible) {
  const double amplitude = loop::rms_amplitude(base);
  const double away = beside * (amplitude > 0.0 ? std::min(1.0, amplitude) : 1.0);
  const auto numbers_at = [&](double distance) {
    const loop::Loop there = loop::moved(base, line, distance);
    return is_reversible ? at_symmetric_instants(system, there) : std::vector<double>{loop::rms_speed(there)};
  };
  const std::vector<double> ahead = numbers_at(away);
  const std::vector<double> behind = numbers_at(-away);
  if (stands_before(ahead, behind, of_crossings)) return 1;
  return stands_before(behind, ahead, of_crossings) ? -1 : 0;
}

void put_in_order(const systems::System& system, std::vector<FoundOrbit>& found) {
  const auto numbers_of = [&](const FoundOrbit& orbit) {
    std::vector<double> numbers{orbit.loop.period};
    if (system.structure().conservative()) numbers.push_back(continuation::energy_of(system, orbit.loop));
    numbers.push_back(loop::rms_speed(orbit.loop));
    return numbers;
  };
  std::stable_sort(found.begin(), found.end(), [&](const FoundOrbit& a, const FoundOrbit& b) {
    return stands_before(numbers_of(a), numbers_of(b), of_orbits_found);
  });
}

int sense_of_time(const KernelActions& group) {
  core::require(group.dimension() == 2, "time shifts turn a plane");
  const Action* first = nullptr;
  double turned = 0.0;
  for (const Action& a : group.actions()) {
    if (a.element.reversing || a.matrix.determinant() < 0.0) continue;
    const double sine = 0.5 * (a.matrix(1, 0) - a.matrix(0, 1));
    if (std::abs(sine) < no_sense) continue;
    if (first && std::pair(first->element.shift(), first->declared) <= std::pair(a.element.shift(), a.declared))
      continue;
    first = &a;
    turned = sine;
  }
  if (!first) return 0;
  return turned > 0.0 ? 1 : -1;
}

}  // namespace orbweaver::bifurcation
