#pragma once

#include <csignal>
#include <string>

namespace orbweaver::drivers {

/// Signals that ask a survey to stop: SIGTERM, SIGUSR1, SIGINT, and SIGHUP unless it was ignored from the start
/// (nohup).
[[nodiscard]] sigset_t stopping_signals();

/// From now on these signals wait, through exec too: for stop_on_signals, or for release_signals.
void hold_signals();

/// Those that waited, and others, do what they would have done without hold_signals.
void release_signals();

/// From now on these signals, of SIGINT the first, ask the run to stop early (queue::request_stop); a second SIGINT
/// ends the process at once, as it would have without this. Signals that waited come now.
void stop_on_signals();

/// Set by `launch` for its ranks: names a file that the first of them removes.
inline constexpr const char* mark_variable = "ORBWEAVER_LAUNCH_MARK";

/// Tells the ranks of `launch` which signal it is that comes to them as SIGUSR1.
void tell_passed_on(int signal);
void forget_passed_on();

/// "SIGTERM", the last signal that asked this process, or `launch` that has started it, to stop; empty: none has.
[[nodiscard]] std::string stop_signal();

}  // namespace orbweaver::drivers
