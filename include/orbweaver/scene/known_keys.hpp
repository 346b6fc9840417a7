#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace orbweaver::scene {

/// A key that a scene may have. The readers of scenes take the names that they know from here, and the reference
/// (`orbweaver manual scene`, docs/scenes.md) is printed from here.
struct KnownKey {
  std::string_view path;   ///< "limits.period"; `[]` stands for any entry of a list: "loci[].of"
  std::string_view value;  ///< what it takes, in the words of a refusal
  /// Its default: YAML in backticks, with what is to be said of it behind; text without backticks where YAML cannot.
  std::string_view standard;
  std::string_view unit;
  std::string_view meaning;

  /// "limits" of "limits.period", "" of a section.
  [[nodiscard]] std::string_view section() const;
  /// "period" of "limits.period".
  [[nodiscard]] std::string_view name() const;
};

/// All of them, section by section, each section before what is in it.
[[nodiscard]] std::span<const KnownKey> known_keys();

/// The names of the keys in a map of a scene, such as "limits" or "loci[2]"; "" is the scene itself. Throws
/// std::logic_error where there is no such map.
[[nodiscard]] std::vector<std::string> names_of_keys(std::string_view section);

}  // namespace orbweaver::scene
