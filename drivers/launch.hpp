#pragma once

#include <string>
#include <vector>

namespace orbweaver::drivers {

/// How a command is started on several ranks.
struct Launch {
  int ranks = 1;
  bool stops_on_signals = false;  ///< the command ends resumable on SIGUSR1 (signals.hpp); else signals end it
};

/// Runs `words`, a command line without the program's name, on ranks of this program by mpirun, with one thread each,
/// and without what mpirun says of statuses other than 0. SIGTERM, SIGUSR1 and SIGINT reach the ranks; signals are held
/// (hold_signals). The status of the ranks. Throws EnvironmentError where mpirun is missing or cannot start them, and
/// where a signal has ended one.
[[nodiscard]] int launch(const Launch& options, const std::vector<std::string>& words);

/// True in a process that mpirun has started. The first of `launch` says so.
[[nodiscard]] bool is_launched();

/// On the first rank of an mpirun that `launch` has not started, before the process ends with a status other than 0:
/// mpirun then says much that hides the message, and how to leave that out.
void tell_of_mpirun(int status);

}  // namespace orbweaver::drivers
