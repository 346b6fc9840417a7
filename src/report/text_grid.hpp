#pragma once

#include <cstddef>
#include <cstdint>
#include <ostream>
#include <string>
#include <vector>

namespace orbweaver::report {

/// Lines of readable text are not longer, where words allow it.
inline constexpr std::size_t line_width = 120;

/// Columns of text, aligned: left, or right for numbers.
class TextGrid {
 public:
  void add_column(std::string head, std::vector<std::string> cells, bool right = true);
  /// The head line and a line a row, without line ends; none without columns.
  [[nodiscard]] std::vector<std::string> lines() const;
  void print(std::ostream& out) const;
  /// Of the longest line.
  [[nodiscard]] std::size_t width() const;

 private:
  struct GridColumn {
    std::string head;
    std::vector<std::string> cells;
    bool right;
  };
  std::vector<GridColumn> _columns;
};

/// Numbers as cells, "-" where there is none: NaN, or a negative row.
[[nodiscard]] std::vector<std::string> cells_of(const std::vector<double>& values, const char* format);
[[nodiscard]] std::vector<std::string> cells_of(const std::vector<std::int64_t>& values);

/// `text` of at most `width` characters: what is longer is cut and ends in "...".
[[nodiscard]] std::string cut(const std::string& text, std::size_t width);

/// The words of `text` in lines of at most `width` characters (a longer word has a line of its own), each behind
/// `indent` spaces.
[[nodiscard]] std::vector<std::string> wrap(const std::string& text, std::size_t width, std::size_t indent);

}  // namespace orbweaver::report
