#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <random>
#include <string>
#include <vector>

#include <sys/resource.h>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "orbweaver/core/error.hpp"
#include "orbweaver/core/text.hpp"

namespace orbweaver::test {

/// Inputs of one kind: ORBWEAVER_FUZZ in the environment (the long tests give 100000), else what takes some seconds.
inline int fuzz_count(int quick) {
  const char* given = std::getenv("ORBWEAVER_FUZZ");
  return given == nullptr ? quick : std::atoi(given);
}

/// Changes texts and bytes, by a fixed seed.
class Mutator {
 public:
  explicit Mutator(unsigned seed) : _random(seed) {}

  std::size_t below(std::size_t count) { return std::uniform_int_distribution<std::size_t>(0, count - 1)(_random); }

  const std::string& one_of(const std::vector<std::string>& words) { return words[below(words.size())]; }

  /// Some changes: bytes flipped, put in, taken out, doubled, exchanged; sizes and words of `dictionary` put in.
  std::string changed(std::string bytes, const std::vector<std::string>& dictionary) {
    for (std::size_t n = 1 + below(4); n > 0; --n) change(bytes, dictionary);
    return bytes;
  }

 private:
  void change(std::string& bytes, const std::vector<std::string>& dictionary) {
    if (bytes.empty()) bytes = " ";
    const std::size_t at = below(bytes.size());
    const std::size_t length = 1 + below(std::min<std::size_t>(bytes.size() - at, 40));
    switch (below(8)) {
      case 0: bytes[at] = static_cast<char>(bytes[at] ^ (1 << below(8))); return;
      case 1: bytes[at] = static_cast<char>(below(256)); return;
      case 2: bytes.erase(at, length); return;
      case 3: bytes.insert(at, bytes.substr(at, length)); return;
      case 4: bytes.resize(at); return;
      case 5: {
        const std::size_t from = below(bytes.size());
        bytes.insert(at, bytes.substr(from, length));
        return;
      }
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

/// Bounds on what is done with the inputs of a test: 5 s each, 500 MB in all, and no way out but an InputError whose
/// text can be shown.
class FuzzBounds {
 public:
  template <class Body>
  void run(const std::string& input, Body&& body) {
    const auto began = std::chrono::steady_clock::now();
    try {
      body();
    } catch (const core::InputError& error) {
      ++_refused;
      const std::string text = error.what();
      EXPECT_EQ(core::printable_lines(text), text) << "of " << core::printable(input);
      EXPECT_LT(text.size(), 8192U) << "of " << core::printable(input);
    } catch (const std::exception& error) {
      ADD_FAILURE() << error.what() << "\nof " << core::printable(input);
    }
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
    EXPECT_LT(seconds, 5.0) << "of " << core::printable(input);
    _longest = std::max(_longest, seconds);
    ++_inputs;
  }

  /// To be called at the end; prints the figures.
  void check(const std::string& what) const {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    const long peak = usage.ru_maxrss / 1024;
    EXPECT_LT(peak, 500) << "MB";
    fmt::print("{}: {} inputs, {} refused, the longest took {:.3f} s, peak memory {} MB\n", what, _inputs, _refused,
               _longest, peak);
  }

 private:
  int _inputs = 0;
  int _refused = 0;
  double _longest = 0.0;
};

}  // namespace orbweaver::test
