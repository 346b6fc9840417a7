#include "source.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "orbweaver/core/error.hpp"

namespace orbweaver::scene {

namespace {

bool is_inside(std::string_view path, std::string_view outer) {
  if (!path.starts_with(outer)) return false;
  return path.size() == outer.size() || path[outer.size()] == '.' || path[outer.size()] == '[';
}

}  // namespace

std::string printable(std::string text) {
  for (char& c : text)
    if (static_cast<unsigned char>(c) < ' ') c = ' ';
  return text;
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

void Source::fail(std::string_view path, int line, const std::string& problem) const {
  const std::string subject = path.empty() ? "scene" : printable(std::string(path));
  throw core::InputError(fmt::format("{}: {}: {}", place(path, line), subject, problem));
}

YAML::Node parse_document(const std::string& text, const std::string& place, bool lines) {
  std::vector<YAML::Node> documents;
  try {
    documents = YAML::LoadAll(text);
  } catch (const YAML::Exception& error) {
    const std::string where = lines && !error.mark.is_null() ? fmt::format("{}:{}", place, error.mark.line + 1) : place;
    throw core::InputError(
        fmt::format("{}: expected YAML, got a syntax error ({}); check brackets, colons and indentation, which takes "
                    "spaces and no tabs",
                    where, printable(error.msg)));
  }
  if (documents.size() > 1) {
    const YAML::Mark mark = documents[1].Mark();
    const std::string where = lines && !mark.is_null() ? fmt::format("{}:{}", place, mark.line + 1) : place;
    throw core::InputError(fmt::format(
        "{}: expected one YAML document, got {}; keep one and remove the `---` between them", where, documents.size()));
  }
  return documents.empty() ? YAML::Node(YAML::NodeType::Null) : documents.front();
}

}  // namespace orbweaver::scene
