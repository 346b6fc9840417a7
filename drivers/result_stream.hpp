#pragma once

#include <memory>
#include <ostream>

namespace orbweaver::drivers {

/// A stream whose whole lines go to the standard output through print_result, for results too long for one text. Throws
/// EnvironmentError where they cannot be written.
class ResultStream : public std::ostream {
 public:
  ResultStream();
  ~ResultStream() override;

  /// Prints what is left.
  void finish();

 private:
  class Lines;
  std::unique_ptr<Lines> _lines;
};

}  // namespace orbweaver::drivers
