#pragma once

#include <span>

namespace orbweaver::loop {

/// What FFTW_ESTIMATE chose when the program was built, for transforms of real data of every even number of nodes from
/// `from` to `to` without a prime factor above 7, as FFTW writes it down.
struct KnownPlans {
  int from;
  int to;
  const char* wisdom;
};

/// In the order of their nodes. The source is made by cmake/fourier_plans.cpp.
[[nodiscard]] std::span<const KnownPlans> known_plans();

/// Tells FFTW what is known of plans for so many nodes. It then makes the plan that it would have found (0.03 ms, not 1
/// to 3). Where FFTW or the CPU are not those of the build it refuses to be told, and finds the plan itself.
void recall_plans(int nodes);

}  // namespace orbweaver::loop
