#include "result_stream.hpp"

#include <streambuf>
#include <string>
#include <utility>
#include <vector>

#include <unistd.h>

#include "failure.hpp"
#include "orbweaver/core/styled.hpp"
#include "orbweaver/core/text.hpp"

namespace orbweaver::drivers {

namespace {

/// Bytes that are gathered before their whole lines are printed.
constexpr std::size_t block_bytes = 1 << 16;

}  // namespace

class ResultStream::Lines : public core::StyledBuffer {
 public:
  explicit Lines(bool colours) : _colours(colours) {}

  void set_style(core::Style style) override {
    if (_colours) _changes.push_back({_text.size(), style});
  }

  void finish() { print_first(_text.size()); }

 private:
  struct Change {
    std::size_t at;
    core::Style style;
  };

  int_type overflow(int_type character) override {
    if (traits_type::eq_int_type(character, traits_type::eof())) return traits_type::not_eof(character);
    _text += traits_type::to_char_type(character);
    print_whole_lines();
    return character;
  }

  std::streamsize xsputn(const char* text, std::streamsize count) override {
    _text.append(text, static_cast<std::size_t>(count));
    print_whole_lines();
    return count;
  }

  void print_whole_lines() {
    if (_text.size() < block_bytes) return;
    const std::size_t length = _text.rfind('\n') + 1;  // 0 where there is none
    if (length != 0) print_first(length);
  }

  /// The first bytes of the text, each piece between two changes of style escaped alone.
  void print_first(std::size_t length) {
    std::string shown;
    std::size_t from = 0;
    const auto add = [&](std::size_t to) {
      shown += core::styled(_style, core::printable_lines(std::string_view(_text).substr(from, to - from)), _colours);
      from = to;
    };
    std::size_t passed = 0;
    for (; passed < _changes.size() && _changes[passed].at <= length; ++passed) {
      add(_changes[passed].at);
      _style = _changes[passed].style;
    }
    add(length);
    _changes.erase(_changes.begin(), _changes.begin() + static_cast<std::ptrdiff_t>(passed));
    for (Change& change : _changes) change.at -= length;
    _text.erase(0, length);
    print_as_it_is(shown);
  }

  bool _colours;
  std::string _text;
  std::vector<Change> _changes;  // in _text
  core::Style _style = core::Style::plain;
};

ResultStream::ResultStream(const core::Terminal& terminal)
    : std::ostream(nullptr), _lines(std::make_unique<Lines>(terminal.colours)) {
  rdbuf(_lines.get());
  exceptions(std::ios::badbit);
}

ResultStream::ResultStream() : ResultStream(core::terminal_of(STDOUT_FILENO)) {}

ResultStream::~ResultStream() = default;

void ResultStream::finish() { _lines->finish(); }

}  // namespace orbweaver::drivers
