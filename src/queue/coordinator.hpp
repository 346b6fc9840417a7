#pragma once

#include <set>
#include <string>
#include <vector>

#include "channel.hpp"
#include "deadlines.hpp"
#include "flush_round.hpp"
#include "flush_schedule.hpp"
#include "ledger.hpp"
#include "orbweaver/queue/run.hpp"
#include "own_work.hpp"

namespace orbweaver::queue {

/// Rank 0 of a run: hands out tasks, gathers outcomes and leads flushes. In between it does tasks itself where there
/// are few ranks (Options::root_works_up_to), and sleeps where there are more.
class Coordinator final : private OwnWork::Duties {
 public:
  Coordinator(const core::Communicator& comm, const Options& options, Executor& executor, Observer& observer,
              Flusher& flusher);

  RunSummary run(std::vector<Task> initial);

 private:
  void serve();
  void part(const std::string& error);
  void note_load(const Received& received);
  bool receive_some();
  bool pass_on_stop();
  bool advance_flush(bool stands);
  bool check_deadlines();
  bool hand_out();
  bool work_itself();
  [[nodiscard]] bool work_over() const;
  void flush_together();
  void end_flush();

  void count_rows(std::int64_t rows) override;
  void tell(const std::string& key, const Progress& progress) override { _ledger.report(key, progress, 0); }
  void attend(bool stands) override { static_cast<void>(attended(stands)); }
  [[nodiscard]] bool stopping() const override { return _stopping; }
  bool attended(bool stands);

  void accept(int worker, Message&& message);
  void accept(int worker, const Hello& hello);
  void accept(int worker, Outcome&& outcome);
  void accept(int worker, const ProgressReport& report);
  [[noreturn]] void refuse(int worker, Tag tag) const;

  const core::Communicator& _comm;
  const Options& _options;
  Flusher& _flusher;
  Channel _channel;
  Ledger _ledger;
  bool _works;
  OwnWork _own;
  FlushSchedule _schedule;
  FlushRound _round;
  Deadlines _deadlines;
  std::vector<std::string> _task_of;  // by rank; empty: none
  std::vector<bool> _greeted;         // by rank
  std::set<int> _idle;
  bool _stopping = false;
  bool _last_round = false;
  bool _over = false;
};

}  // namespace orbweaver::queue
