#pragma once

#include <string>

namespace orbweaver::drivers {

/// From now on SIGTERM, SIGUSR1 and the first SIGINT ask the run to stop early (queue::request_stop); a second SIGINT
/// ends the process at once, as it would have without this.
void stop_on_signals();

/// "SIGTERM", the last signal that asked this process to stop; empty: none has.
[[nodiscard]] std::string stop_signal();

}  // namespace orbweaver::drivers
