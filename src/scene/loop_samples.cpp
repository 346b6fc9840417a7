#include "orbweaver/scene/loop_samples.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <string_view>
#include <system_error>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "fields.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/core/input_file.hpp"
#include "orbweaver/core/text.hpp"
#include "orbweaver/systems/reduced_system.hpp"

namespace orbweaver::scene {

namespace {

constexpr double closest = 1e-9;          // of the period: nearer times no spline tells apart
constexpr double farthest = 1e6;          // periods: beside later times these are not told apart either
constexpr std::size_t longest_echo = 40;  // of a cell, in a message
constexpr double largest = 1e100;         // squares of it and their sums are finite

/// The lines of a text, whose last one may end without a break, and where one stands for messages.
class Lines {
 public:
  Lines(const std::string& text, std::string origin) : _left(text), _origin(std::move(origin)) {}

  /// The cells of the next line; none at the end of the text.
  [[nodiscard]] bool next(std::vector<std::string_view>& cells) {
    cells.clear();
    if (_left.empty()) return false;
    ++_number;
    std::string_view line = _left.substr(0, _left.find('\n'));
    _left.remove_prefix(std::min(line.size() + 1, _left.size()));
    if (line.ends_with('\r')) line.remove_suffix(1);
    for (std::size_t at = 0; at <= line.size();) {
      const std::size_t end = std::min(line.find(',', at), line.size());
      std::string_view cell = line.substr(at, end - at);
      while (cell.starts_with(' ') || cell.starts_with('\t')) cell.remove_prefix(1);
      while (cell.ends_with(' ') || cell.ends_with('\t')) cell.remove_suffix(1);
      cells.push_back(cell);
      at = end + 1;
    }
    return true;
  }

  [[noreturn]] void fail(const std::string& message) const {
    throw core::InputError(fmt::format("{}:{}: {}", _origin, std::max(_number, 1), message));
  }
  [[noreturn]] void fail(const std::string& expected, const std::string& came, const std::string& advice) const {
    fail(fmt::format("expected {}, got {}; {}", expected, came, advice));
  }

