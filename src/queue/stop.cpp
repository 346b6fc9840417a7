#include "orbweaver/queue/stop.hpp"

#include <atomic>

#include "orbweaver/core/interruption.hpp"
#include "orbweaver/core/pause.hpp"
#include "watchdog.hpp"

namespace orbweaver::queue {

namespace {

std::atomic<bool> stop_flag{false};
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may only touch lock-free atomics");

}  // namespace

void request_stop() noexcept { stop_flag.store(true); }
bool stop_requested() noexcept { return stop_flag.load(); }
void clear_stop() noexcept { stop_flag.store(false); }

void do_interruptibly(const std::string& name, const std::function<bool()>& asked, const std::function<void()>& work,
                      double stop_seconds) {
  Watchdog watchdog(0.0, stop_seconds);
  watchdog.began(name);
  const core::InterruptionScope scope([&] {
    watchdog.alive();
    return asked();
  });
  core::pause_point(name);
  work();
}

}  // namespace orbweaver::queue
