#include "display.hpp"

#include <cstdio>

#include <fmt/format.h>

#include "orbweaver/core/log.hpp"
#include "orbweaver/survey/work.hpp"

namespace orbweaver::survey {

namespace {

using Clock = std::chrono::steady_clock;
constexpr std::size_t narrowest_terminal = 79;  // a line that wraps would spoil the redrawing
constexpr auto time_between_lines = std::chrono::seconds(5);

std::string line_of(const FamilyState& f) {
  const double seconds = std::chrono::duration<double>(f.changed - f.began).count();
  const std::string rate = seconds > 0.0 ? fmt::format("{:.1f} orbits/s", static_cast<double>(f.orbits) / seconds) : "";
  return fmt::format("{:<10} {:>5} orbits  T {:<8.4f} E {:<10.6f} K {:<4} {}", f.name, f.orbits, f.period, f.energy,
                     f.cutoff, f.running ? rate : f.end);
}

}  // namespace

void ProgressDisplay::started(const queue::Task& task, int) {
  if (task.kind != branch_kind) return;
  _families[task.key].name = unpack_branch_work(task.payload).name;
}

void ProgressDisplay::progress(const queue::Task& task, const queue::Progress& progress, int) {
  if (task.kind != branch_kind || progress.values.size() < 3) return;
  FamilyState& f = _families[task.key];
  f.orbits = progress.step;
  f.period = progress.values[0];
  f.energy = progress.values[1];
  f.cutoff = static_cast<int>(progress.values[2]);
  f.changed = Clock::now();
}

void ProgressDisplay::ended(const queue::Task& task, const queue::TaskOutcome& outcome) {
  if (task.kind != branch_kind) return;
  FamilyState& f = _families[task.key];
  f.running = false;
  f.changed = Clock::now();
  f.end = outcome.reason;
  if (!outcome.payload.empty()) {
    const BranchOutcome branch = unpack_branch_outcome(outcome.payload);
    f.orbits = branch.orbits;
    f.period = branch.last_period;
    f.energy = branch.last_energy;
    f.cutoff = branch.last_cutoff;
    f.end = branch.end_reason;
  }
  if (_style == Display::lines) print_line(f);
  if (_style == Display::live) redraw();
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
  core::write_line(stderr, line_of(family));
}

void ProgressDisplay::redraw() {
  if (_families.empty()) return;
  std::string text;
  if (_drawn > 0) text = fmt::format("\x1b[{}A", _drawn);
  const char* separator = "";
  for (const auto& [key, family] : _families) {
    text += fmt::format("{}\x1b[2K{}", separator, line_of(family).substr(0, narrowest_terminal));
    separator = "\n";
  }
  _drawn = static_cast<int>(_families.size());
  core::write_line(stderr, text);
}

}  // namespace orbweaver::survey
