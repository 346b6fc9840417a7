#pragma once

namespace orbweaver::queue {

/// Asks the run in this process to stop early; only rank 0's request counts. May be called from a signal handler or
/// another thread. The request stays until clear_stop, so that one made before the run begins is not lost.
void request_stop() noexcept;
[[nodiscard]] bool stop_requested() noexcept;
void clear_stop() noexcept;

}  // namespace orbweaver::queue
