#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include <fmt/format.h>

#include "orbweaver/core/error.hpp"
#include "orbweaver/core/text.hpp"
#include "orbweaver/document/suggest.hpp"
#include "orbweaver/document/units.hpp"
#include "orbweaver/model/evaluate.hpp"
#include "orbweaver/model/scope.hpp"
#include "orbweaver/systems/text/model_text.hpp"

namespace orbweaver::systems {

namespace {

using document::Field;
using document::Keys;
using model::parse_formula;
using model::PlacedFormula;

constexpr std::size_t longest_phrase = 200;

std::string trimmed(const std::string& text) {
  const std::size_t first = text.find_first_not_of(" \t\r");
  if (first == std::string::npos) return "";
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

/// The text of a formula; `after` is what stands before it on its line.
PlacedFormula formula_of(const Field& field) {
  if (const auto text = field.scalar(); text && !trimmed(*text).empty()) return parse_formula(*text, field.place());
  field.fail("a formula", field.got(),
             field.is_map() || field.is_list() ? "put it between quotes, for YAML takes its `,`, `[` or `{` for its own"
                                               : "write one, as in `x - x^3`");
}

std::string name_of(const std::string& text, const std::string& place) {
  if (!model::is_name(text))
    throw core::InputError(fmt::format("{}: expected a name of letters, digits and _, got `{}`", place,
                                       core::shortened(core::printable(text), 60)));
  return text;
}

/// "for i = 1..n", with or without a colon behind it.
std::optional<IndexLoop> loop_of(std::string line, const std::string& place) {
  line = trimmed(line);
  if (!line.starts_with("for ")) return std::nullopt;
  if (line.ends_with(':')) line.pop_back();
  const std::size_t equals = line.find('=');
  const std::size_t dots = line.find("..");
  if (equals == std::string::npos || dots == std::string::npos || dots < equals)
    throw core::InputError(fmt::format("{}: expected `for i = 1..n:`, got `{}`", place, line));
  return IndexLoop{name_of(trimmed(line.substr(4, equals - 4)), place),
                   parse_formula(line.substr(equals + 1, dots - equals - 1), place),
                   parse_formula(line.substr(dots + 2), place)};
}

/// What a line is about, to the left of its formula.
using ReadLeft = std::function<void(const std::string& left, const std::string& place, IndexedLine& line)>;

void left_of_equation(const std::string& left, const std::string& place, IndexedLine& line) {
  const model::LeftSide side = model::parse_left_side(left, place);
  if (side.order < 1 || side.order > 2)
    throw core::InputError(fmt::format(
        "{}: expected a derivative to the left, `{}'` or `{}''`, got `{}`{}", place, side.name, side.name, left,
        side.order == 0 ? "; what is no derivative belongs into `definitions`, and maps, "
                          "delays and algebraic equations are not done"
                        : ""));
  line.name = side.name;
  line.index = side.index;
  line.order = side.order;
}

void left_of_value(const std::string& left, const std::string& place, IndexedLine& line) {
  const model::LeftSide side = model::parse_left_side(left, place);
  if (side.order != 0) throw core::InputError(fmt::format("{}: expected a name, got `{}`", place, left));
  line.name = side.name;
  line.index = side.index;
}

/// `name`, `name(a, b)`, `name[i]`.
void left_of_definition(const std::string& left, const std::string& place, IndexedLine& line) {
  const std::size_t open = left.find('(');
  if (open == std::string::npos) return left_of_value(left, place, line);
  line.name = name_of(trimmed(left.substr(0, open)), place);
  std::string rest = trimmed(left.substr(open + 1));
  if (!rest.ends_with(')'))
    throw core::InputError(fmt::format("{}: expected `{}(a, b)`, got `{}`", place, line.name, left));
  rest.pop_back();
  while (true) {
    const std::size_t comma = rest.find(',');
    const std::string argument = name_of(trimmed(rest.substr(0, comma)), place);
    if (std::find(line.arguments.begin(), line.arguments.end(), argument) != line.arguments.end())
      throw core::InputError(
          fmt::format("{}: expected arguments with different names, got `{}` twice", place, argument));
    line.arguments.push_back(argument);
    if (comma == std::string::npos) break;
    rest.erase(0, comma + 1);
  }
}

/// Lines as one text: `x' = y` each, `#` begins a comment, what stands deeper below a `for` belongs to it.
void read_block(const Field& field, const std::string& text, const ReadLeft& read_left,
                std::vector<IndexedLine>& lines) {
  struct Open {
    std::size_t depth;
    IndexLoop loop;
  };
  std::vector<Open> open;
  std::size_t from = 0;
  for (int number = 1; from < text.size(); ++number) {
    const std::size_t end = std::min(text.find('\n', from), text.size());
    std::string line = text.substr(from, end - from);
    from = end + 1;
    if (const std::size_t comment = line.find('#'); comment != std::string::npos) line.erase(comment);
    const std::size_t depth = line.find_first_not_of(" \t\r");
    if (depth == std::string::npos) continue;
    const std::string place = field.place(number);
    while (!open.empty() && depth <= open.back().depth) open.pop_back();
    if (auto loop = loop_of(line, place)) {
      open.push_back({depth, std::move(*loop)});
      continue;
    }
    const std::size_t equals = line.find('=');
    if (equals == std::string::npos)
      throw core::InputError(fmt::format("{}: expected `x' = ...`, got `{}`", place, core::printable(trimmed(line))));
    IndexedLine& read = lines.emplace_back();
    for (const Open& one : open) read.loops.push_back(one.loop);
    read_left(trimmed(line.substr(0, equals)), place, read);
    read.formula = parse_formula(line.substr(equals + 1), place);
  }
}

void read_lines(const Field& field, const ReadLeft& read_left, const std::string& example,
                std::vector<IndexedLine>& lines, const std::vector<IndexLoop>& loops = {},
                const std::vector<std::string>& except = {}) {
  if (const auto text = field.scalar()) return read_block(field, *text, read_left, lines);
  for (const Field::Entry& entry : field.entries(example)) {
    const std::string left = entry.key.scalar().value_or("");
    if (std::find(except.begin(), except.end(), left) != except.end()) continue;
    if (auto loop = loop_of(left, entry.key.place())) {
      std::vector<IndexLoop> deeper = loops;
      deeper.push_back(std::move(*loop));
      constexpr std::size_t most_loops = 4;
      if (deeper.size() > most_loops) entry.key.fail("at most four loops in one another", "more", "write fewer");
      read_lines(entry.value, read_left, example, lines, deeper);
      continue;
    }
    IndexedLine line;
    line.loops = loops;
    read_left(left, entry.key.place(), line);
    line.formula = formula_of(entry.value);
    lines.push_back(std::move(line));
  }
}

/// `x` or `x[1..n]`.
NameRange range_of(const std::string& text, const std::string& place) {
  NameRange range;
  range.place = place;
  const std::string name = trimmed(text);
  const std::size_t open = name.find('[');
  range.name = name_of(trimmed(name.substr(0, open)), place);
  if (open == std::string::npos) return range;
  const std::size_t dots = name.find("..", open);
  if (dots == std::string::npos || !name.ends_with(']'))
    throw core::InputError(fmt::format("{}: expected `{}[1..n]`, got `{}`", place, range.name, name));
  range.range = IndexLoop{"", parse_formula(name.substr(open + 1, dots - open - 1), place),
                          parse_formula(name.substr(dots + 2, name.size() - dots - 3), place)};
  return range;
}

/// A list, or the same as one text with commas, which needs no quotes where brackets are in it.
std::vector<NameRange> names_of(const Field& field) {
  std::vector<NameRange> names;
  if (const auto text = field.scalar()) {
    std::size_t from = 0;
    while (from <= text->size()) {
      const std::size_t comma = std::min(text->find(',', from), text->size());
      names.push_back(range_of(text->substr(from, comma - from), field.place()));
      from = comma + 1;
    }
    return names;
  }
  for (const Field& item : field.list("[x, y]")) {
    const auto text = item.scalar();
    if (!text) item.fail("the name of a coordinate", item.got(), "for example [x, y], or \"x[1..n]\"");
    names.push_back(range_of(*text, item.place()));
  }
  return names;
}

/// Of a formula of numbers alone, such as 8/3.
double number_of(const PlacedFormula& formula) {
  model::Graph graph;
  const std::vector<int> node{model::Scope(graph).evaluate(formula)};
  return model::evaluate<double>(graph, node, std::span<const double>(), std::span<const double>()).front();
}

ParameterText parameter_of(const std::string& name, const Field& value) {
  ParameterText text;
  Parameter& parameter = text.parameter;
  parameter.name = name;
  parameter.lower = -std::numeric_limits<double>::infinity();
  parameter.upper = std::numeric_limits<double>::infinity();
  parameter.unit = "1";
  if (!value.is_map()) {
    parameter.standard = value.number({.example = "1"});
    return text;
  }
  const Keys keys(value, {"value", "range", "above", "unit", "meaning"}, "{value: 1, range: [0, 2]}");
  if (const auto given = keys.find("unit")) parameter.unit = given->text("m", longest_phrase);
  if (const auto given = keys.find("meaning")) parameter.meaning = given->text("stiffness", longest_phrase);
  if (const auto given = keys.find("range")) {
    const auto [lower, upper] = given->range({.infinite = true, .example = "[0, 1]"});
    parameter.lower = lower;
    parameter.upper = upper;
  }
  if (const auto given = keys.find("above")) {
    parameter.lower = std::max(parameter.lower, given->number({.example = "0"}));
    parameter.lower_open = true;
  }
  const auto standard = keys.find("value");
  if (!standard) value.fail("a `value`", "none", "for example {value: 1, range: [0, 2]}");
  const document::NumberRule rule{
      .lower = parameter.lower, .upper = parameter.upper, .lower_open = parameter.lower_open, .example = "1"};
  const auto written = standard->plain_scalar();
  if (!written || document::parse_number(*written)) {
    parameter.standard = standard->number(rule);
    return text;
  }
  parameter.standard = number_of(formula_of(*standard));
  if (!rule.admits(parameter.standard)) standard->fail(rule.describe(), standard->got(), "change it, or the range");
  return text;
}

/// A number is a parameter; a formula is a definition.
void read_parameters(const Field& field, TermsText& terms) {
  for (const Field::Entry& entry : field.entries("parameters: {a: 1}")) {
    const std::string name = name_of(entry.key.scalar().value_or(""), entry.key.place());
    const auto text = entry.value.plain_scalar();
    if (entry.value.is_map() || (text && document::parse_number(*text))) {
      terms.parameters.push_back(parameter_of(name, entry.value));
      continue;
    }
    IndexedLine line;
    line.name = name;
    line.formula = formula_of(entry.value);
    terms.definitions.push_back(std::move(line));
  }
}

void read_sizes(const Field& field, TermsText& terms) {
  for (const Field::Entry& entry : field.entries("sizes: {n: 10}")) {
    ParameterText size;
    const std::string name = name_of(entry.key.scalar().value_or(""), entry.key.place());
    if (entry.value.is_map()) {
      size = parameter_of(name, entry.value);
    } else {
      constexpr int most = 1000;
      size.parameter = {.name = name, .standard = 0.0, .lower = 1.0, .upper = most, .unit = "1", .meaning = ""};
      size.parameter.standard = entry.value.integer({.lower = 1, .upper = most, .example = "10"});
    }
    if (size.parameter.standard != std::floor(size.parameter.standard))
      entry.value.fail("a whole number", entry.value.got(), "sizes count coordinates");
    size.is_whole = true;
    terms.parameters.push_back(size);
  }
}

void read_guards(const Field& field, TermsText& terms) {
  for (const Field::Entry& entry : field.entries("guards: {r: sqrt(x^2 + y^2)}")) {
    Guard guard{name_of(entry.key.scalar().value_or(""), entry.key.place()), ""};
    if (!entry.value.is_map()) {
      terms.guards.emplace_back(guard, formula_of(entry.value));
      continue;
    }
    const Keys keys(entry.value, {"value", "body"}, "{value: sqrt(x^2 + y^2), body: the sun}");
    const auto value = keys.find("value");
    if (!value) entry.value.fail("a `value`", "none", "write what must stay above 0");
    if (const auto body = keys.find("body")) guard.body = body->text("the sun", longest_phrase);
    terms.guards.emplace_back(guard, formula_of(*value));
  }
}

/// Keys that a model and an effect have alike.
const std::vector<std::string> keys_of_terms{"parameters", "definitions", "hamiltonian", "lagrangian",
                                             "equations",  "forces",      "guards",      "drive"};

void read_terms(const Keys& keys, TermsText& terms) {
  if (const auto field = keys.find("parameters")) read_parameters(*field, terms);
  if (const auto field = keys.find("definitions"))
    read_lines(*field, left_of_definition, "definitions: {r: sqrt(x^2 + y^2)}", terms.definitions);
  if (const auto field = keys.find("hamiltonian")) terms.hamiltonian = formula_of(*field);
  if (const auto field = keys.find("lagrangian")) terms.lagrangian = formula_of(*field);
  if (const auto field = keys.find("equations"))
    read_lines(*field, left_of_equation, "equations: {x': y}", terms.equations);
  if (const auto field = keys.find("forces")) read_lines(*field, left_of_value, "forces: {x: -d*x'}", terms.forces);
  if (const auto field = keys.find("guards")) read_guards(*field, terms);
  if (const auto field = keys.find("drive")) {
    const Keys inner(*field, {"frequency"}, "drive: {frequency: w}");
    if (const auto frequency = inner.find("frequency")) terms.frequency = formula_of(*frequency);
  }
}

void read_effects(const Field& field, ModelText& text) {
  std::vector<std::string> known = keys_of_terms;
  known.insert(known.end(), {"meaning", "no_angles", "adds"});
  for (const Field::Entry& entry : field.entries("effects: {damping: {parameters: {d: 0}, forces: {x: -d*x'}}}")) {
    EffectText& effect = text.effects.emplace_back();
    effect.name = name_of(entry.key.scalar().value_or(""), entry.key.place());
    const Keys keys(entry.value, known, "{parameters: {d: 0}, forces: {x: -d*x'}}");
    if (const auto meaning = keys.find("meaning")) effect.meaning = meaning->text("friction", longest_phrase);
    read_terms(keys, effect.terms);
    if (const auto adds = keys.find("adds"))
      read_lines(*adds, left_of_definition, "adds: {mass: rod/3}", effect.terms.added);
    if (const auto names = keys.find("no_angles")) effect.no_angles = names_of(*names);
  }
}

/// A map, or a list of them, of which the first that holds has the name.
void read_symmetries(const Field& field, bool reverse, ModelText& text) {
  for (const Field::Entry& entry : field.entries("symmetries: {S: {x: -x}}")) {
    const std::vector<Field> maps = entry.value.is_list() ? entry.value.list("[{x: -x}]") : std::vector{entry.value};
    for (const Field& map : maps) {
      SymmetryText& symmetry = text.symmetries.emplace_back();
      symmetry.name = entry.key.text("S");
      symmetry.reverses = reverse;
      symmetry.place = entry.key.place();
      read_lines(map, left_of_value, "{x: -x}", symmetry.images, {}, {"if_it_holds"});
      for (const Field::Entry& own : map.entries("{x: -x}"))
        if (own.key.key() == "if_it_holds") symmetry.if_it_holds = own.value.choice({"true", "false"}) == "true";
    }
  }
}

void read_coordinates(const Field& field, ModelText& text) {
  if (!field.is_map()) {
    text.coordinates = names_of(field);
    return;
  }
  for (const Field::Entry& entry : field.entries("coordinates: {x: {angle: true}}")) {
    const NameRange range = range_of(entry.key.scalar().value_or(""), entry.key.place());
    text.coordinates.push_back(range);
    if (!entry.value.is_map() && !entry.value.scalar()) continue;
    const Keys keys(entry.value, {"angle", "winding"}, "{angle: true}");
    if (const auto angle = keys.find("angle"); angle && angle->choice({"true", "false"}) == "true")
      text.angles.push_back(range);
    if (const auto winding = keys.find("winding")) text.windings[range.name] = winding->text("n1");
  }
}

void read_ends(const Field& field, ModelText& text) {
  for (const Field::Entry& entry : field.entries("ends: {x: cyclic}")) {
    ModelText::EndsText& ends = text.ends.emplace_back();
    ends.name = name_of(entry.key.scalar().value_or(""), entry.key.place());
    if (entry.value.plain_scalar() == "cyclic") {
      ends.cyclic = true;
      continue;
    }
    for (const Field::Entry& own : entry.value.entries("{0: 0, n+1: \"x[n]\"}"))
      ends.beyond.emplace_back(formula_of(own.key), formula_of(own.value));
  }
}

}  // namespace

const std::vector<std::string>& model_keys() {
  static const std::vector<std::string> keys = [] {
    std::vector<std::string> all{"name",      "title",  "meaning", "coordinates", "velocities", "momenta",   "angles",
                                 "conserved", "action", "ends",    "sizes",       "symmetries", "reversors", "effects"};
    all.insert(all.end(), keys_of_terms.begin(), keys_of_terms.end());
    return all;
  }();
  return keys;
}

ModelText read_model(const Field& field, const std::vector<std::string>& also) {
  std::vector<std::string> known = model_keys();
  known.insert(known.end(), also.begin(), also.end());
  const Keys keys(field, known, "{equations: {x': y, y': -x}}");
  ModelText text;
  text.place = field.place();
  text.name = "model";
  if (const auto name = keys.find("name")) text.name = name->text("my_model");
  if (const auto title = keys.find("title")) text.title = title->text("My model", longest_phrase);
  if (const auto meaning = keys.find("meaning")) text.meaning = meaning->text("what moves", longest_phrase);
  if (text.title.empty()) text.title = text.name;
  if (text.meaning.empty()) text.meaning = text.title;
  if (const auto sizes = keys.find("sizes")) read_sizes(*sizes, text.terms);
  if (const auto names = keys.find("coordinates")) read_coordinates(*names, text);
  if (const auto names = keys.find("velocities")) text.velocities = names_of(*names);
  if (const auto names = keys.find("momenta")) text.momenta = names_of(*names);
  if (const auto names = keys.find("angles"))
    for (const NameRange& name : names_of(*names)) text.angles.push_back(name);
  read_terms(keys, text.terms);
  if (const auto own = keys.find("conserved"))
    for (const Field::Entry& entry : own->entries("conserved: {energy: (x^2 + y^2)/2}"))
      text.conserved.emplace_back(name_of(entry.key.scalar().value_or(""), entry.key.place()), formula_of(entry.value));
  if (const auto action = keys.find("action")) text.action = formula_of(*action);
  if (const auto ends = keys.find("ends")) read_ends(*ends, text);
  if (const auto own = keys.find("symmetries")) read_symmetries(*own, false, text);
  if (const auto own = keys.find("reversors")) read_symmetries(*own, true, text);
  if (const auto effects = keys.find("effects")) read_effects(*effects, text);
  const int forms =
      (text.terms.hamiltonian ? 1 : 0) + (text.terms.lagrangian ? 1 : 0) + (text.terms.equations.empty() ? 0 : 1);
  if (forms != 1)
    field.fail("one of `equations`, `hamiltonian` and `lagrangian`", forms == 0 ? "none" : "more than one",
               "for example `equations: {x': y, y': -x}`");
  return text;
}

}  // namespace orbweaver::systems
