#include "text_grid.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "orbweaver/core/styled.hpp"

namespace orbweaver::report {

namespace {

// Of a character of UTF-8 that has begun before.
bool is_continuation(char c) { return (static_cast<unsigned char>(c) & 0xC0) == 0x80; }

// Characters, not bytes.
std::size_t width_of(const std::string& text) {
  return text.size() - static_cast<std::size_t>(std::count_if(text.begin(), text.end(), is_continuation));
}

std::string pad(const std::string& text, std::size_t width, bool right) {
  const std::string fill(width - std::min(width, width_of(text)), ' ');
  return right ? fill + text : text + fill;
}

}  // namespace

void TextGrid::add_column(std::string head, std::vector<std::string> cells, bool right) {
  _columns.push_back({std::move(head), std::move(cells), right});
}

std::vector<std::string> TextGrid::lines() const {
  if (_columns.empty()) return {};
  std::vector<std::size_t> widths;
  for (const GridColumn& column : _columns) {
    std::size_t width = width_of(column.head);
    for (const std::string& cell : column.cells) width = std::max(width, width_of(cell));
    widths.push_back(width);
  }
  std::vector<std::string> lines;
  const auto add_line = [&](const auto& cell_of) {
    std::string line;
    for (std::size_t c = 0; c < _columns.size(); ++c)
      line += (c == 0 ? "" : "  ") + pad(cell_of(_columns[c]), widths[c], _columns[c].right);
    lines.push_back(line.substr(0, line.find_last_not_of(' ') + 1));
  };
  add_line([](const GridColumn& column) { return column.head; });
  for (std::size_t row = 0; row < _columns.front().cells.size(); ++row)
    add_line([row](const GridColumn& column) { return column.cells[row]; });
  return lines;
}

void TextGrid::print(std::ostream& out) const {
  core::Style style = core::Style::heading;
  for (const std::string& line : lines()) {
    out << core::Styled{style, line} << '\n';
    style = core::Style::plain;
  }
}

std::size_t TextGrid::width() const {
  std::size_t width = 0;
  for (const std::string& line : lines()) width = std::max(width, width_of(line));
  return width;
}

std::vector<std::string> cells_of(const std::vector<double>& values, const char* format) {
  std::vector<std::string> cells;
  for (const double value : values) cells.push_back(std::isnan(value) ? "-" : fmt::format(fmt::runtime(format), value));
  return cells;
}

std::vector<std::string> cells_of(const std::vector<std::int64_t>& values) {
  std::vector<std::string> cells;
  for (const std::int64_t value : values) cells.push_back(value < 0 ? "-" : std::to_string(value));
  return cells;
}

std::string cut(const std::string& text, std::size_t width) {
  if (width_of(text) <= width) return text;
  constexpr std::string_view dots = "...";
  std::size_t end = 0;  // of the last whole character that fits
  for (std::size_t at = 0, characters = 0; characters + dots.size() <= width && at <= text.size(); ++at) {
    if (at < text.size() && is_continuation(text[at])) continue;
    end = at;
    ++characters;
  }
  return text.substr(0, end).append(dots);
}

std::vector<std::string> wrap(const std::string& text, std::size_t width, std::size_t indent) {
  std::vector<std::string> lines;
  std::string line;
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    if (!line.empty() && indent + width_of(line) + 1 + width_of(word) > width)
      lines.push_back(std::string(indent, ' ') + std::exchange(line, ""));
    line += (line.empty() ? "" : " ") + word;
  }
  if (!line.empty()) lines.push_back(std::string(indent, ' ') + line);
  return lines;
}

}  // namespace orbweaver::report
