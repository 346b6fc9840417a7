#include "duration.hpp"

#include <algorithm>
#include <charconv>
#include <optional>
#include <string_view>

#include <fmt/format.h>

#include "orbweaver/core/error.hpp"

namespace orbweaver::drivers {

namespace {

bool are_digits(std::string_view text) {
  return std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
}

bool is_whole_number(std::string_view text, std::size_t most_digits) {
  return !text.empty() && text.size() <= most_digits && are_digits(text);
}

double value_of(std::string_view number) {
  double value = 0.0;
  std::from_chars(number.data(), number.data() + number.size(), value, std::chars_format::fixed);
  return value;
}

std::optional<double> parse(std::string_view text) {
  constexpr int most_colons = 2;
  double sixtieths = 0.0;  // hours in minutes, minutes in seconds
  for (int colons = 0; text.find(':') != std::string_view::npos; ++colons) {
    const std::string_view part = text.substr(0, text.find(':'));
    if (colons == most_colons || !is_whole_number(part, 6)) return std::nullopt;
    sixtieths = 60.0 * (sixtieths + value_of(part));
    text.remove_prefix(part.size() + 1);
  }
  const std::size_t point = std::min(text.find('.'), text.size());
  const std::string_view decimals = text.substr(std::min(point + 1, text.size()));
  if (!is_whole_number(text.substr(0, point), 9) || !are_digits(decimals)) return std::nullopt;
  return sixtieths + value_of(text);
}

}  // namespace

double seconds_of(const std::string& text) {
  const double seconds = parse(text).value_or(0.0);
  if (!(seconds > 0.0))
    throw core::InputError(fmt::format(
        "--walltime: expected seconds, minutes:seconds or hours:minutes:seconds, more than none, got `{}`", text));
  return seconds;
}

}  // namespace orbweaver::drivers
