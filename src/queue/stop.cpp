#include "orbweaver/queue/stop.hpp"

#include <atomic>

namespace orbweaver::queue {

namespace {

std::atomic<bool> stop_flag{false};
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may only touch lock-free atomics");

}  // namespace

void request_stop() noexcept { stop_flag.store(true); }
bool stop_requested() noexcept { return stop_flag.load(); }
void clear_stop() noexcept { stop_flag.store(false); }

}  // namespace orbweaver::queue
