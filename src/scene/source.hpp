#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <yaml-cpp/yaml.h>

namespace orbweaver::scene {

/// One `--set path=value`.
struct Override {
  std::string path;  ///< keys joined by dots
  YAML::Node value;
  std::string words;  ///< as given, for messages
};

/// Where the values of a scene come from, so that a message can point there.
class Source {
 public:
  Source(std::string origin, std::vector<Override> overrides);

  /// Throws core::InputError "place: path: problem". The place is the last override that set `path` or something around
  /// it, otherwise `origin:line` (line counted from 1; 0 where the file has no such line: the origin's first).
  [[noreturn]] void fail(std::string_view path, int line, const std::string& problem) const;

  [[nodiscard]] const std::string& origin() const noexcept { return _origin; }
  [[nodiscard]] const std::vector<Override>& overrides() const noexcept { return _overrides; }

 private:
  [[nodiscard]] std::string place(std::string_view path, int line) const;

  std::string _origin;
  std::vector<Override> _overrides;
};

/// The text with control characters replaced by blanks, for messages that quote what came.
[[nodiscard]] std::string printable(std::string text);

/// Parses exactly one YAML document. Throws core::InputError on a syntax error ("place:line: ..." with `lines`, else
/// "place: ..."), and on more than one document; returns a null node for an empty one.
[[nodiscard]] YAML::Node parse_document(const std::string& text, const std::string& place, bool lines);

}  // namespace orbweaver::scene
