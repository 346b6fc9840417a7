#pragma once

#include <chrono>
#include <cstddef>
#include <deque>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "orbweaver/queue/observer.hpp"
#include "orbweaver/survey/run/survey.hpp"
#include "tasks/units.hpp"

namespace orbweaver::survey {

/// Where a family stands, as far as rank 0 has heard.
struct FamilyState {
  std::string name;
  long orbits = 0;
  double period = 0.0;
  double level = 0.0;  // energy or parameter
  int cutoff = 0;
  bool running = true;
  bool failed = false;
  bool resumed = false;  // its first report counts orbits of an earlier run
  long printed = 0;      // orbits at the last plain line
  std::string end;
  std::chrono::steady_clock::time_point began = std::chrono::steady_clock::now();
  std::chrono::steady_clock::time_point changed = began;
};

/// Where the survey stands as a whole.
struct WholeState {
  std::size_t done = 0;   ///< tasks, those that failed among them
  std::size_t known = 0;  ///< with those that wait or run
  std::size_t failed = 0;
  std::optional<long> orbits = 0;  ///< of this run; none where the tasks follow no families
  double orbits_a_second = 0.0;
  double seconds = 0.0;
  std::optional<double> left{};  ///< seconds; only where that can be said
  bool at_most = false;          ///< `left` is when a limit of time ends the run
};

/// The family in at most `width` columns: what has the least to say is left out first, then its name is cut.
[[nodiscard]] std::string line_of(const FamilyState& family, const std::string& level, std::size_t width);

/// The whole in at most `width` columns: what has the least to say is left out. With a bar where there is room.
[[nodiscard]] std::string text_of(const WholeState& whole, std::size_t width);
[[nodiscard]] std::string line_of(const WholeState& whole, std::size_t width, bool unicode);

/// Shows progress on stderr: a bar for the whole and a line a family, redrawn in place on a terminal and within its
/// width, or a plain line now and then.
class ProgressDisplay : public queue::Observer {
 public:
  /// `units` are those of the outcomes' numbers; `allowed` the seconds after which a limit of time ends the run.
  explicit ProgressDisplay(Display style, Units units = {}, double allowed = no_limit)
      : _style(style), _units(std::move(units)), _allowed(allowed) {}
  ~ProgressDisplay() override { finish(); }
  ProgressDisplay(const ProgressDisplay&) = delete;
  ProgressDisplay& operator=(const ProgressDisplay&) = delete;

  /// The tasks follow no families and are all known: how many are done is all there is to show, by `tick` alone.
  void show_tasks_only();

  void started(const queue::Task& task, int rank) override;
  void progress(const queue::Task& task, const queue::Progress& progress, int rank) override;
  void finished(const queue::Task& task, const queue::TaskOutcome& outcome) override;
  void failed(const queue::Task& task, const queue::TaskOutcome& outcome) override;
  void tick(const queue::TaskCounts& counts) override;
  /// Clears the bar and the lines of what runs; a later tick draws them again.
  void finish() noexcept;

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr double no_limit = std::numeric_limits<double>::infinity();

  void ended(const queue::Task& task, const queue::TaskOutcome& outcome);
  void count(FamilyState& family, long orbits);
  [[nodiscard]] WholeState whole();
  void redraw();
  void print_line(FamilyState& family);

  Display _style;
  Units _units;
  double _allowed;
  std::map<std::string, FamilyState> _families;
  queue::TaskCounts _counts;
  bool _all_known = false;  ///< no task brings others
  bool _shows_orbits = true;
  long _orbits = 0;
  std::deque<std::pair<Clock::time_point, long>> _lately;  // orbits at times
  int _drawn = 0;
  Clock::time_point _began = Clock::now();
  Clock::time_point _last = _began;
};

/// Shows on stderr how many of the tasks are done that compute an archive again.
class TaskCountDisplay final : public queue::Observer {
 public:
  explicit TaskCountDisplay(Display style) : _display(style) { _display.show_tasks_only(); }
  void tick(const queue::TaskCounts& counts) override { _display.tick(counts); }

 private:
  ProgressDisplay _display;
};

}  // namespace orbweaver::survey
