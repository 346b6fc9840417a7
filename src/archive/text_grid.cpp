#include "text_grid.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace orbweaver::archive {

namespace {

// Characters, not bytes.
std::size_t width_of(const std::string& text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
}

std::string pad(const std::string& text, std::size_t width, bool right) {
  const std::string fill(width - std::min(width, width_of(text)), ' ');
  return right ? fill + text : text + fill;
}

}  // namespace

void TextGrid::add_column(std::string head, std::vector<std::string> cells, bool right) {
  _columns.push_back({std::move(head), std::move(cells), right});
}

void TextGrid::print(std::ostream& out) const {
  if (_columns.empty()) return;
  std::vector<std::size_t> widths;
  for (const GridColumn& column : _columns) {
    std::size_t width = width_of(column.head);
    for (const std::string& cell : column.cells) width = std::max(width, width_of(cell));
    widths.push_back(width);
  }
  const auto print_line = [&](const auto& cell_of) {
    std::string line;
    for (std::size_t c = 0; c < _columns.size(); ++c)
      line += (c == 0 ? "" : "  ") + pad(cell_of(_columns[c]), widths[c], _columns[c].right);
    out << line.substr(0, line.find_last_not_of(' ') + 1) << '\n';
  };
  print_line([](const GridColumn& column) { return column.head; });
  for (std::size_t row = 0; row < _columns.front().cells.size(); ++row)
    print_line([row](const GridColumn& column) { return column.cells[row]; });
}

}  // namespace orbweaver::archive
