#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace orbweaver::core {

/// Bytes of the character of UTF-8 that begins at `at`; 0: none does.
[[nodiscard]] std::size_t character_length(std::string_view text, std::size_t at);

/// The number that Unicode gives a character of UTF-8.
[[nodiscard]] char32_t code_point(std::string_view character);

/// Whether a character changes how others are shown: the control characters (U+0000 to U+001F, U+007F to U+009F), the
/// breaks U+2028 and U+2029, and what turns the direction of writing (Unicode's property Bidi_Control).
[[nodiscard]] bool is_control(std::string_view character);

/// The first byte that belongs to no character of UTF-8 (RFC 3629: no overlong forms, no surrogates, nothing above
/// U+10FFFF), or is zero; npos: there is none.
[[nodiscard]] std::size_t first_untextual(std::string_view text);

/// The text on one line: control characters and bytes that are not UTF-8 as `\x1b`, `\n`, `\t`
/// or `\r`. For messages and tables that echo what was given or stored.
[[nodiscard]] std::string printable(std::string_view text);

/// The same, with the breaks between lines and the tabs left as they are: for whole messages.
[[nodiscard]] std::string printable_lines(std::string_view text);

/// What a failure says, of any bytes and length, as journals and archives keep it: printable_lines, shortened to 2000
/// bytes, of which an archive holds 4096 with what stands around them. A text made so stays as it is.
[[nodiscard]] std::string recordable(std::string_view text);

/// The text, or as many of its first whole characters as fit into `most` bytes with `...` behind them. `text` is UTF-8.
[[nodiscard]] std::string shortened(std::string text, std::size_t most);

}  // namespace orbweaver::core