 private:
  std::string_view _left;
  std::string _origin;
  int _number = 0;
};

std::string echo(std::string_view cell) {
  if (cell.empty()) return "nothing";
  return fmt::format("`{}`", core::printable(core::shortened(std::string(cell), longest_echo)));
}

/// The system whose coordinates a table has: of one without some of its coordinates it may be the whole one.
const systems::System& told_by(const std::vector<std::string_view>& cells, const systems::System& system) {
  const systems::System* whole = systems::whole_of(system);
  return whole != nullptr && cells.size() == 1 + whole->info().state_names.size() ? *whole : system;
}

/// The place of each column's value: 0 for t, 1 + i for coordinate i.
std::vector<std::size_t> read_header(const Lines& lines, const std::vector<std::string_view>& cells,
                                     const systems::System& system) {
  std::vector<std::string> names{"t"};
  names.insert(names.end(), system.info().state_names.begin(), system.info().state_names.end());
  const std::string wanted = fmt::format("a first line with the columns {}", fmt::join(names, ", "));
  std::vector<std::size_t> places;
  for (const std::string_view cell : cells) {
    const auto found = std::find(names.begin(), names.end(), cell);
    if (found == names.end()) lines.fail(wanted, echo(cell), "name each column by its coordinate");
    places.push_back(static_cast<std::size_t>(found - names.begin()));
    if (std::count(places.begin(), places.end(), places.back()) > 1)
      lines.fail(wanted, echo(cell) + " twice", "remove one");
  }
  for (std::size_t n = 0; n < names.size(); ++n)
    if (std::count(places.begin(), places.end(), n) == 0)
      lines.fail(wanted, "no " + names[n], "give all of them, in any order");
  return places;
}

}  // namespace

LoopSamples parse_loop_samples(const std::string& text, const std::string& origin, const systems::System& system,
                               double period) {
  if (const std::size_t at = core::first_untextual(text); at != std::string::npos)
    throw core::InputError(
        fmt::format("{}:{}: expected UTF-8, got a byte that is none; save it as plain text", origin,
                    1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n')));
  Lines lines(text, origin);
  std::vector<std::string_view> cells;
  if (!lines.next(cells)) lines.fail("a table in CSV", "an empty file", "begin with a line that names the columns");
  const systems::System& told = told_by(cells, system);
  const std::vector<std::size_t> places = read_header(lines, cells, told);
  LoopSamples samples;
  while (lines.next(cells)) {
    if (cells.size() != places.size())
      lines.fail(fmt::format("{} numbers, one a column", places.size()), fmt::format("{}", cells.size()),
                 "complete the row, or remove it");
    std::vector<double> row(places.size());
    for (std::size_t n = 0; n < cells.size(); ++n) {
      const std::optional<double> value = parse_number(cells[n]);
      if (!value || !(std::abs(*value) <= largest))
        lines.fail(fmt::format("a number of modulus {:g} at most", largest), echo(cells[n]), "correct it");
      row[places[n]] = *value;
    }
    const double time = row.front();
    if (!samples.times.empty() && !(time > samples.times.back()))
      lines.fail(fmt::format("a time after {}", samples.times.back()), fmt::format("{}", time), "sort the rows by t");
    if (std::abs(time) > farthest * period)
      lines.fail(fmt::format("a time of {:g} periods at most", farthest), fmt::format("{}", time),
                 "count t from the first row");
    if (!samples.times.empty() && !(time - samples.times.back() > closest * period))
      lines.fail(fmt::format("a time more than {:g} after {}", closest * period, samples.times.back()),
                 fmt::format("{}", time), "leave one of the two rows out");
    if (!samples.times.empty() && time - samples.times.front() > period * (1.0 + same_period))
      lines.fail(fmt::format("times within one period, {}, from the first, {}", period, samples.times.front()),
                 fmt::format("{}", time), "cut the table, or correct the period");
    if (!samples.times.empty() && !(time - samples.times.back() < 0.5 * period))
      lines.fail("samples nearer to one another than half a period",
                 fmt::format("{} after {}", time, samples.times.back()), "give more of them");
    samples.times.push_back(time);
    samples.states.emplace_back(row.begin() + 1, row.end());
    if (&told == &system) continue;
    try {
      samples.states.back() = systems::reduced_state(system, samples.states.back());
    } catch (const core::InputError& error) {
      lines.fail(error.what());
    }
  }
  if (samples.times.size() < least_loop_rows)
    lines.fail(fmt::format("at least {} rows", least_loop_rows), fmt::format("{}", samples.times.size()),
               "sample the loop more finely");
  if (!(samples.times.front() + period - samples.times.back() < 0.5 * period))
    lines.fail(fmt::format("samples around the whole loop, whose period is {}", period),
               fmt::format("none after t = {}", samples.times.back()), "give more of them, or correct the period");
  return samples;
}

LoopSamples read_loop_samples(const std::filesystem::path& file, const systems::System& system, double period) {
  const std::string origin = quoted(file.string());
  if (const std::string got = core::unreadable_input(file); !got.empty())
    throw core::InputError(
        fmt::format("{}: expected a table in CSV that can be read, got {}; check the path", origin, got));
  std::error_code code;
  std::ifstream stream(file, std::ios::binary);
  std::string text(std::min<std::uintmax_t>(std::filesystem::file_size(file, code), longest_loop_file + 1), '\0');
  stream.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(stream.gcount()));
  if (text.size() > longest_loop_file)
    throw core::InputError(
        fmt::format("{}: expected at most {} bytes, got more; give fewer samples", origin, longest_loop_file));
  constexpr std::string_view byte_order_mark = "\xef\xbb\xbf";  // as spreadsheets begin their UTF-8
  if (text.starts_with(byte_order_mark)) text.erase(0, byte_order_mark.size());
  return parse_loop_samples(text, origin, system, period);
}

}  // namespace orbweaver::scene
