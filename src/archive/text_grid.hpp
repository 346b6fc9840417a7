#pragma once

#include <ostream>
#include <string>
#include <vector>

namespace orbweaver::archive {

/// Columns of text, aligned: left, or right for numbers.
class TextGrid {
 public:
  void add_column(std::string head, std::vector<std::string> cells, bool right = true);
  void print(std::ostream& out) const;

 private:
  struct GridColumn {
    std::string head;
    std::vector<std::string> cells;
    bool right;
  };
  std::vector<GridColumn> _columns;
};

}  // namespace orbweaver::archive
