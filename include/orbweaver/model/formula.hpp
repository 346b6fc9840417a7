#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace orbweaver::model {

/// Bytes of a formula, and levels of it within one another: what is longer is refused.
constexpr std::size_t longest_formula = 100000;
constexpr int most_levels = 200;

/// What a formula says, as a tree: numbers as they are written, names that nobody has looked up yet.
struct Formula {
  enum class Kind { number, name, call, sum, negate, add, subtract, multiply, divide, power };

  Kind kind = Kind::number;
  /// Of a number its digits without a point, of a name, or a call, itself: "x", "x'" (one or two primes).
  std::string text;
  int exponent = 0;            ///< of ten, behind the digits
  std::vector<Formula> index;  ///< of a name: x[i + 1] has one
  /// Operands, arguments; of a sum its first and last index and what is added up, `text` being the index.
  std::vector<Formula> parts;
  int column = 1;
};

/// A formula with its place: "scene.yaml:12: system.hamiltonian".
struct PlacedFormula {
  Formula formula;
  std::string text;
  std::string place;

  /// Throws core::InputError "place: column 7 of `...`: problem".
  [[noreturn]] void fail(int column, const std::string& problem) const;
};

/// Throws core::InputError with place, column, what was expected, what came and what to do.
[[nodiscard]] PlacedFormula parse_formula(std::string_view text, const std::string& place);

/// What stands to the left of an equation: "x", its derivative's order, and its index, of `x'`, `x[i]''`, `dx/dt`.
struct LeftSide {
  std::string name;
  int order = 0;
  std::vector<Formula> index;
};
[[nodiscard]] LeftSide parse_left_side(std::string_view text, const std::string& place);

[[nodiscard]] bool is_name(std::string_view text);
/// Functions that formulas may call, in the order of the documents.
[[nodiscard]] const std::vector<std::string>& function_names();

}  // namespace orbweaver::model
