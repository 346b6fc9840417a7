#include "orbweaver/document/source.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "orbweaver/core/error.hpp"
#include "orbweaver/core/text.hpp"

namespace orbweaver::document {

namespace {

bool is_inside(std::string_view path, std::string_view outer) {
  if (!path.starts_with(outer)) return false;
  return path.size() == outer.size() || path[outer.size()] == '.' || path[outer.size()] == '[';
}

}  // namespace

std::string quoted(const std::string& text) {
  constexpr std::size_t most_quoted = 120;
  return core::shortened(core::printable(text), most_quoted);
}

Source::Source(std::string origin, std::vector<Override> overrides)
    : _origin(std::move(origin)), _overrides(std::move(overrides)) {}

std::string Source::place(std::string_view path, int line) const {
  const auto setter =
      std::find_if(_overrides.rbegin(), _overrides.rend(), [&](const Override& o) { return is_inside(path, o.path); });
  if (setter != _overrides.rend()) return fmt::format("--set {}", setter->words);
  if (line > 0) return fmt::format("{}:{}", _origin, line);
  const auto maker =
      std::find_if(_overrides.rbegin(), _overrides.rend(), [&](const Override& o) { return is_inside(o.path, path); });
  return maker != _overrides.rend() ? fmt::format("--set {}", maker->words) : fmt::format("{}:1", _origin);
}

std::string Source::place_of(std::string_view path, int line) const {
  return fmt::format("{}: {}", place(path, line), path.empty() ? "scene" : quoted(std::string(path)));
}

void Source::fail(std::string_view path, int line, const std::string& problem) const {
  throw core::InputError(fmt::format("{}: {}", place_of(path, line), problem));
}

}  // namespace orbweaver::document
