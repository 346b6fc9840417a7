#include "display.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <vector>

#include <fmt/format.h>
#include <unistd.h>

#include "orbweaver/core/log/log.hpp"
#include "orbweaver/core/styled.hpp"
#include "orbweaver/core/terminal.hpp"
#include "orbweaver/core/text.hpp"
#include "tasks/payload/work.hpp"
#include "tree/end_text.hpp"

namespace orbweaver::survey {

namespace {

constexpr std::size_t narrowest_line = 20;  // columns that are written at least, whatever the terminal says
constexpr std::size_t widest_line = 160;
constexpr std::size_t widest_bar = 30;
constexpr std::size_t narrowest_bar = 6;
constexpr int most_live_lines = 16;
constexpr auto time_between_lines = std::chrono::seconds(5);
constexpr auto time_of_a_rate = std::chrono::seconds(10);

/// Names are ASCII but for those of scenes: a byte more than a column does no harm, one less would.
std::string cut(std::string text, std::size_t width) {
  if (text.size() <= width) return text;
  while (width > 0 && (static_cast<unsigned char>(text[width]) & 0xC0) == 0x80) --width;
  text.resize(width);
  return text;
}

/// The end of a name tells it from others: Out-Phase>1@6.148/0>2@5.98/0.
std::string name_text(const std::string& given, std::size_t width) {
  const std::string name = core::printable(given);
  if (name.size() <= width) return fmt::format("{:<10}", name);
  std::size_t from = name.size() - width + 2;
  while (from < name.size() && (static_cast<unsigned char>(name[from]) & 0xC0) == 0x80) ++from;
  return ".." + name.substr(from);
}

std::string duration_text(double seconds) {
  const long whole = std::lround(seconds);
  if (whole < 100) return fmt::format("{} s", whole);
  if (whole < 6000) return fmt::format("{} min {:02d} s", whole / 60, whole % 60);
  return fmt::format("{} h {:02d} min", whole / 3600, whole % 3600 / 60);
}

std::string bar_text(double part, std::size_t width, bool unicode) {
  const auto full = static_cast<std::size_t>(std::lround(std::clamp(part, 0.0, 1.0) * static_cast<double>(width)));
  std::string text = "[";
  for (std::size_t n = 0; n < width; ++n) {
    if (unicode)
      text += n < full ? "\u2588" : "\u2591";
    else
      text += n < full ? '#' : '-';
  }
  return text + "] ";
}

}  // namespace

std::string line_of(const FamilyState& f, const std::string& level, std::size_t width) {
  const std::string name = name_text(f.name, std::max<std::size_t>(10, width / 3));
  const std::string count = fmt::format("{} {:>5} orbits", name, f.orbits);
  if (f.orbits == 0 && !f.running) return cut(fmt::format("{}  {}", count, f.end), width);
  const double seconds = std::chrono::duration<double>(f.changed - f.began).count();
  const std::string rate = seconds > 0.0 ? fmt::format("{:.1f} orbits/s", static_cast<double>(f.orbits) / seconds) : "";
  const std::string& last = f.running ? rate : f.end;
  const std::string place = fmt::format("  T {:<8.4f}", f.period);
  const std::string at_level = std::isnan(f.level) ? "" : fmt::format(" {} {:<10.6f}", level, f.level);
  const std::string cutoff = fmt::format(" K {:<4}", f.cutoff);
  for (const std::string& numbers : {place + at_level + cutoff, place + at_level, place, std::string()}) {
    const std::string text = fmt::format("{}{} {}", count, numbers, last);
    if (text.size() <= width) return text;
  }
  return cut(fmt::format("{}  {}", count, last), width);
}

std::string text_of(const WholeState& whole, std::size_t width) {
  std::vector<std::string> parts{fmt::format("{} of {} tasks", whole.done, whole.known)};
  if (whole.failed > 0) parts.push_back(fmt::format("{} failed", whole.failed));
  if (whole.orbits) parts.push_back(fmt::format("{} orbits", *whole.orbits));
  if (whole.orbits && *whole.orbits > 0) parts.push_back(fmt::format("{:.1f}/s", whole.orbits_a_second));
  parts.push_back(duration_text(whole.seconds));
  if (whole.left)
    parts.push_back(fmt::format("{} {}", whole.at_most ? "stops within" : "about", duration_text(*whole.left)) +
                    (whole.at_most ? "" : " left"));
  std::string text = parts.front();
  for (std::size_t n = 1; n < parts.size() && text.size() + 2 + parts[n].size() <= width; ++n) text += ", " + parts[n];
  return cut(std::move(text), width);
}

std::string line_of(const WholeState& whole, std::size_t width, bool unicode) {
  constexpr std::size_t frame = 3;  // of the bar
  const std::string text = text_of(whole, width);
  if (whole.known == 0 || text.size() + frame + narrowest_bar > width) return text;
  const double part = static_cast<double>(whole.done) / static_cast<double>(whole.known);
  return bar_text(part, std::min(widest_bar, width - text.size() - frame), unicode) + text;
}

void ProgressDisplay::show_tasks_only() {
  _all_known = true;
  _shows_orbits = false;
}

void ProgressDisplay::started(const queue::Task& task, int) {
  _all_known = kind_of(task) == TaskKind::sweep;
  if (kind_of(task) != TaskKind::branch) return;
  FamilyState& family = _families[task.key];
  family.name = told_branch(task).name;
  family.resumed = !task.state.empty();
}

void ProgressDisplay::count(FamilyState& family, long orbits) {
  if (!family.resumed) _orbits += orbits - family.orbits;
  family.resumed = false;
  family.orbits = orbits;
}

void ProgressDisplay::progress(const queue::Task& task, const queue::Progress& progress, int) {
  if (kind_of(task) != TaskKind::branch || progress.values.size() < 3) return;
  FamilyState& f = _families[task.key];
  count(f, progress.step);
  f.period = progress.values[0];
  f.level = progress.values[1];
  f.cutoff = static_cast<int>(progress.values[2]);
  f.changed = Clock::now();
}

void ProgressDisplay::ended(const queue::Task& task, const queue::TaskOutcome& outcome) {
  if (kind_of(task) != TaskKind::branch) return;
  FamilyState& f = _families[task.key];
  f.running = false;
  f.failed = outcome.failed;
  f.changed = Clock::now();
  f.end = outcome.reason;
  if (!outcome.payload.empty()) {
    const BranchOutcome branch = unpack_branch_outcome(outcome.payload);
    count(f, branch.orbits);
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

void ProgressDisplay::tick(const queue::TaskCounts& counts) {
  _counts = counts;
  if (_style == Display::none) return;
  if (_style == Display::live) {
    redraw();
    return;
  }
  if (Clock::now() - _last < time_between_lines) return;
  _last = Clock::now();
  for (auto& [key, family] : _families)
    if (family.running && family.orbits > family.printed) print_line(family);
  core::write_line(stderr, text_of(whole(), widest_line));
}

WholeState ProgressDisplay::whole() {
  const auto now = Clock::now();
  _lately.emplace_back(now, _orbits);
  while (_lately.size() > 2 && now - _lately.front().first > time_of_a_rate) _lately.pop_front();
  const double span = std::chrono::duration<double>(now - _lately.front().first).count();
  WholeState whole;
  whole.done = _counts.done + _counts.failed;
  whole.known = whole.done + _counts.waiting + _counts.running + _counts.aside;
  whole.failed = _counts.failed;
  if (_shows_orbits)
    whole.orbits = _orbits;
  else
    whole.orbits.reset();
  whole.orbits_a_second = span > 0.0 ? static_cast<double>(_orbits - _lately.front().second) / span : 0.0;
  whole.seconds = std::chrono::duration<double>(now - _began).count();
  if (_all_known && whole.done > 0)
    whole.left = whole.seconds * static_cast<double>(whole.known - whole.done) / static_cast<double>(whole.done);
  if (!whole.left && std::isfinite(_allowed)) {
    whole.left = std::max(0.0, _allowed - whole.seconds);
    whole.at_most = true;
  }
  return whole;
}

void ProgressDisplay::print_line(FamilyState& family) {
  family.printed = family.orbits;
  core::write_line(stderr, line_of(family, _units.level_name(), widest_line));
}

void ProgressDisplay::finish() noexcept {
  if (_drawn == 0) return;
  std::fprintf(stderr, "\x1b[%dA\x1b[J", _drawn);
  std::fflush(stderr);
  _drawn = 0;
}

// The bar and the running families at the bottom, redrawn in place; what has ended stays above them.
void ProgressDisplay::redraw() {
  const core::Terminal terminal = core::terminal_of(STDERR_FILENO);
  // A line that wraps would spoil the redrawing, and so would one that fills the last column of some terminals.
  const std::size_t width = std::clamp(terminal.width, narrowest_line + 1, widest_line + 1) - 1;
  std::string text = _drawn > 0 ? fmt::format("\x1b[{}A\x1b[J", _drawn) : "";
  int running = 0;  // lines that will be drawn anew
  for (const auto& [key, family] : _families)
    if (!family.running)
      text += core::styled(family.failed ? core::Style::bad : core::Style::plain,
                           line_of(family, _units.level_name(), width), terminal.colours) +
              "\n";
  const WholeState all = whole();
  if (all.known > 0) {
    text += core::styled(core::Style::heading, line_of(all, width, terminal.unicode), terminal.colours) + "\n";
    ++running;
  }
  for (const auto& [key, family] : _families)
    if (family.running && running < most_live_lines) {
      ++running;
      text += core::styled(core::Style::faint, line_of(family, _units.level_name(), width), terminal.colours) + "\n";
    }
  _drawn = running;
  std::fwrite(text.data(), 1, text.size(), stderr);
  std::fflush(stderr);
}

}  // namespace orbweaver::survey
