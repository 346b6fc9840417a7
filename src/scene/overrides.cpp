#include "overrides.hpp"

#include <algorithm>
#include <sstream>

#include <fmt/format.h>

#include "fields.hpp"
#include "orbweaver/core/error.hpp"

namespace orbweaver::scene {

namespace {

std::vector<std::string> split_path(const Override& change) {
  std::vector<std::string> keys;
  std::istringstream stream(change.path);
  for (std::string key; std::getline(stream, key, '.');) keys.push_back(key);
  return keys;
}

YAML::Node with_value(const YAML::Node& node, const std::vector<std::string>& keys, std::size_t depth,
                      const Override& change) {
  if (depth == keys.size()) {
    // A number for a map that has a value and says more of it, as a model's parameters do.
    if (!change.value.IsScalar() || !node.IsMap() || !node["value"]) return change.value;
    YAML::Node valued = YAML::Clone(node);
    valued["value"] = change.value;
    return valued;
  }
  if (!node.IsMap() && !node.IsNull()) {
    throw core::InputError(fmt::format(
        "--set {}: expected a map at `{}`, got {}; set the whole value instead", change.words,
        quoted(fmt::format("{}", fmt::join(keys.begin(), keys.begin() + static_cast<std::ptrdiff_t>(depth), "."))),
        node.IsSequence() ? "a list" : fmt::format("`{}`", quoted(node.Scalar()))));
  }
  YAML::Node changed(YAML::NodeType::Map);
  bool found = false;
  if (node.IsMap()) {
    changed.SetStyle(node.Style());
    for (const auto& pair : node) {
      const bool here = pair.first.IsScalar() && pair.first.Scalar() == keys[depth];
      changed.force_insert(pair.first, here ? with_value(pair.second, keys, depth + 1, change) : pair.second);
      found = found || here;
    }
  }
  if (!found) changed.force_insert(keys[depth], with_value(YAML::Node(YAML::NodeType::Null), keys, depth + 1, change));
  return changed;
}

Override parse_override(const std::string& given) {
  const std::string words = quoted(given);
  const std::size_t equals = given.find('=');
  const std::string path = given.substr(0, equals);
  const bool hollow = path.empty() || path.front() == '.' || path.back() == '.' || path.find("..") != std::string::npos;
  if (equals == std::string::npos || hollow)
    throw core::InputError(
        fmt::format("--set {}: expected KEY=VALUE, got `{}`; for example --set limits.period=30", words, words));
  if (static_cast<std::size_t>(std::count(path.begin(), path.end(), '.')) >= most_levels)
    throw core::InputError(
        fmt::format("--set {}: expected at most {} keys joined by dots, got more", words, most_levels));
  require_text(path, fmt::format("--set {}", words), false);
  return {path, parse_document(given.substr(equals + 1), fmt::format("--set {}", words), false), words};
}

}  // namespace

std::vector<Override> parse_overrides(const std::vector<std::string>& overrides) {
  // Each makes a tree of its own of the scene's nodes.
  constexpr std::size_t most_overrides = 200;
  if (overrides.size() > most_overrides)
    throw core::InputError(fmt::format("--set: expected at most {} overrides, got {}; write them into the scene",
                                       most_overrides, overrides.size()));
  std::size_t bytes = 0;
  for (const std::string& words : overrides) bytes += words.size();
  require_scene_size(bytes, "--set");
  std::vector<Override> changes;
  for (const std::string& words : overrides) changes.push_back(parse_override(words));
  return changes;
}

YAML::Node apply_overrides(const YAML::Node& root, const std::vector<Override>& overrides) {
  YAML::Node changed = root;
  for (const Override& change : overrides) changed.reset(with_value(changed, split_path(change), 0, change));
  return changed;
}

}  // namespace orbweaver::scene
