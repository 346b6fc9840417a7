#include "orbweaver/core/log/log_stage.hpp"

#include <algorithm>
#include <iterator>

namespace orbweaver::core::detail {

constinit const Log no_log = [] {
  Log none{};
  std::fill(std::begin(none.stage), std::end(none.stage), -1);
  std::fill(std::begin(none.event), std::end(none.event), -1);
  return none;
}();
constinit Log log = no_log;

}  // namespace orbweaver::core::detail
