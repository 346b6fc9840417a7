#pragma once

#include <ostream>
#include <streambuf>
#include <string>
#include <string_view>

namespace orbweaver::core {

/// What a piece of text is, for terminals that show it by a colour.
enum class Style { plain, heading, faint, good, warning, bad };

/// The text between the escape sequences of a style, or alone. The text is escaped before (core/text.hpp).
[[nodiscard]] std::string styled(Style style, std::string_view text, bool colours);

/// A stream's buffer that is told where styles begin: beside the text, so that nothing within the text can feign one.
class StyledBuffer : public std::streambuf {
 public:
  /// What is written from now on is of this style.
  virtual void set_style(Style style) = 0;
};

/// A piece of text in a style: `out << Styled{Style::bad, "failed"}`. A stream without a StyledBuffer gets the text.
struct Styled {
  Style style;
  std::string_view text;
};
std::ostream& operator<<(std::ostream& out, const Styled& piece);

}  // namespace orbweaver::core
