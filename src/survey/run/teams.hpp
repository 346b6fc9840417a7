#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "orbweaver/archive/schema/records.hpp"
#include "orbweaver/core/mpi/communicator.hpp"
#include "orbweaver/core/mpi/team.hpp"
#include "orbweaver/queue/executor.hpp"
#include "orbweaver/survey/run/survey.hpp"

namespace orbweaver::survey {

/// The ranks of a survey: rank 0, which keeps the queue, and teams of `team_size` ranks each, in the order of the
/// ranks. The first of a team leads it: the queue's worker, who keeps rows and outcomes. The others follow: they do
/// with it each task that it is given (docs/protocol.md, "Teams").
class Teams {
 public:
  /// Collective over `comm`. A single rank forms no team, whatever the size. Throws InputError on all ranks unless the
  /// workers can be divided into teams of that size.
  Teams(const core::Communicator& comm, int team_size);

  [[nodiscard]] bool follows() const { return _team && !_team->leads(); }
  /// The communicator of rank 0 and the leaders. Not on followers.
  [[nodiscard]] const core::Communicator& queue() const { return _queue.value(); }
  /// This rank's team; null on rank 0, and for teams of one.
  [[nodiscard]] core::Team* team() { return _team ? &*_team : nullptr; }

 private:
  std::optional<core::Communicator> _queue;
  std::optional<core::Team> _team;
};

/// Does the leader's tasks with all members of its team. Without a team: alone.
class TeamExecutor final : public queue::Executor {
 public:
  /// `member` is what every member does.
  TeamExecutor(core::Team* team, queue::Executor& member) : _team(team), _member(member) {}

  /// Gives the followers what their members are to know (GivenOrbits) before they do a branch.
  void expect(const std::string& given);
  queue::TaskOutcome execute(const queue::Task& task, queue::TaskContext& context) override;
  void take_back_rows(bool flushed) override { _member.take_back_rows(flushed); }

 private:
  core::Team* _team;
  queue::Executor& _member;
};

/// Ends the leader's survey for the followers of its team, who return its summary's numbers or throw the like of
/// `error`.
void dismiss(core::Team* team, const Summary& summary);
void dismiss(core::Team* team, const std::exception_ptr& error);

/// What a follower does: every task of its leader, until it is dismissed. `rows` is where `member` puts rows; they are
/// the leader's, and dropped here. `expect` takes what TeamExecutor::expect gives. Throws what the leader was dismissed
/// with.
[[nodiscard]] Summary follow(
    core::Team& team, queue::Executor& member, archive::Records& rows,
    const std::function<void(const std::string&)>& expect = [](const std::string&) {});

}  // namespace orbweaver::survey
