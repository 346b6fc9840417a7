// Units of length, time and mass that make every number 1e-9 to 1e9 times what it was: what a survey finds must be the
// same times what dimensions say.
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "hard/hard_case.hpp"
#include "survey/atlas.hpp"
#include "survey/scenes.hpp"

namespace units_test {
namespace {

using namespace orbweaver;

/// How many of the new units are in an old one.
struct Units {
  double length = 1.0;
  double time = 1.0;
  double mass = 1.0;

  [[nodiscard]] double energy() const { return mass * length * length / (time * time); }
  [[nodiscard]] std::string text() const {
    return fmt::format("length {:.0e}, time {:.0e}, mass {:.0e}", length, time, mass);
  }
};

const std::vector<Units>& all_units() {
  static const std::vector<Units> units{{1e9, 1, 1},      {1e-9, 1, 1},      {1, 1e9, 1},           {1, 1e-9, 1},
                                        {1, 1, 1e9},      {1, 1, 1e-9},      {1e9, 1e9, 1e9},       {1e-9, 1e-9, 1e-9},
                                        {1e9, 1e-9, 1e9}, {1e-9, 1e9, 1e-9}, {3.7e8, 2.3e-7, 8.1e5}};
  return units;
}

scene::Scene pendulum(const Units& units) {
  return test::quick_scene(
      {fmt::format("system.parameters.m1={:.17g}", units.mass), fmt::format("system.parameters.m2={:.17g}", units.mass),
       fmt::format("system.parameters.l1={:.17g}", units.length),
       fmt::format("system.parameters.l2={:.17g}", units.length),
       fmt::format("system.parameters.g={:.17g}", units.length / (units.time * units.time)), "starts.sweep={}",
       fmt::format("limits.period={:.17g}", 10.0 * units.time),
       fmt::format("events.periods=[{:.17g}]", 8.5 * units.time), "survey.depth=1", "survey.subharmonics=1"});
}

scene::Scene spring(const Units& units) {
  return scene::load(
      ORBWEAVER_SOURCE_DIR "/drivers/scenes/swinging_spring.yaml",
      {fmt::format("system.parameters.mass={:.17g}", units.mass),
       fmt::format("system.parameters.stiffness={:.17g}", 3.0 * units.mass / (units.time * units.time)),
       fmt::format("system.parameters.length={:.17g}", units.length),
       fmt::format("system.parameters.gravity={:.17g}", units.length / (units.time * units.time)),
       fmt::format("starts.fixed_points.grid=[[0], [{:.17g}]]", -1.333 * units.length), "starts.fixed_points.names={}",
       "starts.fixed_points.letters={}", "starts.sweep={}",
       fmt::format("continuation.start={:.17g}", 0.01 * units.length * std::max(1.0, 1.0 / units.time)),
       "survey.depth=1", "survey.subharmonics=2", fmt::format("limits.period={:.17g}", 30.0 * units.time),
       fmt::format("limits.energy=[-.inf, {:.17g}]", 0.5 * units.energy())});
}

test::Atlas survey_of(const scene::Scene& scene, const std::string& name) {
  const core::Communicator comm;
  const survey::Summary summary = test::run(comm, scene, name);
  EXPECT_EQ(summary.failures, 0U) << testing::PrintToString(summary.failed_tasks);
  return test::Atlas(summary.atlas);
}

/// How far two values are apart, relative to 1 + the first, or NaN if one is.
double off(double exact, double found) { return std::abs(found - exact) / (1.0 + std::abs(exact)); }

/// Whether the trees are the same, and the largest relative error of their numbers.
bool is_same_tree(const test::Atlas& plain, const test::Atlas& other) {
  return plain.families().texts("name") == other.families().texts("name") &&
         plain.families().texts("isotropy") == other.families().texts("isotropy") &&
         plain.crossings().texts("kind") == other.crossings().texts("kind");
}
double error_at_crossings(const test::Atlas& plain, const test::Atlas& other, const Units& units) {
  double worst = 0.0;
  for (std::size_t row = 0; row < plain.crossings().rows(); ++row) {
    const double period = plain.crossings().reals("period")[row];
    worst = test::worse(worst, std::abs(other.crossings().reals("period")[row] / units.time / period - 1.0));
    worst = test::worse(
        worst, off(plain.crossings().reals("energy")[row], other.crossings().reals("energy")[row] / units.energy()));
  }
  return worst;
}
/// At the last orbit of each family, which has exactly the limit's period or energy.
double error_at_ends(const test::Atlas& plain, const test::Atlas& other, const Units& units) {
  double worst = 0.0;
  for (const std::string& family : plain.families().texts("name")) {
    const auto last = [&](const test::Atlas& atlas, const char* column) { return atlas.column(column, family).back(); };
    worst = test::worse(worst, std::abs(last(other, "period") / units.time / last(plain, "period") - 1.0));
    worst = test::worse(worst, off(last(plain, "energy"), last(other, "energy") / units.energy()));
    worst =
        test::worse(worst, std::abs(last(other, "action") / units.energy() / units.time / last(plain, "action") - 1.0));
  }
  return worst;
}

template <class Scene>
void expect_scaled(const std::string& system, const Scene& scene_in) {
  const test::Atlas plain = survey_of(scene_in(Units{}), "plain");
  ASSERT_GE(plain.crossings().rows(), 2U);
  const std::string name = fmt::format("{} in {} systems of units, 1e-9 to 1e9", system, all_units().size());
  test::HardCase tree(name, "the same families and crossings");
  std::vector<std::string> others;
  double crossings = 0.0;
  double ends = 0.0;
  for (const Units& units : all_units()) {
    const test::Atlas other = survey_of(scene_in(units), "other");
    if (!is_same_tree(plain, other)) {
      others.push_back(units.text());
      continue;
    }
    crossings = test::worse(crossings, error_at_crossings(plain, other, units));
    ends = test::worse(ends, error_at_ends(plain, other, units));
  }
  tree.is(others.empty(), "the same",
          others.empty() ? "the same" : fmt::format("others in {}", fmt::join(others, "; ")));
  test::HardCase(name, "T ~ time, E ~ mass length^2/time^2 at crossings, relative").within(crossings, 1e-9);
  test::HardCase(name, "T, E and action of families' last orbits, relative").within(ends, 1e-9);
}

TEST(Units, OfAPendulum) { expect_scaled("double pendulum", pendulum); }
TEST(Units, OfASpring) { expect_scaled("swinging spring", spring); }

}  // namespace
}  // namespace units_test
