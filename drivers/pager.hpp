#pragma once

#include <sys/types.h>

#include "orbweaver/core/terminal.hpp"

namespace orbweaver::drivers {

/// While it lives, what is written to the standard output of a terminal can be leafed through: by the program that
/// PAGER names, or by `less`, which ends at once where all fits on the screen. Elsewhere, with PAGER empty or `cat`,
/// and where there is no such program, nothing changes. Leaving the pager before the end ends the program with status
/// 0.
class Pager {
 public:
  Pager();
  ~Pager();
  Pager(const Pager&) = delete;
  Pager& operator=(const Pager&) = delete;

  /// The terminal of the standard output, as it was before.
  [[nodiscard]] const core::Terminal& terminal() const { return _terminal; }

 private:
  core::Terminal _terminal;
  pid_t _process = 0;
};

}  // namespace orbweaver::drivers
