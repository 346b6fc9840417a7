#include "units.hpp"

#include <cmath>

#include <fmt/format.h>

namespace orbweaver::survey {

std::string Units::level_text(double value, int digits) const {
  return std::isnan(value) ? "" : fmt::format(", {} = {:.{}g}", level_name(), value, digits);
}

}  // namespace orbweaver::survey
