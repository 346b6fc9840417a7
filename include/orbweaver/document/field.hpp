#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <yaml-cpp/yaml.h>

#include "orbweaver/document/source.hpp"

namespace orbweaver::document {

/// Characters of the name of a file.
constexpr std::size_t longest_path = 4096;

/// What a number may be. `example` stands in messages.
struct NumberRule {
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
  bool lower_open = false;
  bool infinite = false;  ///< `.inf` and `-.inf` within the bounds are allowed
  std::string_view example = "1";

  [[nodiscard]] bool admits(double value) const;
  [[nodiscard]] std::string describe() const;
};

struct IntegerRule {
  int lower = 0;
  int upper = std::numeric_limits<int>::max();
  std::string_view example = "1";

  [[nodiscard]] std::string describe() const;
};

/// A node of the scene with its place: the only access to YAML that the readers of keys have. Every function throws
/// core::InputError with place, path, what was expected, what came and what to do.
class Field {
 public:
  Field(const Source& source, YAML::Node node, std::string path, int line);

  [[nodiscard]] const std::string& path() const noexcept { return _path; }
  /// The last key of the path.
  [[nodiscard]] std::string key() const;
  /// What stands here, for messages.
  [[nodiscard]] std::string got() const;

  /// "scene.yaml:12: limits.period", as messages begin; `lines` further down, where its text has several.
  [[nodiscard]] std::string place(int lines = 0) const;
  [[nodiscard]] bool is_map() const { return _node.IsMap(); }
  [[nodiscard]] bool is_list() const { return _node.IsSequence(); }

  [[noreturn]] void fail(const std::string& problem) const;
  [[noreturn]] void fail(const std::string& expected, const std::string& came, const std::string& advice) const;

  /// Non-empty text of at most `longest` characters on one line, without control characters.
  [[nodiscard]] std::string text(std::string_view example, std::size_t longest = 64) const;
  /// One of the words in `known`.
  [[nodiscard]] std::string choice(const std::vector<std::string>& known) const;
  [[nodiscard]] double number(const NumberRule& rule) const;
  [[nodiscard]] int integer(const IntegerRule& rule) const;
  /// A length in the space of states, > 0. Where a coordinate is an angle: with `deg` or `rad`, in radians, at most 90
  /// degrees. Elsewhere: a bare number, in the units of the coordinate with the largest scale. `also` names what else
  /// the key takes.
  [[nodiscard]] double length(bool angles, std::string_view also = "") const;
  /// A scalar, plain or quoted, of any lines; none for anything else.
  [[nodiscard]] std::optional<std::string> scalar() const;
  /// A plain scalar as written; none for anything else.
  [[nodiscard]] std::optional<std::string> plain_scalar() const;

  [[nodiscard]] std::vector<Field> list(std::string_view example) const;
  /// Two numbers, the first smaller than the second.
  [[nodiscard]] std::pair<double, double> range(const NumberRule& rule) const;
  /// Distinct numbers.
  [[nodiscard]] std::vector<double> numbers(const NumberRule& rule) const;

  struct Entry;
  /// The pairs of a map in their order; text as key is there once, lists (with `complex_keys`) may be there again.
  [[nodiscard]] std::vector<Entry> entries(std::string_view example, bool complex_keys = false) const;

 private:
  [[nodiscard]] double angle(std::string_view also) const;
  [[nodiscard]] double plain_length(std::string_view also) const;
  [[nodiscard]] std::string example_advice(std::string_view example) const;

  const Source* _source;
  YAML::Node _node;
  std::string _path;
  int _line;
};

struct Field::Entry {
  Field key;
  Field value;
};

/// A map whose keys are known beforehand.
class Keys {
 public:
  /// Refuses every key of `field` that is none of `known`, naming the nearest.
  Keys(const Field& field, std::vector<std::string> known, std::string_view example);

  /// The value of `key`, if the scene has it. Throws std::logic_error for a key that is not known.
  [[nodiscard]] std::optional<Field> find(std::string_view key) const;

 private:
  std::vector<std::string> _known;
  std::vector<Field::Entry> _entries;
};

}  // namespace orbweaver::document
