#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <yaml-cpp/yaml.h>

namespace orbweaver::document {

/// One `--set path=value`.
struct Override {
  std::string path;  ///< keys joined by dots
  YAML::Node value;
  std::string words;  ///< as messages quote it
};

/// Where the values of a scene come from, so that a message can point there.
class Source {
 public:
  Source(std::string origin, std::vector<Override> overrides);

  /// Throws core::InputError "place: path: problem". The place is the last override that set `path` or something around
  /// it, otherwise `origin:line` (line counted from 1; 0 where the file has no such line: the origin's first).
  [[noreturn]] void fail(std::string_view path, int line, const std::string& problem) const;

  /// "place: path", as `fail` begins.
  [[nodiscard]] std::string place_of(std::string_view path, int line) const;

  [[nodiscard]] const std::string& origin() const noexcept { return _origin; }
  [[nodiscard]] const std::vector<Override>& overrides() const noexcept { return _overrides; }

 private:
  [[nodiscard]] std::string place(std::string_view path, int line) const;

  std::string _origin;
  std::vector<Override> _overrides;
};

/// What a message quotes of it: escaped, at most 120 bytes (the end of a path and of an override says little more).
[[nodiscard]] std::string quoted(const std::string& text);

}  // namespace orbweaver::document
