// A limit cycle times three pitchforks beside one another, a driven pitchfork whose symmetry is not declared, and a
// rest with two: where a family is given, how long its steps are and how exactly a crossing is located must not decide
// what is found.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "orbweaver/survey/verify/verify.hpp"
#include "orbweaver/systems/recorded_model.hpp"
#include "support/described.hpp"
#include "survey/atlas.hpp"
#include "survey/scenes.hpp"

namespace starts_at_crossings_test {

using namespace orbweaver;

/// |(u, v)| = 1 is a cycle of period 2 pi; x, y and w leave 0 at p = a, b and c.
class Pitchforks {
 public:
  static constexpr int dimension = 5;
  static constexpr int quantities = 0;

  static systems::ModelInfo info() {
    return test::described("pitchforks", "a cycle and three pitchforks", {"u", "v", "x", "y", "w"},
                           {"p", "a", "b", "c"});
  }

  static systems::Structure structure(const systems::Bound&) { return test::dissipative_structure(dimension); }

  template <class P>
  class With {
   public:
    explicit With(const systems::BoundTo<P>& bound) : _p(bound["p"]), _a(bound["a"]), _b(bound["b"]), _c(bound["c"]) {}

    template <class S>
    void field(const S* z, S* f) const {
      const S u = z[0], v = z[1];
      const S off = -u * u - v * v + 1.0;
      f[0] = u * off - v * (off * -0.2 + 1.0);
      f[1] = v * off + u * (off * -0.2 + 1.0);
      f[2] = z[2] * (_p - _a) - z[2] * z[2] * z[2];
      f[3] = z[3] * (_p - _b) - z[3] * z[3] * z[3];
      f[4] = z[4] * (_p - _c) - z[4] * z[4] * z[4];
    }

   private:
    P _p, _a, _b, _c;
  };
};

/// x' = p x - x^3 + F cos t.
class DrivenPitchfork {
 public:
  static constexpr int dimension = 2;
  static constexpr int quantities = 0;

  static systems::ModelInfo info() {
    systems::ModelInfo info = test::described("driven_pitchfork", "a driven pitchfork", {"x", "phase"}, {"p", "F"});
    info.winding_names = {"", "turns"};
    return info;
  }

  static systems::Structure structure(const systems::Bound&) {
    systems::Structure structure = test::dissipative_structure(dimension);
    structure.driven = true;
    structure.angles = {1};
    return structure;
  }

  template <class P>
  class With {
   public:
    explicit With(const systems::BoundTo<P>& bound) : _p(bound["p"]), _force(bound["F"]) {}

    template <class S>
    void field(const S* z, S* f) const {
      using std::cos;
      f[0] = z[0] * _p - z[0] * z[0] * z[0] + cos(z[1]) * _force;
      f[1] = z[0] * 0.0 + 1.0;
    }

   private:
    P _p, _force;
  };
};

/// A rest at the offset o, from which x and y leave at p = 0.01 and 0.03, and a cycle at 0.5.
class RestWithPitchforks {
 public:
  static constexpr int dimension = 4;
  static constexpr int quantities = 0;

  static systems::ModelInfo info() {
    return test::described("rest_with_pitchforks", "two pitchforks and a Hopf point", {"x", "y", "u", "v"}, {"p", "o"});
  }

  static systems::Structure structure(const systems::Bound&) { return test::dissipative_structure(dimension); }

  template <class P>
  class With {
   public:
    explicit With(const systems::BoundTo<P>& bound) : _p(bound["p"]), _offset(bound["o"]) {}

    template <class S>
    void field(const S* z, S* f) const {
      const S x = z[0] - _offset, y = z[1] - _offset, u = z[2], v = z[3];
      const S square = u * u + v * v;
      f[0] = x * (_p - 0.01) - x * x * x;
      f[1] = y * (_p - 0.03) - y * y * y;
      f[2] = u * (_p - 0.5) - v * (square + 1.0) - u * square;
      f[3] = v * (_p - 0.5) + u * (square + 1.0) - v * square;
    }

