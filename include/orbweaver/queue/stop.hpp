#pragma once

#include <functional>
#include <string>

#include "orbweaver/queue/run.hpp"

namespace orbweaver::queue {

/// Asks the run that this process is part of to stop early; a worker passes the request on to rank 0. May be called
/// from a signal handler or another thread. The request stays until clear_stop, so that one made before the run begins
/// is not lost.
void request_stop() noexcept;
[[nodiscard]] bool stop_requested() noexcept;
void clear_stop() noexcept;

/// Does `work` ("the search for starts") outside of a run: it is given up within a step (core::Interrupted) once
/// `asked`, and a stop that it does not obey ends the program as it does in a run (Options::stop_seconds). Work that is
/// not asked to end after a stop goes on as long as it comes to interruption points.
void do_interruptibly(const std::string& name, const std::function<bool()>& asked, const std::function<void()>& work,
                      double stop_seconds = Options().stop_seconds);

}  // namespace orbweaver::queue
