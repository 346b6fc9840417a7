#include "orbweaver/model/formula.hpp"

#include <algorithm>
#include <cctype>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "orbweaver/core/error.hpp"
#include "orbweaver/core/text.hpp"

namespace orbweaver::model {

namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }

struct Token {
  enum class Kind { number, name, sign, end };
  Kind kind = Kind::end;
  std::string text;  // of a number its digits
  int exponent = 0;
  int column = 1;
};

class Reader {
 public:
  Reader(std::string_view text, const PlacedFormula& place) : _text(text), _place(place) {
    while (true) {
      _tokens.push_back(next());
      if (_tokens.back().kind == Token::Kind::end) break;
    }
  }

  [[nodiscard]] Formula whole() {
    Formula formula = sum(0);
    if (!at_end()) refuse_more();
    return formula;
  }

  [[nodiscard]] LeftSide left_side() {
    LeftSide left;
    if (peek().kind != Token::Kind::name) refuse("the derivative of a coordinate, `x'` or `dx/dt`");
    std::string name = take().text;
    if (is("/")) {
      if (name.size() < 2 || name.front() != 'd') refuse("`dx/dt`");
      take();
      if (peek().text != "dt") refuse("`dt`");
      take();
      left.name = name.substr(1);
      left.order = 1;
    } else {
      const std::size_t end = name.find('\'');
      left.name = name.substr(0, end);
      left.order = end == std::string::npos ? 0 : static_cast<int>(name.size() - end);
      left.index = index(0);
      while (is("'")) {
        take();
        ++left.order;
      }
    }
    if (!at_end()) refuse("one derivative to the left of an equation");
    return left;
  }

 private:
  [[nodiscard]] const Token& peek(std::size_t ahead = 0) const {
    return _tokens[std::min(_at + ahead, _tokens.size() - 1)];
  }
  Token take() { return _tokens[_at + 1 < _tokens.size() ? _at++ : _at]; }
  [[nodiscard]] bool is(std::string_view sign) const { return peek().kind == Token::Kind::sign && peek().text == sign; }
  [[nodiscard]] bool at_end() const { return peek().kind == Token::Kind::end; }
  [[nodiscard]] std::string seen() const { return at_end() ? "the end" : fmt::format("`{}`", peek().text); }
  [[noreturn]] void refuse(const std::string& expected) const {
    _place.fail(peek().column, fmt::format("expected {}, got {}", expected, seen()));
  }
  [[noreturn]] void refuse_more() const {
    const bool multiplies = peek().kind != Token::Kind::sign || is("(");
    _place.fail(peek().column, fmt::format("expected an operator or the end, got {}{}", seen(),
                                           multiplies ? "; products are written with `*`, as in 2*x" : ""));
  }
  void expect(std::string_view sign) {
    if (!is(sign)) refuse(fmt::format("`{}`", sign));
    take();
  }

  Token next() {
    while (_next < _text.size() && std::isspace(static_cast<unsigned char>(_text[_next])) != 0) ++_next;
    Token token;
    token.column = static_cast<int>(_next) + 1;
    if (_next == _text.size()) return token;
    const char c = _text[_next];
    const bool fraction = c == '.' && _next + 1 < _text.size() && is_digit(_text[_next + 1]);
    if (is_digit(c) || fraction) return number(token);
    if (is_letter(c)) {
      token.kind = Token::Kind::name;
      while (_next < _text.size() && (is_letter(_text[_next]) || is_digit(_text[_next]))) token.text += _text[_next++];
      while (_next < _text.size() && _text[_next] == '\'') token.text += _text[_next++];
      return token;
    }
    token.kind = Token::Kind::sign;
    for (const std::string_view two : {"**", ".."})
      if (_text.substr(_next).starts_with(two)) token.text = two;
    if (token.text.empty() && std::string_view("+-*/^(),[]='").find(c) != std::string_view::npos) token.text = c;
    if (token.text.empty())
      _place.fail(token.column, fmt::format("expected a number, a name or an operator, got `{}`",
                                            core::printable(std::string(_text.substr(_next, 1)))));
    _next += token.text.size();
    if (token.text == "**") token.text = "^";
    return token;
  }

  Token number(Token token) {
    token.kind = Token::Kind::number;
    const auto digits = [&] {
      int count = 0;
      for (; _next < _text.size() && is_digit(_text[_next]); ++count) token.text += _text[_next++];
      return count;
    };
    digits();
    if (_next < _text.size() && _text[_next] == '.' && !_text.substr(_next).starts_with("..")) {
      ++_next;
      token.exponent = -digits();
    }
    if (_next < _text.size() && (_text[_next] == 'e' || _text[_next] == 'E')) {
      std::size_t at = _next + 1;
      const bool negative = at < _text.size() && _text[at] == '-';
      if (at < _text.size() && (_text[at] == '-' || _text[at] == '+')) ++at;
      int exponent = 0;
      const std::size_t from = at;
      for (; at < _text.size() && is_digit(_text[at]) && exponent < 10000; ++at)
        exponent = 10 * exponent + (_text[at] - '0');
      if (at > from) {
        _next = at;
        token.exponent += negative ? -exponent : exponent;
      }
    }
    const std::size_t leading = std::min(token.text.find_first_not_of('0'), token.text.size() - 1);
    token.text.erase(0, leading);
    constexpr int most_digits = 400;
    if (token.text.size() > most_digits || std::abs(token.exponent) > most_digits)
      _place.fail(token.column, "expected a number that a double holds, got one with more digits");
    if (_next < _text.size() && is_letter(_text[_next]))
      _place.fail(static_cast<int>(_next) + 1,
                  fmt::format("expected an operator behind the number, got `{}`; products are written with `*`, as in "
                              "2*x",
                              _text[_next]));
    return token;
  }

