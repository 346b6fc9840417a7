#pragma once

#include <chrono>
#include <map>
#include <memory>
#include <string>

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
  long printed = 0;  // orbits at the last plain line
  std::string end;
  std::chrono::steady_clock::time_point began = std::chrono::steady_clock::now();
  std::chrono::steady_clock::time_point changed = began;
};

/// Shows progress on stderr: a line a family, redrawn in place on a terminal, or a plain line now and then.
class ProgressDisplay : public queue::Observer {
 public:
  /// `units` are those of the outcomes' numbers.
  explicit ProgressDisplay(Display style, Units units = {}) : _style(style), _units(std::move(units)) {}

  void started(const queue::Task& task, int rank) override;
  void progress(const queue::Task& task, const queue::Progress& progress, int rank) override;
  void finished(const queue::Task& task, const queue::TaskOutcome& outcome) override;
  void failed(const queue::Task& task, const queue::TaskOutcome& outcome) override;
  void tick(const queue::TaskCounts& counts) override;

 private:
  void ended(const queue::Task& task, const queue::TaskOutcome& outcome);
  void redraw();
  void print_line(FamilyState& family);

  Display _style;
  Units _units;
  std::map<std::string, FamilyState> _families;
  int _drawn = 0;
  std::chrono::steady_clock::time_point _last = std::chrono::steady_clock::now();
};

}  // namespace orbweaver::survey
