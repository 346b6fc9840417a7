#include "orbweaver/core/styled.hpp"

#include <fmt/format.h>

namespace orbweaver::core {

namespace {

/// Bold, and the eight colours that every terminal has, so that they suit light and dark grounds.
const char* sequence_of(Style style) {
  switch (style) {
    case Style::plain: return "";
    case Style::heading: return "\x1b[1m";
    case Style::faint: return "\x1b[2m";
    case Style::good: return "\x1b[32m";
    case Style::warning: return "\x1b[33m";
    case Style::bad: return "\x1b[1;31m";
  }
  return "";
}

}  // namespace

std::string styled(Style style, std::string_view text, bool colours) {
  if (!colours || style == Style::plain || text.empty()) return std::string(text);
  return fmt::format("{}{}\x1b[0m", sequence_of(style), text);
}

std::ostream& operator<<(std::ostream& out, const Styled& piece) {
  auto* buffer = dynamic_cast<StyledBuffer*>(out.rdbuf());
  if (buffer == nullptr) return out << piece.text;
  buffer->set_style(piece.style);
  out << piece.text;
  buffer->set_style(Style::plain);
  return out;
}

}  // namespace orbweaver::core
