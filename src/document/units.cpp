#include "orbweaver/document/units.hpp"

#include <charconv>
#include <cmath>
#include <limits>
#include <numbers>

namespace orbweaver::document {

namespace {

bool is_infinity(std::string_view text) { return text == ".inf" || text == ".Inf" || text == ".INF"; }

// from_chars takes no leading plus, but does take "inf" and "nan", which are plain text in YAML.
template <class Value>
std::optional<Value> parse_whole(std::string_view text) {
  if (!text.empty() && text.front() == '+') {
    text.remove_prefix(1);
    if (!text.empty() && text.front() == '-') return std::nullopt;
  }
  if (text.find_first_not_of("0123456789.eE+-") != std::string_view::npos) return std::nullopt;
  Value value{};
  const char* end = text.data() + text.size();
  const auto result = std::from_chars(text.data(), end, value);
  if (result.ec != std::errc{} || result.ptr != end) return std::nullopt;
  return value;
}

}  // namespace

double radians(double degrees) { return degrees / 180.0 * std::numbers::pi; }

double degrees(double radians) { return radians / std::numbers::pi * 180.0; }

std::optional<double> parse_number(std::string_view text) {
  const bool negative = !text.empty() && text.front() == '-';
  const bool is_signed = negative || (!text.empty() && text.front() == '+');
  if (is_infinity(text.substr(is_signed ? 1 : 0))) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    return negative ? -infinity : infinity;
  }
  return parse_whole<double>(text);
}

std::optional<int> parse_integer(std::string_view text) { return parse_whole<int>(text); }

std::optional<double> parse_angle(std::string_view text) {
  if (text.size() < 4) return std::nullopt;
  const std::string_view unit = text.substr(text.size() - 3);
  const std::optional<double> value = parse_whole<double>(text.substr(0, text.size() - 3));
  if (!value) return std::nullopt;
  if (unit == "deg") return radians(*value);
  if (unit == "rad") return value;
  return std::nullopt;
}

}  // namespace orbweaver::document
