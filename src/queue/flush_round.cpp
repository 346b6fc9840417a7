#include "flush_round.hpp"

#include <fmt/format.h>

#include "orbweaver/core/error.hpp"

namespace orbweaver::queue {

std::string flush_failed_text(int number, const std::map<int, std::string>& errors, int ranks) {
  const auto& [rank, text] = *errors.begin();
  if (errors.size() == 1) return fmt::format("flush {} failed on rank {}: {}", number, rank, text);
  return fmt::format("flush {} failed on {} of {} ranks, first on rank {}: {}", number, errors.size(), ranks, rank,
                     text);
}

std::string run_ended_text(const std::string& error) {
  return fmt::format("the run was ended on all ranks: {}", error);
}

void FlushRound::enter(Phase phase) {
  _phase = phase;
  _answered.assign(_answered.size(), false);
  _answers = 0;
}

void FlushRound::answer(int worker, int number, Phase expected, const char* what) {
  const auto index = static_cast<std::size_t>(worker);
  if (_phase != expected || number != _number || _answered[index])
    throw core::EnvironmentError(
        fmt::format("rank {} sent a {} for flush {}, which rank 0 did not ask for (flush {}, {})", worker, what, number,
                    _number, _answered[index] ? "answered before" : "other phase"));
  _answered[index] = true;
  ++_answers;
}

void FlushRound::ready(int worker, int number) { answer(worker, number, Phase::gathering, "flush_ready"); }

void FlushRound::done(int rank, int number, const std::string& error) {
  answer(rank, number, Phase::flushing, "flush_done");
  if (!error.empty()) _errors.emplace(rank, error);
}

void FlushRound::own_result(const std::string& error) {
  if (!error.empty()) _errors.emplace(0, error);
}

void FlushRound::end() {
  if (!_errors.empty()) throw core::EnvironmentError(flush_failed_text(_number, _errors, _ranks));
  enter(Phase::none);
  ++_number;
}

}  // namespace orbweaver::queue
