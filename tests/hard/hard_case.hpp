#pragma once

#include <chrono>
#include <cmath>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace orbweaver::test {

/// A row of the hard suite's table (docs/accuracy.md, "Hard cases"): what is true of the case, by an argument or by a
/// computation that shares nothing with what is tested, and how far off it was found. Each verdict is one line on the
/// standard output, `hard: case | reference | bound | found | time`, the time since the case was made or last judged.
class HardCase {
 public:
  HardCase(std::string name, std::string reference) : _name(std::move(name)), _reference(std::move(reference)) {}

  /// `found`, an error >= 0, must not exceed `bound`; NaN does.
  void within(double found, double bound) {
    EXPECT_LE(found, bound) << _name << ", " << _reference;
    print(fmt::format("{:.0e}", bound), fmt::format("{:.1e}", found));
  }
  /// What came of it in words, which must be as `wanted` says.
  void is(bool holds, const std::string& wanted, const std::string& found) {
    EXPECT_TRUE(holds) << _name << ", " << _reference << ": expected " << wanted << ", found " << found;
    print(wanted, found);
  }

 private:
  using Clock = std::chrono::steady_clock;

  void print(const std::string& bound, const std::string& found) {
    const auto now = Clock::now();
    fmt::print("hard: {} | {} | {} | {} | {:.1f} s\n", _name, _reference, bound, found,
               std::chrono::duration<double>(now - _begin).count());
    _begin = now;
  }

  std::string _name;
  std::string _reference;
  Clock::time_point _begin = Clock::now();
};

/// The larger of two errors, NaN if one is.
[[nodiscard]] inline double worse(double a, double b) { return std::isnan(a) || a > b ? a : b; }

}  // namespace orbweaver::test
