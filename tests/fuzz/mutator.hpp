#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

namespace orbweaver::fuzz {

/// Draws from lists and changes bytes, by a seed.
class Mutator {
 public:
  explicit Mutator(std::uint64_t seed) : _random(seed) {}

  std::size_t below(std::size_t count) { return std::uniform_int_distribution<std::size_t>(0, count - 1)(_random); }

  const std::string& one_of(const std::vector<std::string>& words) { return words[below(words.size())]; }

  /// One change of a text that may well leave it one of its kind: a number becomes one of `values`, a line is taken out
  /// or doubled, a word of `dictionary` is put in.
  std::string edited(std::string text, const std::vector<std::string>& values,
                     const std::vector<std::string>& dictionary) {
    constexpr const char* digits = "0123456789";
    const std::size_t at = text.empty() ? 0 : below(text.size());
    const std::size_t line = text.rfind('\n', at) == std::string::npos ? 0 : text.rfind('\n', at) + 1;
    const std::size_t length =
        text.find('\n', at) == std::string::npos ? text.size() - line : text.find('\n', at) + 1 - line;
    switch (below(6)) {
      case 0: return text.erase(line, length);
      case 1: return text.insert(line, text.substr(line, length));
      case 2: return text.insert(below(2) == 0 ? line : at, one_of(dictionary));
      default:
        const std::size_t number = text.find_first_of(digits, at);
        if (number == std::string::npos) return text;
        const std::size_t end = std::min(text.find_first_not_of(digits, number), text.size());
        return text.replace(number, end - number, one_of(values));
    }
  }

  /// One to four changes: bytes flipped, put in, taken out, doubled, exchanged; sizes and words of `dictionary` put in.
  std::string changed(std::string bytes, const std::vector<std::string>& dictionary) {
    for (std::size_t n = 1 + below(4); n > 0; --n) change(bytes, dictionary);
    return bytes;
  }

 private:
  void change(std::string& bytes, const std::vector<std::string>& dictionary) {
    constexpr std::size_t longest = 40;  // a line of a scene, a record of a file
    if (bytes.empty()) bytes.push_back(' ');
    const std::size_t at = below(bytes.size());
    const std::size_t length = 1 + below(std::min(bytes.size() - at, longest));
    switch (below(8)) {
      case 0: bytes[at] = static_cast<char>(bytes[at] ^ (1 << below(8))); return;
      case 1: bytes[at] = static_cast<char>(below(256)); return;
      case 2: bytes.erase(at, length); return;
      case 3: bytes.insert(at, bytes.substr(at, length)); return;
      case 4: bytes.resize(at); return;
      case 5: bytes.insert(at, bytes.substr(below(bytes.size()), length)); return;
      case 6: {
        const std::uint64_t size = std::uint64_t{1} << below(64);
        bytes.replace(at, std::min(sizeof size, bytes.size() - at), reinterpret_cast<const char*>(&size), sizeof size);
        return;
      }
      default: bytes.insert(at, one_of(dictionary));
    }
  }

  std::mt19937_64 _random;
};

}  // namespace orbweaver::fuzz
