#pragma once

#include <cstddef>
#include <string>

#include <yaml-cpp/yaml.h>

namespace orbweaver::document {

/// Bytes of a scene: the archive keeps its text in an attribute, HDF5 keeps attributes in an object header, and that
/// ends at 64 KiB.
constexpr std::size_t longest_scene = 60000;
/// Levels of lists and maps in one another; a scene has five, and yaml-cpp calls itself once a level.
constexpr std::size_t most_levels = 32;
/// Values, lists and maps of a document, an alias counted as all that it stands for; a list of as many numbers fits
/// into a scene.
constexpr std::size_t most_nodes = 20000;

/// Throws core::InputError "place: ..." where a scene has more than longest_scene bytes.
void require_scene_size(std::size_t bytes, const std::string& place);

/// Throws core::InputError where the text is longer than longest_scene, or no UTF-8, or holds a zero byte.
void require_text(const std::string& text, const std::string& place, bool lines);

/// Parses one YAML document of at most longest_scene bytes, most_levels and most_nodes. Throws core::InputError
/// ("place:line: ..." with `lines`, else "place: ...") where the text is longer, no UTF-8, no YAML, more than one
/// document, or holds itself; returns a null node for an empty one.
[[nodiscard]] YAML::Node parse_document(const std::string& text, const std::string& place, bool lines);

}  // namespace orbweaver::document
