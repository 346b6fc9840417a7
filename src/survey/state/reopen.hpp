#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "checkpoint.hpp"
#include "orbweaver/scene/scene.hpp"

namespace orbweaver::survey {

/// Bits of Limit (task_kind.hpp) for the limits that lie farther out in `now`.
[[nodiscard]] int widened_limits(const scene::Scene& before, const scene::Scene& now);

/// Bits of Limit on which the end of a task rests: with these limits wider it is done again, or goes on. 0: it never
/// is.
[[nodiscard]] int limits_of(const EndedTask& entry);

/// Decides, entry by entry in the order in which tasks ended, what a survey with wider limits keeps. What ended at one
/// of them waits again in the checkpoint, from where it would have gone on; what was found behind that place, and the
/// rows that it made, no longer count.
class Reopening {
 public:
  /// `folder`: where stored payloads lie.
  Reopening(int widened, Checkpoint& checkpoint, std::filesystem::path folder = {})
      : _widened(widened), _checkpoint(checkpoint), _folder(std::move(folder)) {}

  /// False for a task that is done again, or that followed from what is.
  [[nodiscard]] bool stays(const EndedTask& entry);
  /// After the last entry: drops the same from the tasks that wait, and adds those to be done again.
  void finish();
  /// Whether anything is to be done again.
  [[nodiscard]] bool any() const { return !_again.empty(); }

 private:
  /// Events of a branch from an ordinal on.
  struct Behind {
    std::string branch;
    int first_event = 0;
  };

  [[nodiscard]] bool is_behind(const std::string& key) const;
  [[nodiscard]] bool is_limited(const EndedTask& entry) const;
  void reopen(const EndedTask& entry);
  void drop(const queue::Task& task);
  void go_back(queue::Task& running);
  void forget_rows(const queue::Task& branch, int from);

  int _widened;
  Checkpoint& _checkpoint;
  std::filesystem::path _folder;
  std::vector<Behind> _behind;
  std::vector<std::string> _whole;  // branches of which nothing stays
  std::vector<queue::Task> _again;
};

}  // namespace orbweaver::survey
