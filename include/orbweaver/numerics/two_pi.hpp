#pragma once

#include <numbers>

namespace orbweaver::numerics {

constexpr double two_pi = 2.0 * std::numbers::pi;

}  // namespace orbweaver::numerics