   private:
    P _p, _offset;
  };
};

namespace {

void add_systems() {
  systems::add_recorded<Pitchforks>();
  systems::add_recorded<DrivenPitchfork>();
  systems::add_recorded<RestWithPitchforks>();
}

test::Atlas atlas_of(const std::string& system, const std::string& state, const std::vector<std::string>& more) {
  add_systems();
  const core::Communicator comm;
  std::vector<std::string> all{
      "system=" + system,
      fmt::format("starts={{states: [{{state: {}, period: {}, name: Cycle}}]}}", state, 2.0 * std::numbers::pi),
      "continuation={free: p}",
      "survey.depth=1",
      "compute.stability=true",
      "limits.period=30"};
  all.insert(all.end(), more.begin(), more.end());
  const scene::Scene scene = scene::load(ORBWEAVER_SOURCE_DIR "/drivers/scenes/van_der_pol.yaml", all);
  const survey::Summary summary = test::run(comm, scene, "starts_at_crossings");
  EXPECT_EQ(summary.failures, 0U) << testing::PrintToString(summary.failed_tasks);
  for (const survey::FindingSummary& line : summary.findings)
    EXPECT_EQ(line.severity, survey::Severity::cut) << line.text;
  return test::Atlas(summary.atlas);
}

test::Atlas pitchforks(double p, const std::string& places) {
  return atlas_of(fmt::format("{{name: pitchforks, parameters: {{p: {}, {}}}}}", p, places), "[1, 0, 0, 0, 0]",
                  {"limits.parameter=[-1, 0.35]"});
}

// Both sides of a family begin at the orbit that is given, where the multiplier is 1 to rounding and neither sees it
// pass. There the system's own linear part vanishes along x, which must not make its scale 1e-18.
TEST(StartsAtCrossings, WhereAFamilyIsGivenDoesNotDecideWhatItPasses) {
  const std::string places = "a: 0.01, b: 0.2, c: 2";
  for (const double p : {-0.2, 0.01, 0.2}) {
    SCOPED_TRACE(p);
    const test::Atlas atlas = pitchforks(p, places);
    std::vector<double> found = atlas.crossings().reals("parameter");
    std::sort(found.begin(), found.end());
    // At 0.2 of the cycle and of both sides of the family that leaves it at 0.01.
    const std::vector<double> expected{0.01, 0.2, 0.2, 0.2};
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t n = 0; n < found.size(); ++n) EXPECT_NEAR(found[n], expected[n], 1e-9);
    EXPECT_EQ(atlas.families().rows(), 3U);
  }
}

// Three multipliers pass 1 within one step; its sign shows one.
TEST(StartsAtCrossings, SeveralMultipliersThatPassWithinOneStepAreAllLocated) {
  const test::Atlas atlas = pitchforks(-0.9, "a: 0.01, b: 0.011, c: 0.013");
  for (const double place : {0.01, 0.011, 0.013}) {
    SCOPED_TRACE(place);
    const std::vector<double>& found = atlas.crossings().reals("parameter");
    EXPECT_TRUE(std::any_of(found.begin(), found.end(), [&](double p) { return std::abs(p - place) < 1e-9; }));
  }
}

// At a crossing that is located to the last digit the equations leave the family's direction open.
TEST(StartsAtCrossings, TheFamilysDirectionAtABranchPointIsThatOfItsOrbits) {
  for (const double force : {0.15, 0.3, 0.32, 0.6}) {
    SCOPED_TRACE(force);
    const test::Atlas atlas = atlas_of(fmt::format("{{name: driven_pitchfork, parameters: {{p: -1, F: {}}}}}", force),
                                       "[0.2, 0]", {"limits.parameter=[-2, 2]"});
    EXPECT_EQ(atlas.crossings().rows(), 1U);
    EXPECT_EQ(atlas.families().rows(), 2U);
  }
}

// Both lie within one step of the curve of equilibria, far from the origin too; from p = 0 an orbit of the curve lies
// on the Hopf point itself.
TEST(StartsAtCrossings, BranchPointsOfEquilibriaWithinOneStepAreListedAndVerified) {
  add_systems();
  const core::Communicator comm;
  for (const auto& [p, offset] : {std::pair{-0.5, "0"}, std::pair{0.0, "0"}, std::pair{0.02, "1e6"}}) {
    SCOPED_TRACE(fmt::format("{} {}", p, offset));
    const scene::Scene scene = scene::load(
        ORBWEAVER_SOURCE_DIR "/drivers/scenes/van_der_pol.yaml",
        {fmt::format("system={{name: rest_with_pitchforks, parameters: {{p: {}, o: {}}}}}", p, offset),
         fmt::format("starts={{fixed_points: {{grid: [[{0}], [{0}], [0], [0]]}}}}", offset), "continuation={free: p}",
         "survey.depth=0", "limits={parameter: [-1, 1], period: 30, steps: 5}", "compute.stability=true"});
    const survey::Summary summary = test::run(comm, scene, "rest_with_pitchforks");
    EXPECT_EQ(summary.failures, 0U);
    for (const survey::Objection& o : survey::verify(comm, summary.atlas).objections)
      ADD_FAILURE() << o.table << "/" << o.column << " row " << o.row << ": " << o.text;
    const test::Atlas atlas(summary.atlas);
    std::vector<double> found;
    for (std::size_t row = 0; row < atlas.equilibria().rows(); ++row)
      if (atlas.equilibria().texts("kind")[row] == "branch-point")
        found.push_back(atlas.equilibria().reals("parameter")[row]);
    std::sort(found.begin(), found.end());
    ASSERT_EQ(found.size(), 2U);
    EXPECT_NEAR(found[0], 0.01, 1e-8);
    EXPECT_NEAR(found[1], 0.03, 1e-8);
  }
}

}  // namespace
}  // namespace starts_at_crossings_test
