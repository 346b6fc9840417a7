#pragma once

#include <functional>
#include <string_view>

#include "orbweaver/cost/table.hpp"
#include "setting.hpp"

namespace orbweaver::cost {

/// Where a ladder's tables go as they are done.
using Take = std::function<void(const Table&)>;

/// One ladder: a file in src/cost/ladders, and a line in src/cost/ladders.cpp.
struct Ladder {
  std::string_view name;
  std::string_view about;
  void (*measure)(const Setting& setting, const Take& take);
  bool collective = false;  ///< all ranks take part
};

}  // namespace orbweaver::cost
