#include "orbweaver/document/document.hpp"

#include <algorithm>
#include <map>
#include <sstream>
#include <vector>

#include <fmt/format.h>
#include <yaml-cpp/eventhandler.h>

#include "orbweaver/core/error.hpp"
#include "orbweaver/core/text.hpp"

namespace orbweaver::document {

namespace {

/// Ends the reading where a document holds more than a scene may.
class BoundedDocument : public YAML::EventHandler {
 public:
  struct Refusal {
    YAML::Mark mark;
    std::string problem;
  };

  void OnDocumentStart(const YAML::Mark& mark) override {
    if (_begun)
      throw Refusal{mark,
                    "expected one YAML document, got a second; remove the `---` between them, or the comma that stands "
                    "outside of brackets"};
    _begun = true;
  }
  void OnDocumentEnd() override {}
  [[nodiscard]] bool begun() const noexcept { return _begun; }

  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override { add_leaf(mark, anchor); }
  void OnScalar(const YAML::Mark& mark, const std::string& /*tag*/, YAML::anchor_t anchor,
                const std::string& /*value*/) override {
    add_leaf(mark, anchor);
  }

  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    const auto whole = _anchored.find(anchor);
    if (whole == _anchored.end())
      throw Refusal{mark, "expected a value, got an alias for the list or map that it stands in; write the value out"};
    add(mark, whole->second);
  }

  void OnSequenceStart(const YAML::Mark& mark, const std::string& /*tag*/, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value /*style*/) override {
    open(mark, anchor);
  }
  void OnSequenceEnd() override { close(); }

  void OnMapStart(const YAML::Mark& mark, const std::string& /*tag*/, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value /*style*/) override {
    open(mark, anchor);
  }
  void OnMapEnd() override { close(); }

 private:
  struct Extent {
    std::size_t nodes = 1;
    std::size_t levels = 0;  // of lists and maps in one another, itself included
  };
  struct Open {
    YAML::anchor_t anchor = 0;
    Extent extent;
  };

  void add(const YAML::Mark& mark, const Extent& extent) {
    _nodes += extent.nodes;
    if (_nodes > most_nodes)
      throw Refusal{mark,
                    fmt::format("expected at most {} values, lists and maps (what aliases stand for included), got "
                                "more; thin the lists out",
                                most_nodes)};
    if (_open.size() + extent.levels > most_levels)
      throw Refusal{mark, fmt::format("expected at most {} lists or maps in one another, got more; a scene has no more "
                                      "than five levels",
                                      most_levels)};
    if (_open.empty()) return;
    _open.back().extent.nodes += extent.nodes;
    deepen(extent);
  }

  void deepen(const Extent& inner) {
    Extent& outer = _open.back().extent;
    outer.levels = std::max(outer.levels, inner.levels + 1);
  }

  void remember(YAML::anchor_t anchor, const Extent& extent) {
    if (anchor != 0) _anchored[anchor] = extent;
  }

  void add_leaf(const YAML::Mark& mark, YAML::anchor_t anchor) {
    remember(anchor, {});
    add(mark, {});
  }

  void open(const YAML::Mark& mark, YAML::anchor_t anchor) {
    add(mark, {.nodes = 1, .levels = 1});
    _open.push_back({anchor, {.nodes = 1, .levels = 1}});
  }

  void close() {
    const Open closed = _open.back();
    _open.pop_back();
    remember(closed.anchor, closed.extent);
    if (_open.empty()) return;
    _open.back().extent.nodes += closed.extent.nodes - 1;  // itself is counted
    deepen(closed.extent);
  }

  bool _begun = false;
  std::size_t _nodes = 0;
  std::vector<Open> _open;
  std::map<YAML::anchor_t, Extent> _anchored;
};

[[noreturn]] void refuse(const std::string& place, const YAML::Mark& mark, bool lines, const std::string& problem) {
  const std::string where = lines && !mark.is_null() ? fmt::format("{}:{}", place, mark.line + 1) : place;
  throw core::InputError(fmt::format("{}: {}", where, problem));
}

YAML::Mark mark_at(const std::string& text, std::size_t at) {
  YAML::Mark mark;
  mark.line = static_cast<int>(std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n'));
  return mark;
}

}  // namespace

void require_scene_size(std::size_t bytes, const std::string& place) {
  if (bytes > longest_scene)
    throw core::InputError(
        fmt::format("{}: a scene of {} bytes does not fit into the archive, which keeps its text: expected at most {}; "
                    "shorten its comments",
                    place, bytes, longest_scene));
}

void require_text(const std::string& text, const std::string& place, bool lines) {
  const std::size_t at = core::first_untextual(text);
  if (at == std::string::npos) return require_scene_size(text.size(), place);
  refuse(place, mark_at(text, at), lines,
         fmt::format("expected a scene, text in UTF-8, got the byte 0x{:02x}; give the scene, not an archive or a "
                     "program, and save it as UTF-8",
                     static_cast<unsigned char>(text[at])));
}

YAML::Node parse_document(const std::string& text, const std::string& place, bool lines) {
  require_text(text, place, lines);
  try {
    std::istringstream stream(text);
    YAML::Parser parser(stream);
    BoundedDocument document;
    while (parser.HandleNextDocument(document)) {
    }
    return document.begun() ? YAML::Load(text) : YAML::Node(YAML::NodeType::Null);
  } catch (const BoundedDocument::Refusal& refusal) {
    refuse(place, refusal.mark, lines, refusal.problem);
  } catch (const YAML::Exception& error) {
    refuse(place, error.mark, lines,
           fmt::format("expected YAML, got a syntax error ({}); check brackets, colons and indentation, which takes "
                       "spaces and no tabs",
                       core::printable(error.msg)));
  }
}

}  // namespace orbweaver::document
