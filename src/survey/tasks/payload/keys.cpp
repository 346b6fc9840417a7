#include "keys.hpp"

#include <algorithm>
#include <charconv>

#include <fmt/format.h>

#include "orbweaver/core/error.hpp"

namespace orbweaver::survey {

namespace {

constexpr std::string_view locating = "locate ";
constexpr std::string_view starting = "start ";

}  // namespace

std::string event_key(std::string_view branch, int number, std::string_view what) {
  return fmt::format("{}/{:03}.{}", branch, number, what);
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
  int number = 0;
  if (lies_on(key, branch)) {
    const char* begin = key.data() + branch.size() + 1;
    if (std::from_chars(begin, key.data() + key.size(), number).ec == std::errc{}) return number;
  }
  throw core::EnvironmentError(fmt::format("`{}` is no key of an event of `{}`", key, branch));
}

int equilibrium_index(std::string_view key) {
  int index = -1;
  std::from_chars(key.data(), key.data() + key.size(), index);
  return index;
}

std::string mode_of(std::string_view base) {
  const std::size_t point = base.find('.');
  if (point == std::string_view::npos) return "";
  return std::string(base.substr(point + 1, base.find_first_of("+-") - point - 1));
}

std::string locate_key(std::string_view crossing) { return fmt::format("{}{}", locating, crossing); }
std::string start_key(std::string_view branch) { return fmt::format("{}{}", starting, branch); }

std::string place_of(std::string_view task_key) {
  for (const std::string_view verb : {locating, starting})
    if (task_key.starts_with(verb)) return std::string(task_key.substr(verb.size()));
  return std::string(task_key);
}

}  // namespace orbweaver::survey
