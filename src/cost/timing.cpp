#include "timing.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "orbweaver/core/interruption.hpp"

namespace orbweaver::cost {

namespace {
constexpr double too_long = 10.0;  // budgets
}

double seconds_of(const std::function<void()>& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void run_within(double patience, const std::function<void()>& work) {
  if (std::isinf(patience)) return work();
  const auto start = std::chrono::steady_clock::now();
  const core::InterruptionScope scope(
      [&] { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() > patience; });
  try {
    work();
  } catch (const core::Interrupted&) {
    throw GivenUp(fmt::format("given up after {:g} s", patience));
  }
}

Timing timing_of(const std::function<void()>& work, double budget, double patience) {
  const double first = seconds_of([&] { run_within(patience, work); });
  if (first > too_long * budget) return {first, 1};
  std::vector<double> times;
  double spent = 0.0;
  while (times.empty() || (spent < budget && static_cast<int>(times.size()) < most_repetitions)) {
    times.push_back(seconds_of(work));
    spent += times.back();
  }
  const auto middle = times.begin() + static_cast<std::ptrdiff_t>(times.size() / 2);
  std::nth_element(times.begin(), middle, times.end());
  return {*middle, static_cast<int>(times.size())};
}

}  // namespace orbweaver::cost
