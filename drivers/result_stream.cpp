#include "result_stream.hpp"

#include <streambuf>
#include <string>
#include <utility>

#include "failure.hpp"

namespace orbweaver::drivers {

namespace {

/// Bytes that are gathered before their whole lines are printed.
constexpr std::size_t block_bytes = 1 << 16;

}  // namespace

class ResultStream::Lines : public std::streambuf {
 public:
  void finish() { print_result(std::exchange(_text, "")); }

 private:
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
    if (length == 0) return;
    print_result(_text.substr(0, length));
    _text.erase(0, length);
  }

  std::string _text;
};

ResultStream::ResultStream() : std::ostream(nullptr), _lines(std::make_unique<Lines>()) {
  rdbuf(_lines.get());
  exceptions(std::ios::badbit);
}

ResultStream::~ResultStream() = default;

void ResultStream::finish() { _lines->finish(); }

}  // namespace orbweaver::drivers
