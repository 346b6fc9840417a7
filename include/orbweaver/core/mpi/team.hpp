#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <mpi.h>

#include "orbweaver/core/error.hpp"
#include "orbweaver/core/mpi/communicator.hpp"

namespace orbweaver::core {

/// The members of a team are no longer doing the same thing: one of them failed alone, or their numbers differ. Not a
/// NumericalError: nothing goes on from here but the end of the task.
class TeamError : public EnvironmentError {
 public:
  using EnvironmentError::EnvironmentError;
};

/// Ranks that do one task together. Every member runs the same code on the same numbers; where work is costly each does
/// its part, and all get the parts of all, so that their numbers stay the same bit by bit. All functions but the
/// observers are collective over the team.
///
/// Members meet at every exchange: each says at which step of the task it is, at which place in the code, and how its
/// part went. A member that failed alone meets the others wherever they are, so nobody is left waiting: all throw
/// TeamError there, the team has fallen apart (`fallen_apart`), and nothing is exchanged before the next task
/// (`begin`). That holds because every collective call of a team begins with this meeting: nothing else may use its
/// communicator, no solver of a library either.
class Team {
 public:
  /// Duplicates `comm`.
  explicit Team(MPI_Comm comm);

  [[nodiscard]] int rank() const { return _comm.rank(); }
  [[nodiscard]] int size() const { return _comm.size(); }
  [[nodiscard]] bool leads() const { return _comm.is_root(); }

  /// A member's part of `count` things: contiguous, in the order of the members.
  struct Part {
    int begin = 0;
    int end = 0;
  };
  [[nodiscard]] Part part_of(int member, int count) const {
    const auto until = [&](std::int64_t m) { return static_cast<int>(m * count / size()); };
    return {until(member), until(member + 1)};
  }

  /// Does `work(begin, end)` for this member's part of `count` things, each of which fills `width` of the `values`
  /// (count x width), then gives every member the whole of them. If work throws a NumericalError on a member, all throw
  /// it; anything else is a TeamError for all. `place` names the call and must differ from others.
  void divide(std::string_view place, int count, int width, double* values,
              const std::function<void(int begin, int end)>& work);
  /// Does all of `work` on every member, with the same rule for errors.
  void together(std::string_view place, const std::function<void()>& work);
  /// Throws TeamError on all members unless all are at this place with the same `digest`.
  void compare(std::string_view place, std::uint64_t digest);
  /// Gives every member the leader's bytes. Those who wait for the leader sleep meanwhile. Throws TeamError where a
  /// member has come to another place.
  void broadcast(std::string& bytes);

  /// Before a task, and before the word that gives it: whatever happened in the last one is forgotten.
  void begin();
  /// At the end of a task, for a member that came through or failed (`error`: its text), with what has this `digest`.
  /// Throws TeamError where not all came to the same end; returns if the team has fallen apart already.
  void end(const std::optional<std::string>& error, std::uint64_t digest);
  /// What happened, if the team has fallen apart.
  [[nodiscard]] const std::optional<std::string>& fallen_apart() const { return _fallen_apart; }

 private:
  struct Problem;
  /// What a member says when it meets the others.
  struct Word {
    std::uint64_t step;
    std::uint64_t place;
    std::uint64_t digest;
    std::uint64_t kind;
  };
  enum class Waiting { awake, asleep };
  [[nodiscard]] MPI_Comm comm() const { return _comm.get(); }
  static Problem attempt(const std::function<void()>& work);
  void meet(std::string_view place, std::uint64_t digest, const Problem& problem, Waiting waiting = Waiting::awake);

  Communicator _comm;
  std::vector<Word> _words;  ///< of all members
  std::uint64_t _step = 0;
  std::optional<std::string> _fallen_apart;
};

/// The team where there is one to divide work among: null for none and for a team of one.
[[nodiscard]] inline Team* several(Team* team) { return team != nullptr && team->size() > 1 ? team : nullptr; }
/// The same, and null for systems of fewer coordinates than repay the exchange (measured: docs/performance.md).
[[nodiscard]] inline Team* worth_dividing(Team* team, int dimension) { return dimension < 8 ? nullptr : several(team); }

/// A number that tells byte strings apart (FNV-1a, 64 bits).
[[nodiscard]] std::uint64_t digest_of(std::string_view bytes);

}  // namespace orbweaver::core