  static Formula node(Formula::Kind kind, int column, std::vector<Formula> parts) {
    Formula formula;
    formula.kind = kind;
    formula.column = column;
    formula.parts = std::move(parts);
    return formula;
  }

  void descend(int level) const {
    if (level > most_levels)
      _place.fail(peek().column,
                  fmt::format("expected a formula of at most {} levels, got more; give parts of it names "
                              "by `definitions`",
                              most_levels));
  }

  Formula sum(int level) {
    descend(level);
    Formula left = product(level + 1);
    while (is("+") || is("-")) {
      const Token sign = take();
      Formula right = product(level + 1);
      const auto kind = sign.text == "+" ? Formula::Kind::add : Formula::Kind::subtract;
      left = node(kind, sign.column, {std::move(left), std::move(right)});
    }
    return left;
  }

  Formula product(int level) {
    descend(level);
    Formula left = signed_factor(level + 1);
    while (is("*") || is("/")) {
      const Token sign = take();
      Formula right = signed_factor(level + 1);
      const auto kind = sign.text == "*" ? Formula::Kind::multiply : Formula::Kind::divide;
      left = node(kind, sign.column, {std::move(left), std::move(right)});
    }
    return left;
  }

  Formula signed_factor(int level) {
    descend(level);
    if (is("+")) {
      take();
      return signed_factor(level + 1);
    }
    if (is("-")) {
      const Token sign = take();
      return node(Formula::Kind::negate, sign.column, {signed_factor(level + 1)});
    }
    return power(level + 1);
  }

  Formula power(int level) {
    Formula base = primary(level);
    if (!is("^")) return base;
    const Token sign = take();
    bool negative = false;
    while (is("+") || is("-")) negative = (take().text == "-") != negative;
    Formula exponent = primary(level + 1);
    if (is("^"))
      _place.fail(peek().column, "expected brackets in a power of a power, for `a^b^c` may mean (a^b)^c or a^(b^c)");
    if (negative) exponent = node(Formula::Kind::negate, sign.column, {std::move(exponent)});
    return node(Formula::Kind::power, sign.column, {std::move(base), std::move(exponent)});
  }

  Formula primary(int level) {
    descend(level);
    const int column = peek().column;
    if (is("(")) {
      take();
      Formula inner = sum(level + 1);
      expect(")");
      return inner;
    }
    if (peek().kind == Token::Kind::number) {
      const Token token = take();
      Formula formula;
      formula.text = token.text;
      formula.exponent = token.exponent;
      formula.column = column;
      return formula;
    }
    if (peek().kind != Token::Kind::name) refuse("a number, a name or `(`");
    Formula formula = node(Formula::Kind::name, column, {});
    formula.text = take().text;
    if (is("(")) return call(std::move(formula), level);
    formula.index = index(level);
    while (is("'")) formula.text += take().text;
    return formula;
  }

  Formula call(Formula formula, int level) {
    take();
    formula.kind = Formula::Kind::call;
    if (formula.text == "sum") {
      formula.kind = Formula::Kind::sum;
      if (peek().kind != Token::Kind::name) refuse("the name of an index, as in sum(j = 1..n, x[j])");
      formula.text = take().text;
      expect("=");
      formula.parts.push_back(sum(level + 1));
      expect("..");
      formula.parts.push_back(sum(level + 1));
      expect(",");
      formula.parts.push_back(sum(level + 1));
      expect(")");
      return formula;
    }
    while (!is(")")) {
      formula.parts.push_back(sum(level + 1));
      if (is(",")) {
        take();
        continue;
      }
      if (!is(")")) refuse(at_end() ? "`)`" : "an operator, `,` or `)`");
    }
    take();
    return formula;
  }

  std::vector<Formula> index(int level) {
    std::vector<Formula> indices;
    if (!is("[")) return indices;
    take();
    indices.push_back(sum(level + 1));
    while (is(",")) {
      take();
      indices.push_back(sum(level + 1));
    }
    expect("]");
    return indices;
  }

  std::string_view _text;
  const PlacedFormula& _place;
  std::size_t _next = 0;
  std::vector<Token> _tokens;
  std::size_t _at = 0;
};

PlacedFormula placed(std::string_view text, const std::string& place) {
  PlacedFormula formula{{}, std::string(text), place};
  if (text.size() > longest_formula)
    formula.fail(1, fmt::format("expected a formula of at most {} bytes, got {}", longest_formula, text.size()));
  return formula;
}

}  // namespace

void PlacedFormula::fail(int column, const std::string& problem) const {
  constexpr std::size_t most_quoted = 120;
  throw core::InputError(fmt::format("{}: column {} of `{}`: {}", place, column,
                                     core::shortened(core::printable(text), most_quoted), problem));
}

PlacedFormula parse_formula(std::string_view text, const std::string& place) {
  PlacedFormula formula = placed(text, place);
  formula.formula = Reader(text, formula).whole();
  return formula;
}

LeftSide parse_left_side(std::string_view text, const std::string& place) {
  const PlacedFormula formula = placed(text, place);
  return Reader(text, formula).left_side();
}

bool is_name(std::string_view text) {
  return !text.empty() && is_letter(text.front()) &&
         std::all_of(text.begin(), text.end(), [](char c) { return is_letter(c) || is_digit(c); });
}

const std::vector<std::string>& function_names() {
  static const std::vector<std::string> names{"sqrt", "exp",  "log",  "sin",  "cos",   "tan", "asin", "acos",
                                              "atan", "sinh", "cosh", "tanh", "atan2", "erf", "pow"};
  return names;
}

}  // namespace orbweaver::model
