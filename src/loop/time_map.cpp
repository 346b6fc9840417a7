#include "orbweaver/loop/time_map.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "orbweaver/core/error.hpp"

namespace orbweaver::loop {

namespace {

constexpr double two_pi = 2.0 * std::numbers::pi;

}  // namespace

bool TimeMap::is_identity() const {
  return kappa == 1.0 && std::all_of(coefficients.begin(), coefficients.end(), [](double c) { return c == 0.0; });
}

double TimeMap::phase(double s) const {
  const double sine = std::sin(s);
  const double cosine = std::cos(s);
  double out = s + std::atan2((kappa - 1.0) * sine * cosine, cosine * cosine + kappa * sine * sine);
  for (std::size_t n = 0; 2 * n + 1 < coefficients.size(); ++n) {
    const double k = static_cast<double>(n + 1);
    out += (coefficients[2 * n] * std::sin(k * s) + coefficients[2 * n + 1] * (1.0 - std::cos(k * s))) / k;
  }
  return out;
}

double TimeMap::density(double s) const {
  const double sine = std::sin(s);
  const double cosine = std::cos(s);
  double out = kappa / (cosine * cosine + kappa * kappa * sine * sine);
  for (std::size_t n = 0; 2 * n + 1 < coefficients.size(); ++n) {
    const double k = static_cast<double>(n + 1);
    out += coefficients[2 * n] * std::cos(k * s) + coefficients[2 * n + 1] * std::sin(k * s);
  }
  return out;
}

double TimeMap::inverse(double phase_wanted) const {
  const double turns = std::floor(phase_wanted / two_pi);
  const double wanted = phase_wanted - two_pi * turns;
  double low = 0.0;
  double high = two_pi;
  double s = wanted;
  if (coefficients.empty()) {  // tan s = tan(phase) / kappa, on the same branch
    s = wanted + std::atan2((1.0 / kappa - 1.0) * std::sin(wanted) * std::cos(wanted),
                            std::cos(wanted) * std::cos(wanted) + std::sin(wanted) * std::sin(wanted) / kappa);
    return s + two_pi * turns;
  }
  for (int n = 0; n < 200; ++n) {
    const double excess = phase(s) - wanted;
    (excess > 0.0 ? high : low) = s;
    double next = s - excess / density(s);
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    if (next == s || std::abs(next - s) < 1e-16 * two_pi) break;
    s = next;
  }
  return s + two_pi * turns;
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
