#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "orbweaver/core/mpi/communicator.hpp"
#include "orbweaver/queue/executor.hpp"
#include "orbweaver/queue/flusher.hpp"
#include "orbweaver/queue/observer.hpp"
#include "orbweaver/queue/task.hpp"

namespace orbweaver::queue {

/// How a run behaves. The same on all ranks. None of it changes an outcome.
struct Options {
  double flush_seconds = 5.0;      ///< a flush this long after the last one; 0: none by time
  std::int64_t flush_rows = 5000;  ///< a flush after this many reported rows; 0: none by amount
  /// Flushes take about this share of the run at most, as long as that needs no more than ten times flush_seconds
  /// between two: a flush that took t seconds from its request to its end is followed by t / flush_share without one.
  /// None is put off where there are flush_rows rows for each rank that works.
  double flush_share = 0.03;
  /// Least time (s) between two progress messages of a worker; longer with more than 1000 x this many workers, so that
  /// rank 0 never gets more than about 1000 of them a second.
  double progress_seconds = 0.2;
  /// A task that runs longer (s, without flushes) is told to stop at its next report and put aside with its state: the
  /// run goes on with the others and ends as stopped early. If it has not ended after the same time again, the program
  /// ends on all ranks with exit status 3. 0: no limit.
  double task_seconds = 0.0;
  /// Running tasks that have not ended so long (s, without flushes) after a stop was asked for end the program in the
  /// same way. 0: no limit. Stops were obeyed within 4.3 s on a machine that was used thirtyfold (docs/reliability.md).
  double stop_seconds = 10.0;
  /// With so many ranks or fewer, rank 0 does tasks too, between messages: it would only wait otherwise, half of the
  /// machine with two ranks. With more, a worker would wait for it longer than its help is worth.
  int root_works_up_to = 4;
  double tick_seconds = 0.1;                     ///< between two ticks of the observer
  std::chrono::microseconds shortest_sleep{50};  ///< of a rank that waits; grows until something happens, up to:
  std::chrono::microseconds longest_sleep{2000};
  bool keep_outcomes = false;  ///< whether RunSummary::outcomes is filled (memory grows with the run)
};

struct Failure {
  std::string key;
  std::string reason;

  friend bool operator==(const Failure&, const Failure&) = default;
};

/// What one rank did.
struct RankLoad {
  std::int64_t tasks = 0;
  double busy_seconds = 0.0;  ///< inside Executor::execute, without flushes
};

/// How a run ended. The numbers are known on all ranks, the lists on rank 0 only.
struct RunSummary {
  std::size_t done = 0;  ///< with those left out
  std::size_t failed = 0;
  std::size_t waiting = 0;     ///< not finished: only after an early stop, or put aside
  std::size_t stopped = 0;     ///< those of them that were running when the stop came, or were put aside
  bool stopped_early = false;  ///< work was left undone
  int flushes = 0;             ///< with the one at the end
  std::int64_t rows = 0;       ///< all that was reported
  double seconds = 0.0;
  std::vector<Failure> failures;       ///< by key
  std::vector<std::string> put_aside;  ///< keys of tasks that took longer than Options::task_seconds, sorted
  std::vector<TaskOutcome> outcomes;   ///< by key; empty unless Options::keep_outcomes
  std::vector<RankLoad> loads;         ///< one a rank
};

/// Does `initial` and all children of it. Collective over `comm`; docs/protocol.md tells how.
///
/// Rank 0 keeps the queue, whose order everybody is given tasks in; with few ranks (Options::root_works_up_to) it also
/// does tasks itself, with one all of them. No rank spins while it waits. `initial` and `observer` count on rank 0
/// only. Nobody else may send on `comm` meanwhile, except within a collective flush.
///
/// A task that the observer does not want counts as done. A task that fails is recorded and the run goes on. The run
/// ends with the same EnvironmentError on all ranks when a flush or the observer throws, when a key comes twice, or
/// when a message is torn, foreign, or of another version. Throws MisuseError for options out of range, on every rank
/// alike.
RunSummary run(const core::Communicator& comm, const Options& options, std::vector<Task> initial, Executor& executor,
               Observer& observer, Flusher& flusher);

}  // namespace orbweaver::queue
