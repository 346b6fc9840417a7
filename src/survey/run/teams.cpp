#include "teams.hpp"

#include <exception>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "orbweaver/core/error.hpp"
#include "orbweaver/core/interruption.hpp"
#include "orbweaver/core/mpi/check_mpi.hpp"
#include "orbweaver/core/mpi/collective.hpp"
#include "orbweaver/queue/message.hpp"

namespace orbweaver::survey {

namespace {

/// The ranks of `comm` that give the same colour.
core::Communicator split(const core::Communicator& comm, int colour) {
  MPI_Comm part = MPI_COMM_NULL;
  core::check_mpi(MPI_Comm_split(comm.get(), colour, comm.rank(), &part), "MPI_Comm_split");
  core::Communicator own(part);
  core::check_mpi(MPI_Comm_free(&part), "MPI_Comm_free");
  return own;
}

[[noreturn]] void refuse(int ranks, int team_size) {
  std::vector<int> sizes;
  for (int size = 1; size < ranks; ++size)
    if ((ranks - 1) % size == 0) sizes.push_back(size);
  const int fewer = (ranks - 1) / team_size * team_size + 1;
  throw core::InputError(
      fmt::format("survey.team_size = {}: expected a size that divides the workers, since rank 0 keeps the queue and "
                  "the others form "
                  "the teams; got {} ranks, {} of them workers; start {}{} ranks, or set survey.team_size to {}",
                  team_size, ranks, ranks - 1, fewer > 1 ? fmt::format("{} or ", fewer) : "", fewer + team_size,
                  fmt::join(sizes, " or ")));
}

/// What a leader says to its followers: one letter, and a text.
enum class Order : char {
  task = 't',
  expect = 'k',
  state = 's',
  go_on = 'g',
  stop = 'x',
  done = 'd',
  input_error = 'i',
  error = 'e'
};

/// Collective, as `take` is of the followers. Throws TeamError where a member has left what all were doing.
void give(core::Team& team, Order order, const std::string& text = {}) {
  std::string bytes = static_cast<char>(order) + text;
  team.broadcast(bytes);
}

std::pair<Order, std::string> take(core::Team& team) {
  std::string bytes;
  team.broadcast(bytes);
  return {static_cast<Order>(bytes.at(0)), bytes.substr(1)};
}

std::uint64_t digest_of(const queue::Progress& progress) {
  std::string bytes = fmt::format("{} {}", progress.step, progress.rows);
  for (const double value : progress.values) bytes += fmt::format(" {:a}", value);
  return core::digest_of(bytes);
}

/// What the work of a member sees: reports are the leader's, and its answer is everybody's.
class MemberContext final : public queue::TaskContext {
 public:
  /// `run`: the leader's; null on followers, whose `rows` are dropped.
  MemberContext(core::Team& team, queue::TaskContext* run, archive::Records* rows)
      : _team(team), _run(run), _rows(rows) {}

  /// Throws TeamError where members have come to different reports.
  bool report(const queue::Progress& progress, const queue::StateSource& state) override {
    _team.compare("report", digest_of(progress));
    if (_run != nullptr) return lead(progress, state);
    if (_rows != nullptr) *_rows = {};
    for (;;) {
      const auto [order, text] = take(_team);
      if (order != Order::state) return order == Order::go_on;
      (void)state();
    }
  }

 private:
  bool lead(const queue::Progress& progress, const queue::StateSource& state) {
    queue::StateSource shared;  // members ask for it together, so that it leaves them alike
    if (state)
      shared = [&] {
        give(_team, Order::state);
        return state();
      };
    const bool go_on = _run->report(progress, shared);
    give(_team, go_on ? Order::go_on : Order::stop);
    return go_on;
  }

  core::Team& _team;
  queue::TaskContext* _run;
  archive::Records* _rows;
};

/// Throws what the member's work threw, or TeamError if not all came to the same end.
queue::TaskOutcome do_together(core::Team& team, const std::function<queue::TaskOutcome()>& work) {
  queue::TaskOutcome outcome;
  std::uint64_t digest = 0;
  const core::Failure thrown = core::attempt([&] {
    outcome = work();
    digest = core::digest_of(queue::pack(queue::Outcome{outcome, 0}));
  });
  std::optional<std::string> error;
  if (thrown)
    error = thrown.text;
  else if (outcome.failed)
    error = outcome.reason;
  team.end(error, digest);
  if (thrown) core::raise(thrown);
  // What the work has made of the team's end may say that it failed; it must not say that it came through.
  if (team.fallen_apart() && !outcome.failed) throw core::TeamError(*team.fallen_apart());
  return outcome;
}

}  // namespace

Teams::Teams(const core::Communicator& comm, int team_size) {
  const int ranks = comm.size();
  if (ranks == 1 || team_size == 1) {
    _queue.emplace(comm.get());
    return;
  }
  if ((ranks - 1) % team_size != 0) refuse(ranks, team_size);
  const int worker = comm.rank() - 1;
  const bool leads = worker % team_size == 0;
  core::Communicator queue = split(comm, comm.is_root() || leads ? 0 : 1);
  core::Communicator members = split(comm, comm.is_root() ? 0 : 1 + worker / team_size);
  if (comm.is_root() || leads) _queue.emplace(std::move(queue));
  if (!comm.is_root()) _team.emplace(members.get());
}

void TeamExecutor::expect(const std::string& given) {
  if (_team == nullptr) return;
  _team->begin();
  give(*_team, Order::expect, given);
}

queue::TaskOutcome TeamExecutor::execute(const queue::Task& task, queue::TaskContext& context) {
  if (_team == nullptr) return _member.execute(task, context);
  const core::InterruptionScope whole(nullptr);  // the others would wait for this one
  _team->begin();
  give(*_team, Order::task, queue::pack(queue::Assign{task}));
  MemberContext shared(*_team, &context, nullptr);
  return do_together(*_team, [&] { return _member.execute(task, shared); });
}

void dismiss(core::Team* team, const Summary& summary) {
  if (team == nullptr) return;
  team->begin();
  give(*team, Order::done, fmt::format("{} {}", summary.failures, summary.stopped_early ? 1 : 0));
}

void dismiss(core::Team* team, const std::exception_ptr& error) {
  if (team == nullptr) return;
  const core::Failure failure = core::attempt([&] { std::rethrow_exception(error); });
  const bool is_input = failure.kind == core::FailureKind::input || failure.kind == core::FailureKind::newer_version;
  team->begin();
  give(*team, is_input ? Order::input_error : Order::error, failure.text);
}

Summary follow(core::Team& team, queue::Executor& member, archive::Records& rows,
               const std::function<void(const std::string&)>& expect) {
  for (;;) {
    team.begin();
    const auto [order, text] = take(team);
    if (order == Order::expect) {
      expect(text);
      continue;
    }
    if (order == Order::input_error) throw core::InputError(text);
    if (order == Order::error) throw core::EnvironmentError(text);
    if (order == Order::done) {
      Summary summary;
      summary.failures = std::stoul(text);
      summary.stopped_early = text.back() == '1';
      return summary;
    }
    MemberContext context(team, nullptr, &rows);
    try {
      (void)do_together(team, [&] {
        const auto assign = std::get<queue::Assign>(queue::unpack(text, "from the leader of the team"));
        return member.execute(assign.task, context);
      });
    } catch (...) {  // the leader tells
    }
    rows = {};
  }
}

}  // namespace orbweaver::survey
