#include "keys.hpp"

#include <algorithm>
#include <charconv>
#include <optional>

#include <fmt/format.h>

#include "orbweaver/core/error.hpp"
#include "orbweaver/core/text.hpp"

namespace orbweaver::survey {

namespace {

constexpr std::string_view locating = "locate ";
constexpr std::string_view starting = "start ";
constexpr std::string_view following = "locus ";

/// Usual digits.
constexpr std::size_t of_event = 3;
constexpr std::size_t of_base = 4;

/// Of a number that is not negative: letters sort after digits.
std::string ordered(int number, std::size_t digits) {
  const std::string text = fmt::format("{:0{}}", number, digits);
  return text.size() == digits ? text : static_cast<char>('a' + (text.size() - digits - 1)) + text;
}

/// The number that `ordered` wrote at the beginning of `text`.
std::optional<int> ordered_at(std::string_view text) {
  if (!text.empty() && text.front() >= 'a' && text.front() <= 'z') text.remove_prefix(1);
  int number = 0;
  if (std::from_chars(text.data(), text.data() + text.size(), number).ec != std::errc{}) return std::nullopt;
  return number;
}

}  // namespace

std::string equilibrium_key(int equilibrium) { return ordered(equilibrium, of_base); }
std::string base_key(int equilibrium, int mode) {
  return fmt::format("{}.{}", equilibrium_key(equilibrium), ordered(mode, of_base));
}

std::string event_key(std::string_view branch, int number, std::string_view what) {
  return fmt::format("{}/{}.{}", branch, ordered(number, of_event), what);
}

std::string branch_of(std::string_view crossing) { return std::string(crossing.substr(0, crossing.rfind('/'))); }

std::string parent_of(std::string_view branch) {
  const std::size_t direction = branch.rfind('/');
  return direction == std::string_view::npos ? "" : branch_of(branch.substr(0, direction));
}

int depth_of(std::string_view branch) {
  // A crossing and a direction each time.
  return static_cast<int>(std::count(branch.begin(), branch.end(), '/')) / 2;
}

bool lies_on(std::string_view key, std::string_view branch) {
  return key.size() > branch.size() && key.starts_with(branch) && key[branch.size()] == '/';
}

int event_number(std::string_view key, std::string_view branch) {
  if (lies_on(key, branch))
    if (const std::optional<int> number = ordered_at(key.substr(branch.size() + 1))) return *number;
  throw core::EnvironmentError(
      fmt::format("`{}` is no key of an event of `{}`", core::printable(key), core::printable(branch)));
}

int equilibrium_index(std::string_view key) { return ordered_at(key).value_or(-1); }

std::string base_of(std::string_view key) { return std::string(key.substr(0, key.find_first_of("+-/"))); }

std::string mode_of(std::string_view base) {
  const std::size_t point = base.find('.');
  if (point == std::string_view::npos) return "";
  return std::string(base.substr(point + 1, base.find_first_of("+-") - point - 1));
}

std::string locate_key(std::string_view crossing) { return fmt::format("{}{}", locating, crossing); }
std::string start_key(std::string_view branch) { return fmt::format("{}{}", starting, branch); }
std::string locus_key(std::string_view crossing, int entry) {
  return fmt::format("{}{}:{}", following, crossing, entry);
}

std::string place_of(std::string_view task_key) {
  for (const std::string_view verb : {locating, starting, following})
    if (task_key.starts_with(verb)) return std::string(task_key.substr(verb.size()));
  return std::string(task_key);
}

}  // namespace orbweaver::survey
