// Included before every file of the simulated bench_queue: what reads a clock or sleeps does so in simulated time,
// which SMPI arranges for C but not for std::chrono and std::this_thread.
#pragma once

#undef exit  // SMPI's macro breaks CLI11

#include <chrono>
#include <ctime>
#include <thread>

namespace simulated {

std::chrono::nanoseconds now() noexcept;
/// Sleeps a little longer than asked, as Linux does (50 us of timer slack and the wake-up).
void sleep(std::chrono::nanoseconds duration);
/// Of this rank, counting what it did not sleep.
int processor_time(timespec* time);

}  // namespace simulated

namespace std::chrono {

struct simulated_clock {
  using duration = nanoseconds;
  using rep = duration::rep;
  using period = duration::period;
  using time_point = chrono::time_point<simulated_clock>;
  static constexpr bool is_steady = true;
  static time_point now() noexcept { return time_point(simulated::now()); }
};

}  // namespace std::chrono

namespace std::this_thread {

template <class Rep, class Period>
void simulated_sleep_for(const chrono::duration<Rep, Period>& duration) {
  simulated::sleep(chrono::duration_cast<chrono::nanoseconds>(duration));
}

}  // namespace std::this_thread

#define steady_clock simulated_clock
#define sleep_for simulated_sleep_for
#undef clock_gettime
#define clock_gettime(which, time) simulated::processor_time(time)
