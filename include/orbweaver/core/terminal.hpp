#pragma once

#include <cstddef>

namespace orbweaver::core {

/// What appears where a stream is written to.
struct Terminal {
  bool reached = false;    ///< a terminal shows it: the stream's own, or that of the mpirun that started this rank here
  std::size_t width = 80;  ///< columns: the terminal's, else those of COLUMNS, else 80
  bool redraws = false;    ///< it is reached, and TERM is not `dumb`: lines can be drawn anew
  bool colours = false;    ///< it redraws, and NO_COLOR is not set (https://no-color.org)
  bool unicode = false;    ///< the locale's characters are UTF-8
};

/// Of STDOUT_FILENO or STDERR_FILENO, as it is now. Since mpirun hands every rank a pipe or a terminal of its own, what
/// counts under it is what mpirun itself writes to, if it runs on this machine.
[[nodiscard]] Terminal terminal_of(int stream);

}  // namespace orbweaver::core
