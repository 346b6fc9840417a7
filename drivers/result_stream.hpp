#pragma once

#include <memory>
#include <ostream>

#include "orbweaver/core/terminal.hpp"

namespace orbweaver::drivers {

/// A stream whose whole lines go to the standard output, escaped (core::printable_lines), for results too long for one
/// text. On a terminal with colours it shows styles (core/styled.hpp). Throws EnvironmentError where lines cannot be
/// written.
class ResultStream : public std::ostream {
 public:
  /// `terminal` is that of the standard output, before a pager takes its place.
  explicit ResultStream(const core::Terminal& terminal);
  ResultStream();
  ~ResultStream() override;

  /// Prints what is left.
  void finish();

 private:
  class Lines;
  std::unique_ptr<Lines> _lines;
};

}  // namespace orbweaver::drivers
