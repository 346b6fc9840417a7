#pragma once

#include <string>

namespace orbweaver::drivers {

/// From now on SIGTERM, SIGUSR1 and SIGINT wait, through exec too: for stop_on_signals, or for release_signals.
void hold_signals();

/// Those that waited, and others, do what they would have done without hold_signals.
void release_signals();

/// From now on SIGTERM, SIGUSR1 and the first SIGINT ask the run to stop early (queue::request_stop); a second SIGINT
/// ends the process at once, as it would have without this. Signals that waited come now.
void stop_on_signals();

/// "SIGTERM", the last signal that asked this process to stop; empty: none has.
[[nodiscard]] std::string stop_signal();

}  // namespace orbweaver::drivers
