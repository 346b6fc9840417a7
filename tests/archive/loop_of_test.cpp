#include "orbweaver/archive/read/loop_of.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "archive/sample.hpp"
#include "loop/samples.hpp"
#include "orbweaver/core/error.hpp"

namespace orbweaver::archive::loop_of_test {
namespace {

constexpr double period = 1234.5;  // as no orbit of the sample has it

loop::Loop stored_loop(const loop::TimeMap& map) {
  loop::Loop loop = test::random_loop(2, 5, 3, period);
  loop.time_map = map;
  loop.winding[1] = -2.0;
  return loop;
}

Archive atlas_with(const loop::Loop& loop, const std::string& folder) {
  const Header header = test::sample_header();
  Records records = test::sample_records(header);
  OrbitRecord& orbit = records.orbits.at(4);
  orbit.period = loop.period;
  orbit.cutoff = loop.cutoff;
  orbit.modes = loop.modes;
  orbit.time_map = loop::to_numbers(loop.time_map);
  orbit.winding = {loop.winding[1]};
  return Archive(test::write_sample_atlas(test::fresh_folder(folder), header, records));
}

std::size_t row_of(const Archive& atlas) {
  const auto& periods = atlas.orbits().reals("period");
  return static_cast<std::size_t>(std::find(periods.begin(), periods.end(), period) - periods.begin());
}

// By hand, as docs/file_format.md says: s from bisection of t = T phi(s), then the series.
std::vector<double> by_the_file_format(const Archive& atlas, std::size_t row, double time) {
  const std::vector<double> map = atlas.time_map(row);
  const auto turns_at = [&map](double s) {
    if (map.empty()) return s / (2.0 * M_PI);
    double psi = std::atan2(map[0] * std::sin(s), std::cos(s));
    psi += 2.0 * M_PI * std::round((s - psi) / (2.0 * M_PI));
    for (std::size_t k = 1; 2 * k < map.size(); ++k) {
      const auto x = static_cast<double>(k);
      psi += (map[2 * k - 1] * std::sin(x * s) + map[2 * k] * (1.0 - std::cos(x * s))) / x;
    }
    return psi / (2.0 * M_PI);
  };
  double low = 0.0;
  double high = 2.0 * M_PI;
  for (int n = 0; n < 100; ++n) {
    const double middle = 0.5 * (low + high);
    (turns_at(middle) * period < time ? low : high) = middle;
  }
  const std::vector<double> c = atlas.modes(row);
  std::vector<double> z{c[0], c[1] + low * atlas.orbits().reals("winding")[row]};
  for (std::size_t k = 1; 4 * k < c.size(); ++k)
    for (std::size_t i = 0; i < 2; ++i) {
      const double x = static_cast<double>(k) * low;
      z[i] += c[2 * (2 * k - 1) + i] * std::cos(x) + c[2 * (2 * k) + i] * std::sin(x);
    }
  return z;
}

TEST(LoopOf, GivesBackTheLoopWithItsTimeMap) {
  int n = 0;
  for (const loop::TimeMap& map :
       {loop::TimeMap{}, loop::TimeMap{2.5, {}}, loop::TimeMap{1.3, {0.2, -0.1, 0.0, 0.1}}}) {
    const loop::Loop loop = stored_loop(map);
    const Archive atlas = atlas_with(loop, "loop_of_" + std::to_string(n++));
    const std::size_t row = row_of(atlas);
    const loop::Loop read = loop_of(atlas, row, {1});
    EXPECT_EQ(read.time_map, map);
    EXPECT_EQ(read.modes, loop.modes);
    EXPECT_EQ(read.winding, loop.winding);
    for (const double t : {0.0, 100.0, 300.0, 617.0, 1000.0, 1234.0}) {
      EXPECT_EQ(loop::state_at(read, t), loop::state_at(loop, t));
      EXPECT_LT(test::distance(loop::state_at(read, t), by_the_file_format(atlas, row, t)), 1e-12) << "t = " << t;
    }
  }
}

TEST(LoopOf, RefusesWhatIsNoLoop) {
  loop::Loop bad = stored_loop({});
  bad.time_map = {1.0, {1.5, 0.0}};
  const Archive atlas = atlas_with(bad, "loop_of_bad");
  try {
    static_cast<void>(loop_of(atlas, row_of(atlas), {1}));
    FAIL() << "time runs backwards";
  } catch (const core::InputError& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("a time map must run forward everywhere"));
  }
  EXPECT_THROW(static_cast<void>(loop_of(atlas, 1000, {1})), core::MisuseError);
  EXPECT_THROW(static_cast<void>(loop_of(atlas, 0, {})), core::MisuseError);
}

}  // namespace
}  // namespace orbweaver::archive::loop_of_test
