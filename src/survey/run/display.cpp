#include "display.hpp"

#include <cstdio>

#include <fmt/format.h>

#include "orbweaver/core/log/log.hpp"
#include "tasks/payload/work.hpp"
#include "tree/end_text.hpp"

namespace orbweaver::survey {

namespace {

using Clock = std::chrono::steady_clock;
constexpr std::size_t narrowest_terminal = 79;  // a line that wraps would spoil the redrawing
constexpr int most_live_lines = 16;
constexpr auto time_between_lines = std::chrono::seconds(5);

std::string line_of(const FamilyState& f, const std::string& level) {
  if (f.orbits == 0 && !f.running) return fmt::format("{:<10} {:>5} orbits  {}", f.name, f.orbits, f.end);
  const double seconds = std::chrono::duration<double>(f.changed - f.began).count();
  const std::string rate = seconds > 0.0 ? fmt::format("{:.1f} orbits/s", static_cast<double>(f.orbits) / seconds) : "";
  return fmt::format("{:<10} {:>5} orbits  T {:<8.4f} {} {:<10.6f} K {:<4} {}", f.name, f.orbits, f.period, level,
                     f.level, f.cutoff, f.running ? rate : f.end);
}

}  // namespace

void ProgressDisplay::started(const queue::Task& task, int) {
  if (kind_of(task) != TaskKind::branch) return;
  _families[task.key].name = unpack_branch_work(task.payload).name;
}

void ProgressDisplay::progress(const queue::Task& task, const queue::Progress& progress, int) {
  if (kind_of(task) != TaskKind::branch || progress.values.size() < 3) return;
  FamilyState& f = _families[task.key];
  f.orbits = progress.step;
  f.period = progress.values[0];
  f.level = progress.values[1];
  f.cutoff = static_cast<int>(progress.values[2]);
  f.changed = Clock::now();
}

void ProgressDisplay::ended(const queue::Task& task, const queue::TaskOutcome& outcome) {
  if (kind_of(task) != TaskKind::branch) return;
  FamilyState& f = _families[task.key];
  f.running = false;
  f.changed = Clock::now();
  f.end = outcome.reason;
  if (!outcome.payload.empty()) {
    const BranchOutcome branch = unpack_branch_outcome(outcome.payload);
    f.orbits = branch.orbits;
    f.period = branch.last_period;
    f.level = branch.last_level;
    f.cutoff = branch.last_cutoff;
    f.end = end_text(branch, _units);
  }
  if (_style == Display::lines) print_line(f);
  if (_style == Display::live) redraw();
  _families.erase(task.key);
}

void ProgressDisplay::finished(const queue::Task& task, const queue::TaskOutcome& outcome) { ended(task, outcome); }
void ProgressDisplay::failed(const queue::Task& task, const queue::TaskOutcome& outcome) { ended(task, outcome); }

void ProgressDisplay::tick(const queue::TaskCounts&) {
  if (_style == Display::none) return;
  if (_style == Display::live) {
    redraw();
    return;
  }
  if (Clock::now() - _last < time_between_lines) return;
  _last = Clock::now();
  for (auto& [key, family] : _families)
    if (family.running && family.orbits > family.printed) print_line(family);
}

void ProgressDisplay::print_line(FamilyState& family) {
  family.printed = family.orbits;
  core::write_line(stderr, line_of(family, _units.level_name()));
}

// Lines of running families at the bottom, redrawn in place; what has ended stays above them.
void ProgressDisplay::redraw() {
  std::string text = _drawn > 0 ? fmt::format("\x1b[{}A\x1b[J", _drawn) : "";
  int lines = 0;
  int running = 0;
  const auto add = [&](const FamilyState& f) {
    text +=
        fmt::format("{}{}", lines++ == 0 ? "" : "\n", line_of(f, _units.level_name()).substr(0, narrowest_terminal));
  };
  for (const auto& [key, family] : _families)
    if (!family.running) add(family);
  for (const auto& [key, family] : _families)
    if (family.running && running < most_live_lines) {
      ++running;
      add(family);
    }
  _drawn = running;
  if (lines > 0) core::write_line(stderr, text);
}

}  // namespace orbweaver::survey
