#include "orbweaver/core/mpi/team.hpp"

#include <algorithm>
#include <chrono>
#include <climits>
#include <thread>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "orbweaver/core/mpi/check_mpi.hpp"
#include "orbweaver/core/mpi/collective.hpp"

namespace orbweaver::core {

struct Team::Problem {
  Failure failure;
  bool is_alike = false;  ///< fine if all have it
};

namespace {

constexpr std::size_t words = 4;
/// What a word says in place of a FailureKind where the failure is fine if all have it.
constexpr std::uint64_t alike_word = ~std::uint64_t{0};

/// Sleeps until `request` is done: short at first, then up to 2 ms.
void wait_asleep(MPI_Request& request) {
  std::chrono::microseconds sleep{50};
  for (;;) {
    int done = 0;
    check_mpi(MPI_Test(&request, &done, MPI_STATUS_IGNORE), "MPI_Test");
    if (done != 0) return;
    std::this_thread::sleep_for(sleep);
    sleep = std::min(sleep + sleep / 4, std::chrono::microseconds(2000));
  }
}

}  // namespace

std::uint64_t digest_of(std::string_view bytes) {
  std::uint64_t digest = 14695981039346656037U;
  for (const char c : bytes) digest = (digest ^ static_cast<unsigned char>(c)) * 1099511628211U;
  return digest;
}

Team::Team(MPI_Comm comm) : _comm(comm), _words(static_cast<std::size_t>(size())) {}

void Team::begin() {
  _fallen_apart.reset();
  _step = 0;
}

Team::Problem Team::attempt(const std::function<void()>& work) {
  Failure failure = core::attempt(work);
  try {
    if (failure) raise(failure);
  } catch (const TeamError&) {
    throw;  // met already
  } catch (...) {
  }
  return {std::move(failure)};
}

void Team::meet(std::string_view place, std::uint64_t digest, const Problem& problem, Waiting waiting) {
  if (_fallen_apart) throw TeamError(*_fallen_apart);
  const std::uint64_t kind = problem.is_alike ? alike_word : static_cast<std::uint64_t>(problem.failure.kind);
  const Word mine{++_step, digest_of(place), digest, kind};
  std::vector<Word>& all = _words;
  MPI_Request request = MPI_REQUEST_NULL;
  check_mpi(MPI_Iallgather(&mine, words, MPI_UINT64_T, all.data(), words, MPI_UINT64_T, comm(), &request),
            "MPI_Iallgather");
  if (waiting == Waiting::asleep)
    wait_asleep(request);
  else
    check_mpi(MPI_Wait(&request, MPI_STATUS_IGNORE), "MPI_Wait");
  int speaker = -1;  // the first with a problem
  bool together = true;
  bool alike = true;
  for (int m = 0; m < size(); ++m) {
    const Word& word = all[static_cast<std::size_t>(m)];
    if (speaker < 0 && word.kind != 0) speaker = m;
    together = together && word.step == all[0].step && word.place == all[0].place && word.digest == all[0].digest;
    alike = alike && word.kind == alike_word;
  }
  if (together && (speaker < 0 || alike)) return;
  // Whatever is thrown from here on, nobody meets this member again before the next task, unless all throw the same.
  std::string& text = _fallen_apart.emplace();
  if (speaker >= 0) {
    char buffer[1024] = {};
    problem.failure.text.copy(buffer, sizeof buffer - 1);
    check_mpi(MPI_Bcast(buffer, sizeof buffer, MPI_CHAR, speaker, comm()), "MPI_Bcast");
    text = buffer;
    const auto speakers = static_cast<FailureKind>(all[static_cast<std::size_t>(speaker)].kind);
    const bool is_numerical = speakers == FailureKind::not_finite || speakers == FailureKind::numerical;
    if (together && is_numerical) {
      const Failure all_have{speakers, text, {}};
      _fallen_apart.reset();
      raise(all_have);
    }
    text = fmt::format("member {} of a team of {} failed: {}", speaker, size(), text);
  } else {
    text = fmt::format(
        "the members of a team of {} came to different numbers or different places (member 0 at step {}); are their "
        "CPUs of one type?",
        size(), all[0].step);
  }
  throw TeamError(text);
}

void Team::divide(std::string_view place, int count, int width, double* values,
                  const std::function<void(int, int)>& work) {
  const Part mine = part_of(rank(), count);
  std::vector<int> counts;
  std::vector<int> starts;
  const auto prepare = [&] {
    for (int m = 0; m < size(); ++m) {
      const Part part = part_of(m, count);
      counts.push_back(part.end - part.begin);
      starts.push_back(part.begin);
    }
    work(mine.begin, mine.end);
  };
  meet(place, static_cast<std::uint64_t>(count), attempt(prepare));
  if (size() == 1) return;
  MPI_Datatype thing = MPI_DATATYPE_NULL;
  check_mpi(MPI_Type_contiguous(width, MPI_DOUBLE, &thing), "MPI_Type_contiguous");
  check_mpi(MPI_Type_commit(&thing), "MPI_Type_commit");
  const int code =
      MPI_Allgatherv(MPI_IN_PLACE, 0, MPI_DATATYPE_NULL, values, counts.data(), starts.data(), thing, comm());
  MPI_Type_free(&thing);
  check_mpi(code, "MPI_Allgatherv");
}

void Team::together(std::string_view place, const std::function<void()>& work) { meet(place, 0, attempt(work)); }

void Team::compare(std::string_view place, std::uint64_t digest) { meet(place, digest, {}); }

void Team::end(const std::optional<std::string>& error, std::uint64_t digest) {
  if (_fallen_apart) return;
  if (error) digest ^= digest_of(*error);
  meet("the end of a task", digest, error ? Problem{{FailureKind::other, *error, {}}, true} : Problem{});
}

void Team::broadcast(std::string& bytes) {
  const Problem problem =
      attempt([&] { require(bytes.size() <= INT_MAX, "bytes for a team are more than MPI can send"); });
  meet("the leader's bytes", 0, problem, Waiting::asleep);
  auto length = static_cast<std::uint64_t>(bytes.size());
  detail::broadcast_bytes(comm(), &length, sizeof length, 0);
  together("room for the leader's bytes", [&] { bytes.resize(length); });
  detail::broadcast_bytes(comm(), bytes.data(), length, 0);
}

}  // namespace orbweaver::core
