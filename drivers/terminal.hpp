#pragma once

namespace orbweaver::drivers {

/// True where what this rank writes to stderr appears on a terminal: its own stderr, or, since mpirun hands every rank
/// a pipe, that of the mpirun that started it on this machine.
[[nodiscard]] bool stderr_reaches_terminal();

}  // namespace orbweaver::drivers
