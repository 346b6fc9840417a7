#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "orbweaver/systems/system.hpp"

namespace orbweaver::scene {

/// States of a closed curve at times of any spacing within one period.
struct LoopSamples {
  std::vector<double> times;                ///< ascending
  std::vector<std::vector<double>> states;  ///< one a time; angles in radians, as they came
};

/// Reads a table in CSV: a first line with `t` and the names of all coordinates, in any order, then a row of numbers a
/// sample; angles in radians. `origin` stands in messages. Throws core::InputError "origin:line: expected ..., got ..."
/// for what is no UTF-8, other columns, numbers that are not finite or above 1e100, times that do not ascend or span
/// more than `period`, fewer rows than `least_loop_rows`, or a gap of half a period or more.
[[nodiscard]] LoopSamples parse_loop_samples(const std::string& text, const std::string& origin,
                                             const systems::System& system, double period);

/// The same of a file, of at most `longest_loop_file` bytes.
[[nodiscard]] LoopSamples read_loop_samples(const std::filesystem::path& file, const systems::System& system,
                                            double period);

/// With fewer a loop's first harmonics are not told: two a sign of the first four. Not measured.
inline constexpr std::size_t least_loop_rows = 8;
/// A million rows of three coordinates.
inline constexpr std::size_t longest_loop_file = 64UL << 20;

/// How far the last row may lie behind a whole period from the first, in parts of the period: decimal digits.
inline constexpr double same_period = 1e-6;

}  // namespace orbweaver::scene
