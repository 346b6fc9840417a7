#include "orbweaver/core/text.hpp"

#include <algorithm>
#include <array>
#include <iterator>

#include <fmt/format.h>

namespace orbweaver::core {

namespace {

unsigned char byte_at(std::string_view text, std::size_t at) { return static_cast<unsigned char>(text[at]); }

bool is_continuation(unsigned char byte) { return (byte & 0xC0) == 0x80; }

struct Lead {
  std::size_t length = 0;        // of the sequence; 0: it starts none
  unsigned char least = 0x80;    // second byte
  unsigned char largest = 0xBF;  // second byte
};

// RFC 3629, section 4.
Lead lead_of(unsigned char byte) {
  if (byte < 0x80) return {1};
  if (byte >= 0xC2 && byte < 0xE0) return {2};
  if (byte == 0xE0) return {3, 0xA0, 0xBF};
  if (byte == 0xED) return {3, 0x80, 0x9F};
  if (byte >= 0xE1 && byte < 0xF0) return {3};
  if (byte == 0xF0) return {4, 0x90, 0xBF};
  if (byte >= 0xF1 && byte < 0xF4) return {4};
  if (byte == 0xF4) return {4, 0x80, 0x8F};
  return {};
}

void append_escaped(std::string& text, std::string_view bytes) {
  for (const char c : bytes) {
    switch (c) {
      case '\n': text += "\\n"; break;
      case '\r': text += "\\r"; break;
      case '\t': text += "\\t"; break;
      default: fmt::format_to(std::back_inserter(text), "\\x{:02x}", static_cast<unsigned char>(c));
    }
  }
}

std::string escaped(std::string_view text, std::string_view kept) {
  std::string result;
  result.reserve(text.size());
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t length = character_length(text, at);
    const std::string_view character = text.substr(at, std::max<std::size_t>(length, 1));
    const bool is_kept = length == 1 && kept.find(character) != std::string_view::npos;
    if (length == 0 || (is_control(character) && !is_kept))
      append_escaped(result, character);
    else
      result += character;
    at += character.size();
  }
  return result;
}

}  // namespace

std::size_t character_length(std::string_view text, std::size_t at) {
  const Lead lead = lead_of(byte_at(text, at));
  if (lead.length < 2) return lead.length;
  if (at + lead.length > text.size()) return 0;
  const unsigned char second = byte_at(text, at + 1);
  if (second < lead.least || second > lead.largest) return 0;
  for (std::size_t i = 2; i < lead.length; ++i)
    if (!is_continuation(byte_at(text, at + i))) return 0;
  return lead.length;
}

char32_t code_point(std::string_view character) {
  constexpr std::array<unsigned char, 5> lead_bits{0, 0x7F, 0x1F, 0x0F, 0x07};
  char32_t number = byte_at(character, 0) & lead_bits.at(character.size());
  for (std::size_t i = 1; i < character.size(); ++i) number = number << 6 | (byte_at(character, i) & 0x3Fu);
  return number;
}

bool is_control(std::string_view character) {
  const char32_t point = code_point(character);
  const auto within = [point](char32_t first, char32_t last) { return point >= first && point <= last; };
  return within(0, 0x1F) || within(0x7F, 0x9F) || point == 0x061C || within(0x200E, 0x200F) || within(0x2028, 0x202E) ||
         within(0x2066, 0x2069);
}

std::size_t first_untextual(std::string_view text) {
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t length = character_length(text, at);
    if (length == 0 || text[at] == '\0') return at;
    at += length;
  }
  return std::string_view::npos;
}

std::string printable(std::string_view text) { return escaped(text, ""); }

std::string printable_lines(std::string_view text) { return escaped(text, "\n\t"); }

std::string recordable(std::string_view text) {
  constexpr std::size_t most = 2000;
  return shortened(printable_lines(text), most);
}

std::string shortened(std::string text, std::size_t most) {
  constexpr std::string_view dots = "...";
  if (text.size() <= most) return text;
  std::size_t end = most - std::min(most, dots.size());
  while (end > 0 && is_continuation(byte_at(text, end))) --end;
  text.resize(end);
  return text.append(dots);
}

}  // namespace orbweaver::core
