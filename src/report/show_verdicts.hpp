#pragma once

#include <string>

#include "orbweaver/archive/read/reader.hpp"

namespace orbweaver::report {

/// "28 hold, 2 closure contradicts": how many of `count` orbits from row `first` have which verdict; empty where no
/// certificate was computed.
[[nodiscard]] std::string verdicts_text(const archive::Archive& atlas, std::size_t first, std::size_t count);

/// The same of a family, and empty too where all hold.
[[nodiscard]] std::string doubts_text(const archive::Archive& atlas, std::size_t family);

}  // namespace orbweaver::report
