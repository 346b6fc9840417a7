#include "orbweaver/document/field.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <numbers>
#include <set>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "orbweaver/core/text.hpp"
#include "orbweaver/document/suggest.hpp"
#include "orbweaver/document/units.hpp"

namespace orbweaver::document {

namespace {

bool is_quoted(const YAML::Node& node) { return node.Tag() == "!"; }

std::string shorten(const std::string& text) { return core::shortened(core::printable(text), 40); }

std::string written(const YAML::Node& node) {
  if (node.IsScalar()) return is_quoted(node) ? fmt::format("\"{}\"", shorten(node.Scalar())) : shorten(node.Scalar());
  if (!node.IsSequence()) return node.IsMap() ? "{...}" : "~";
  std::string text = "[";
  constexpr std::size_t most_written = 40;  // values; no more of them fit
  for (std::size_t i = 0; i < std::min(node.size(), most_written); ++i) {
    if (i > 0) text += ", ";
    text += node[i].IsScalar() ? shorten(node[i].Scalar()) : "...";
  }
  return core::shortened(text + "]", 40);
}

/// What to do about a key that is not known. YAML takes `period:30` for a key, not for a key with a value.
std::string advice_for(const std::string& key, const std::vector<std::string>& known) {
  const std::size_t colon = key.find(':');
  if (colon != std::string::npos && std::find(known.begin(), known.end(), key.substr(0, colon)) != known.end())
    return fmt::format("write a space after the colon of `{}:`", key.substr(0, colon));
  // YAML takes `{m1: 1,5}` for two entries, `m1: 1` and the key `5`.
  if (!key.empty() && std::all_of(key.begin(), key.end(), [](unsigned char c) { return std::isdigit(c) != 0; }))
    return "a decimal comma? Write a decimal point, as in 1.5";
  const std::string near = nearest(key, known);
  return near.empty() ? "remove it" : fmt::format("did you mean `{}`?", near);
}

int line_of(const YAML::Node& node) { return node.Mark().is_null() ? 0 : node.Mark().line + 1; }

std::string join(std::string_view path, std::string_view key) {
  return path.empty() ? std::string(key) : fmt::format("{}.{}", path, key);
}

}  // namespace

bool NumberRule::admits(double value) const {
  if (std::isinf(value) && !infinite) return false;
  return value <= upper && (lower_open ? value > lower : value >= lower);
}

std::string NumberRule::describe() const {
  std::string text = infinite || std::isfinite(lower) || std::isfinite(upper) ? "a number" : "a finite number";
  if (std::isfinite(lower) && std::isfinite(upper))
    text += lower_open ? fmt::format(" > {} and <= {}", lower, upper) : fmt::format(" from {} to {}", lower, upper);
  else if (std::isfinite(lower))
    text += fmt::format(" {} {}", lower_open ? ">" : ">=", lower);
  else if (std::isfinite(upper))
    text += fmt::format(" <= {}", upper);
  return infinite ? text + " or infinite" : text;
}

std::string IntegerRule::describe() const {
  if (upper == std::numeric_limits<int>::max()) return fmt::format("an integer >= {}", lower);
  return fmt::format("an integer from {} to {}", lower, upper);
}

Field::Field(const Source& source, YAML::Node node, std::string path, int line)
    : _source(&source), _node(std::move(node)), _path(std::move(path)), _line(line) {}

std::string Field::key() const { return _path.substr(_path.rfind('.') + 1); }

std::string Field::got() const {
  if (_node.IsNull()) return "nothing";
  if (_node.IsSequence()) return fmt::format("the list {}", written(_node));
  if (_node.IsMap()) return "a map";
  if (is_quoted(_node)) return fmt::format("the quoted text {}", written(_node));
  if (!plain_scalar()) return fmt::format("`{}` with the tag {}", written(_node), _node.Tag());
  return fmt::format("`{}`", written(_node));
}

std::string Field::place(int lines) const { return _source->place_of(_path, _line > 0 ? _line + lines : 0); }

void Field::fail(const std::string& problem) const { _source->fail(_path, _line, problem); }

void Field::fail(const std::string& expected, const std::string& came, const std::string& advice) const {
  fail(fmt::format("expected {}, got {}; {}", expected, came, advice));
}

std::optional<std::string> Field::scalar() const {
  if (!_node.IsScalar() || (!is_quoted(_node) && !plain_scalar())) return std::nullopt;
  return _node.Scalar();
}

std::optional<std::string> Field::plain_scalar() const {
  if (!_node.IsScalar() || (_node.Tag() != "?" && !_node.Tag().empty())) return std::nullopt;
  return _node.Scalar();
}

std::string Field::text(std::string_view example, std::size_t longest) const {
  const auto refuse = [&](const std::string& expected) {
    fail(expected, got(), fmt::format("for example `{}`", example));
  };
  if (!_node.IsScalar() || (!is_quoted(_node) && !plain_scalar())) refuse("text");
  const std::string& value = _node.Scalar();
  if (value.empty() || value.size() > longest || core::printable(value) != value)
    refuse(fmt::format("one line of text with 1 to {} characters", longest));
  return value;
}

std::string Field::choice(const std::vector<std::string>& known) const {
  const std::string expected = known.size() == 1 ? known.front() : "one of " + alternatives(known);
  if (!_node.IsScalar()) fail(expected, got(), "write one of them");
  if (std::find(known.begin(), known.end(), _node.Scalar()) != known.end()) return _node.Scalar();
  const std::string near = nearest(_node.Scalar(), known);
  fail(expected, got(), near.empty() ? "write one of them" : fmt::format("did you mean `{}`?", near));
}

double Field::number(const NumberRule& rule) const {
  const std::optional<std::string> scalar = plain_scalar();
  const std::optional<double> value = scalar ? parse_number(*scalar) : std::nullopt;
  if (!value || !rule.admits(*value)) fail(rule.describe(), got(), example_advice(rule.example));
  return *value;
}

int Field::integer(const IntegerRule& rule) const {
  const std::optional<std::string> scalar = plain_scalar();
  const std::optional<int> value = scalar ? parse_integer(*scalar) : std::nullopt;
  if (!value || *value < rule.lower || *value > rule.upper) fail(rule.describe(), got(), example_advice(rule.example));
  return *value;
}

double Field::length(bool angles, std::string_view also) const { return angles ? angle(also) : plain_length(also); }

double Field::plain_length(std::string_view also) const {
  const std::optional<std::string> scalar = plain_scalar();
  const std::optional<double> value = scalar ? parse_number(*scalar) : std::nullopt;
  if (!value || !std::isfinite(*value) || !(*value > 0)) {
    fail(fmt::format("{}a number > 0 in the units of the coordinate with the largest scale, for the system has no "
                     "angles",
                     also),
         got(), "for example 0.01");
  }
  return *value;
}

double Field::angle(std::string_view also) const {
  const std::optional<std::string> scalar = plain_scalar();
  const std::optional<double> value = scalar ? parse_angle(*scalar) : std::nullopt;
  if (!value || !(*value > 0) || *value > std::numbers::pi / 2) {
    const bool lacks_unit = scalar && parse_number(*scalar);
    fail(fmt::format("{}an angle with its unit, > 0 and at most 90deg", also), got(),
         lacks_unit ? fmt::format("write {}deg or {}rad", *scalar, *scalar) : "for example 0.5deg or 0.01rad");
  }
  return *value;
}

std::vector<Field> Field::list(std::string_view example) const {
  if (!_node.IsSequence()) fail("a list", got(), fmt::format("for example {}", example));
  std::vector<Field> items;
  for (std::size_t i = 0; i < _node.size(); ++i) {
    const int line = line_of(_node[i]);
    items.emplace_back(*_source, _node[i], fmt::format("{}[{}]", _path, i),
                       line > 0 && !_node[i].IsNull() ? line : _line);
  }
  return items;
}

std::string Field::example_advice(std::string_view example) const {
  const bool dressed = _node.IsScalar() && !plain_scalar();
  return fmt::format("{}for example {}", dressed ? "write it without quotes or tag, " : "", example);
}

std::pair<double, double> Field::range(const NumberRule& rule) const {
  const std::string example = std::string(rule.example);
  const std::vector<Field> items = list(example);
  if (items.size() != 2) fail("a list of two numbers, from and to", got(), "for example " + example);
  const double from = items[0].number(rule);
  const double to = items[1].number(rule);
  if (!(from < to)) fail("from < to", got(), "give the smaller number first");
  return {from, to};
}

std::vector<double> Field::numbers(const NumberRule& rule) const {
  std::vector<double> values;
  std::set<double> known;
  for (const Field& item : list("[1, 2]")) {
    values.push_back(item.number(rule));
    if (!known.insert(values.back()).second)
      item.fail("a value that the list does not hold yet", item.got() + " again", "remove one");
  }
  return values;
}

std::vector<Field::Entry> Field::entries(std::string_view example, bool complex_keys) const {
  if (!_node.IsMap()) fail("a map", got(), fmt::format("for example `{}`", example));
  std::vector<Entry> result;
  std::set<std::string> known;
  for (const auto& pair : _node) {
    const int key_line = line_of(pair.first);
    const std::string name = pair.first.IsScalar() ? pair.first.Scalar() : written(pair.first);
    Entry entry{Field(*_source, pair.first, join(_path, name), key_line > 0 ? key_line : 0),
                Field(*_source, pair.second, join(_path, name), key_line > 0 ? key_line : 0)};
    if (!(complex_keys ? pair.first.IsSequence() : pair.first.IsScalar()))
      entry.key.fail(complex_keys ? "a list as key" : "text as key", entry.key.got(),
                     fmt::format("for example `{}`", example));
    if (!complex_keys && !known.insert(name).second) entry.key.fail("a key once", "it again", "remove one of the two");
    result.push_back(std::move(entry));
  }
  return result;
}

Keys::Keys(const Field& field, std::vector<std::string> known, std::string_view example)
    : _known(std::move(known)), _entries(field.entries(example)) {
  for (const Field::Entry& entry : _entries) {
    const std::string name = entry.key.path().substr(field.path().empty() ? 0 : field.path().size() + 1);
    if (std::find(_known.begin(), _known.end(), name) != _known.end()) continue;
    entry.key.fail(fmt::format("unknown key, expected {}{}, got {}; {}", _known.size() > 1 ? "one of " : "",
                               alternatives(_known), entry.key.got(), advice_for(name, _known)));
  }
}

std::optional<Field> Keys::find(std::string_view key) const {
  if (std::find(_known.begin(), _known.end(), key) == _known.end())
    throw std::logic_error(fmt::format("`{}` is read, but is no known key", key));
  const auto entry = std::find_if(_entries.begin(), _entries.end(), [&](const Field::Entry& e) {
    return e.key.path() == key || e.key.path().ends_with(fmt::format(".{}", key));
  });
  if (entry == _entries.end()) return std::nullopt;
  return entry->value;
}

}  // namespace orbweaver::document
