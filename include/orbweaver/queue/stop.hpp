#pragma once

namespace orbweaver::queue {

/// Asks the run that this process is part of to stop early; a worker passes the request on to rank 0. May be called
/// from a signal handler or another thread. The request stays until clear_stop, so that one made before the run begins
/// is not lost.
void request_stop() noexcept;
[[nodiscard]] bool stop_requested() noexcept;
void clear_stop() noexcept;

}  // namespace orbweaver::queue
