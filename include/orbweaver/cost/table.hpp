#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace orbweaver::cost {

/// A number, or words: what stands there instead of one.
struct Cell {
  double number = std::numeric_limits<double>::quiet_NaN();
  std::string words{};

  Cell(double value) : number(value) {}               // NOLINT: cells of a row are written as they are
  Cell(int value) : number(value) {}                  // NOLINT
  Cell(std::string text) : words(std::move(text)) {}  // NOLINT
  Cell(const char* text) : words(text) {}             // NOLINT
  /// Nothing: a dash.
  Cell() = default;
};

/// "time", in "s"; without a unit it is empty.
struct Column {
  std::string name;
  std::string unit{};
};

/// How a table is drawn: one column against another, both logarithmic, a line for each text of `series`, a picture for
/// each text of `panel`. Numbers are indices of columns.
struct Plot {
  std::size_t x = 0;
  std::size_t y = 0;
  std::vector<std::size_t> series{};  ///< columns whose words tell the lines apart
  std::optional<std::size_t> panel{};
};

/// What a ladder measured.
struct Table {
  std::string name;   ///< of its files
  std::string title;  ///< what was measured
  std::vector<Column> columns;
  std::vector<std::vector<Cell>> rows;
  std::vector<std::string> remarks{};  ///< sentences
  std::optional<Plot> plot{};
  bool printed = true;  ///< false: for its files only
};

}  // namespace orbweaver::cost
