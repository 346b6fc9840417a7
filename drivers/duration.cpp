#include "duration.hpp"

#include <regex>

#include <fmt/format.h>

#include "orbweaver/core/error.hpp"

namespace orbweaver::drivers {

double seconds_of(const std::string& text) {
  static const std::regex form(R"((?:(?:(\d{1,6}):)?(\d{1,6}):)?(\d{1,9}(?:\.\d*)?))");
  std::smatch parts;
  double seconds = 0.0;
  if (std::regex_match(text, parts, form)) {
    for (std::size_t n = 1; n < parts.size(); ++n)
      seconds = 60.0 * seconds + (parts[n].matched ? std::stod(parts[n].str()) : 0.0);
  }
  if (!(seconds > 0.0))
    throw core::InputError(fmt::format(
        "--walltime: expected seconds, minutes:seconds or hours:minutes:seconds, more than none, got `{}`", text));
  return seconds;
}

}  // namespace orbweaver::drivers
