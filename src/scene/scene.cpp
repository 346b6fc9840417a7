#include "orbweaver/scene/scene.hpp"

#include <fstream>
#include <optional>
#include <system_error>

#include <fmt/format.h>

#include "fields.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/core/input_file.hpp"
#include "orbweaver/systems/system.hpp"
#include "overrides.hpp"
#include "sections.hpp"
#include "starts_section.hpp"
#include "system_section.hpp"

namespace orbweaver::scene {

namespace {

constexpr std::string_view smallest_scene =
    "{system: {name: double_pendulum}, starts: {fixed_points: {grid: [[0, 180], [0, 180]]}}}";

Field require_key(const Keys& keys, const Field& root, const std::string& key, std::string_view example) {
  if (const auto field = keys.find(key)) return *field;
  root.fail(fmt::format("the key `{}`", key), "a scene without it", fmt::format("add for example `{}`", example));
}

Scene read_scene(const Field& root, const std::optional<std::filesystem::path>& folder, const std::string& model) {
  const Keys keys(root, names_of_keys(root.path()), smallest_scene);
  Scene scene;
  scene.model = model;
  read_system(require_key(keys, root, "system", "system: {name: double_pendulum}"), folder, scene.system, scene.model);
  if (const auto starts = keys.find("starts")) take_place(*starts, scene.system);
  read_family_scalars(keys.find("continuation"), scene.system);
  const auto bound = bound_system(scene.system);
  const systems::System& system = *bound;
  scene.name = scene.system.name;
  if (const auto name = keys.find("name")) scene.name = name->text("double-pendulum");
  read_starts(require_key(keys, root, "starts", "starts: {fixed_points: {grid: [[0, 180], [0, 180]]}}"), system, folder,
              scene);
  if (const auto field = keys.find("continuation")) read_continuation(*field, system, scene.continuation);
  if (const auto field = keys.find("survey")) read_survey(*field, scene.survey);
  if (const auto field = keys.find("compute")) read_compute(*field, scene.compute);
  if (!scene.compute.stability && scene.survey.depth > 0)
    keys.find("compute")->fail("`stability: true`, as branches are found by multipliers",
                               fmt::format("false, with survey.depth {}", scene.survey.depth), "leave one of them out");
  keep_to_model(scene.system, system, scene.limits);
  if (const auto field = keys.find("limits")) read_limits(*field, system, scene.limits);
  if (const auto field = keys.find("events")) read_events(*field, system, scene.events);
  if (const auto field = keys.find("section")) read_section(*field, system, scene.section);
  if (const auto field = keys.find("loci")) read_loci(*field, scene, system);
  if (const auto field = keys.find("output")) read_output(*field, scene.output);
  return scene;
}

std::string emit(const YAML::Node& root) {
  YAML::Emitter emitter;
  emitter << root;
  return std::string(emitter.c_str()) + "\n";
}

// No more than a byte beyond what a scene may have, which parse_document refuses. What is no text is not too long a
// scene.
std::string read_file(const std::filesystem::path& file) {
  if (const std::string got = core::unreadable_input(file); !got.empty())
    throw core::InputError(
        fmt::format("{}: expected a scene file that can be read, got {}; check the path", quoted(file.string()), got));
  std::error_code code;
  std::ifstream stream(file, std::ios::binary);
  std::string text(longest_scene + 1, '\0');
  stream.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(stream.gcount()));
  if (text.size() > longest_scene && text.find('\0') == std::string::npos)
    require_scene_size(std::filesystem::file_size(file, code), quoted(file.string()));
  return text;
}

}  // namespace

namespace {

Scene parse_in(const std::optional<std::filesystem::path>& folder, const std::string& text, const std::string& origin,
               const std::vector<std::string>& overrides, const std::string& model = "") {
  const std::string place = quoted(origin);
  const Source source(place, parse_overrides(overrides));
  const YAML::Node document = parse_document(text, place, true);
  if (!document.IsMap()) {
    const std::string came = document.IsNull() ? "an empty document" : Field(source, document, "", 1).got();
    throw core::InputError(
        fmt::format("{}:1: expected a scene, a map, got {}; for example {}", place, came, smallest_scene));
  }
  YAML::Node root = apply_overrides(document, source.overrides());
  Scene scene = read_scene(Field(source, root, "", 1), folder, model);
  if (scene.system.model && scene.model.empty()) scene.model = emit(root["system"]);
  const bool has_hashes = keep_hashes(scene, root);
  scene.text = overrides.empty() && has_hashes ? text : emit(root);
  require_scene_size(scene.text.size(), place);
  return scene;
}

}  // namespace

Scene parse(const std::string& text, const std::string& origin, const std::vector<std::string>& overrides,
            const std::string& model) {
  return parse_in(std::nullopt, text, origin, overrides, model);
}

Scene load(const std::filesystem::path& file, const std::vector<std::string>& overrides) {
  return parse_in(file.parent_path(), read_file(file), file.string(), overrides);
}

std::string written_value(const std::string& text, const std::string& key) {
  YAML::Node node = parse_document(text, "scene", true);
  for (std::size_t from = 0; from != std::string::npos && node && node.IsMap();) {
    const std::size_t dot = key.find('.', from);
    node.reset(node[key.substr(from, dot - from)]);
    from = dot == std::string::npos ? dot : dot + 1;
  }
  return node && node.IsScalar() ? node.Scalar() : "";
}

}  // namespace orbweaver::scene
