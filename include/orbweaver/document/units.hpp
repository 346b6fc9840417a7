#pragma once

#include <optional>
#include <string_view>

namespace orbweaver::document {

/// Radians of an angle in degrees; multiples of 90 come out as the nearest doubles to multiples of pi/2.
[[nodiscard]] double radians(double degrees);
[[nodiscard]] double degrees(double radians);

/// A whole YAML scalar as a number: decimal floats, `.inf`, `+.inf`, `-.inf`. None for anything else, `.nan` and
/// overflow included.
[[nodiscard]] std::optional<double> parse_number(std::string_view text);

/// A whole YAML scalar as a decimal integer that fits an int; none for anything else.
[[nodiscard]] std::optional<int> parse_integer(std::string_view text);

/// `0.5deg` or `0.01rad` in radians; none without one of these units or for anything else.
[[nodiscard]] std::optional<double> parse_angle(std::string_view text);

}  // namespace orbweaver::document
