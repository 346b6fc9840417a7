#pragma once

namespace orbweaver::queue {

/// Writes what the ranks have gathered.
class Flusher {
 public:
  virtual ~Flusher() = default;

  /// Collective over all ranks of the run, each between two steps of its work; `number` counts from 0. When it throws
  /// on any rank the run ends on all of them with EnvironmentError. An implementation that uses MPI collectives must
  /// let no rank leave before the last of them: agree first, then throw.
  virtual void flush(int number) = 0;
};

}  // namespace orbweaver::queue
