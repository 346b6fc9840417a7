#pragma once

#include <cstddef>

namespace orbweaver::equations {

/// The place of a number that counts from 0 in an array.
constexpr std::size_t at(int i) { return static_cast<std::size_t>(i); }

}  // namespace orbweaver::equations
