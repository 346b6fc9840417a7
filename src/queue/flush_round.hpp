#pragma once

#include <map>
#include <string>
#include <vector>

namespace orbweaver::queue {

/// "flush 3 failed on rank 2: no space left"; `errors` by rank, not empty.
[[nodiscard]] std::string flush_failed_text(int number, const std::map<int, std::string>& errors, int ranks);
/// What every rank throws when a run cannot go on.
[[nodiscard]] std::string run_ended_text(const std::string& error);

/// Rank 0's view of the flush under way: who has answered, and what went wrong.
class FlushRound {
 public:
  enum class Phase {
    none,
    gathering,  ///< requested; workers answer when they stand still
    flushing,   ///< all are inside, or have come out of, the flush
  };

  explicit FlushRound(int ranks) : _ranks(ranks), _answered(static_cast<std::size_t>(ranks), false) {}

  [[nodiscard]] Phase phase() const noexcept { return _phase; }
  /// Of the flush under way, or else of the next one.
  [[nodiscard]] int number() const noexcept { return _number; }
  /// Whether every worker has answered in this phase.
  [[nodiscard]] bool complete() const noexcept { return _answers == _ranks - 1; }

  void request() { enter(Phase::gathering); }
  void go() { enter(Phase::flushing); }
  /// These two throw EnvironmentError for an answer that nobody asked for.
  void ready(int worker, int number);
  void done(int rank, int number, const std::string& error);
  void own_result(const std::string& error);
  /// Ends the round. Throws EnvironmentError if the flush failed anywhere.
  void end();

 private:
  void enter(Phase phase);
  void answer(int worker, int number, Phase expected, const char* what);

  int _ranks;
  Phase _phase = Phase::none;
  int _number = 0;
  std::vector<bool> _answered;
  int _answers = 0;
  std::map<int, std::string> _errors;
};

}  // namespace orbweaver::queue
