// Surveys of a system that declares no symmetry, near resonances of its small oscillations.
#include <map>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "orbweaver/scene/scene.hpp"
#include "orbweaver/survey/run/survey.hpp"
#include "support/magnetic_well.hpp"
#include "survey/atlas.hpp"

namespace magnetic_well_test {
namespace {

using namespace orbweaver;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::UnorderedElementsAre;

using Parameters = std::map<std::string, double>;

survey::Summary survey_of(const core::Communicator& comm, const Parameters& parameters, const std::string& name,
                          const std::vector<std::string>& settings = {}) {
  std::vector<std::string> all{"starts.fixed_points.names={}", "starts.fixed_points.letters={}",
                               "starts.sweep.period=auto", "limits.energy=[-.inf, 1.0]", "limits.period=40"};
  all.insert(all.end(), settings.begin(), settings.end());
  const scene::Scene scene = scene::load(ORBWEAVER_SOURCE_DIR "/drivers/scenes/henon_heiles.yaml", all);
  const auto folder = test::fresh_folder(name + std::to_string(comm.size()), comm.get());
  return survey::run_survey(comm, scene, test::magnetic_well(parameters), folder, {});
}

// One curve from one oscillation to the other, as both begin there. A family on it is a circle, along which no reversor
// holds the phase. An index touches 2 where the reversor fixes its orbits: rounding made two crossings of that with
// some of these steps and first orbits.
TEST(MagneticWell, OneCurveJoinsBothOscillations) {
  const core::Communicator comm;
  const Parameters parameters{{"k2", 0.99},  {"b", 0.0},    {"e", -0.178}, {"a1", -0.475}, {"a2", 0.224},
                              {"a3", 0.115}, {"a4", 0.197}, {"q", 0.278},  {"c", 0.593}};
  for (const std::string start : {"0.0017", "0.0087", "0.0436"})
    for (const std::string step : {"adaptive", "0.05", "0.2"}) {
      SCOPED_TRACE(start + " " + step);
      const survey::Summary summary =
          survey_of(comm, parameters, "joined", {"continuation.start=" + start, "continuation.step=" + step});
      if (!comm.is_root()) continue;
      EXPECT_EQ(summary.failures, 0U);
      const test::Atlas atlas(summary.atlas);
      EXPECT_THAT(atlas.families().texts("name"), ElementsAre("Equilibrium 1, mode 1", "Equilibrium 1, mode 1 B"));
      EXPECT_THAT(atlas.families().texts("end_reason")[1], HasSubstr("closed loop"));
      EXPECT_EQ(atlas.crossings().rows(), 8U);
      EXPECT_LT(atlas.orbits().rows(), 300U);
      EXPECT_THAT(summary.remarks, Contains(HasSubstr("the reversor (x, y, px, py) -> (x, y, -px, -py)")));
      EXPECT_THAT(summary.remarks,
                  Contains(HasSubstr("Equilibrium 1, mode 2 lies on Equilibrium 1, mode 1, at T = 6.283185")));
    }
}

// The slow family is born on the fast one gone around three times, and turns on the way: from first orbits beyond that
// it was stored twice.
TEST(MagneticWell, NearOneToThreeTheSlowFamilyEndsOnTheFastOne) {
  const core::Communicator comm;
  const Parameters parameters{{"k2", 9.0009}, {"b", 0.02},   {"e", -0.142}, {"a1", -0.097}, {"a2", 0.497},
                              {"a3", -0.459}, {"a4", 0.497}, {"q", 0.237},  {"c", 0.692}};
  const survey::Summary summary = survey_of(comm, parameters, "tripled");
  if (!comm.is_root()) return;
  EXPECT_EQ(summary.failures, 0U);
  const test::Atlas atlas(summary.atlas);
  EXPECT_THAT(atlas.families().texts("name"),
              ElementsAre("Equilibrium 1, mode 1", "Equilibrium 1, mode 2", "Equilibrium 1, mode 2 T3"));
  EXPECT_THAT(atlas.families().texts("end_reason")[0], HasSubstr("joined Equilibrium 1, mode 2 at T = 6.282749"));
}

// A hill that the field holds: the family born where the fast one is tripled ends where that is quadrupled. There both
// halves and all quarters of the branch's orbits become alike, and the quarters count.
TEST(MagneticWell, AFamilyEndsOnAnOrbitFourTimesAround) {
  const core::Communicator comm;
  const Parameters parameters{{"k1", -0.22},  {"k2", -0.314}, {"b", 1.060281}, {"e", -0.194}, {"a1", 0.2752},
                              {"a2", -0.075}, {"a3", 0.3088}, {"a4", -0.344},  {"q", 0.327},  {"c", -0.488}};
  const survey::Summary summary = survey_of(
      comm, parameters, "quadrupled",
      {"survey.depth=1", "survey.subharmonics=3", "limits.energy=[-0.3, 0.3]", "starts.fixed_points.grid=[[0],[0]]"});
  if (!comm.is_root()) return;
  EXPECT_EQ(summary.failures, 0U);
  const test::Atlas atlas(summary.atlas);
  EXPECT_THAT(atlas.families().texts("end_reason"),
              Contains(HasSubstr("joined Equilibrium 1, mode 2 at T = 29.28057465")));
}

// The pair of multipliers of the slow family passes -1 where a resonance of high order holds it there on less than 1e-8
// of the family: two doublings that their index does not tell apart. Two families are born, one with multipliers on the
// unit circle and one without, and neither turns beside its birth.
TEST(MagneticWell, OfDoublingsSideBySideBothFamiliesAreFound) {
  const core::Communicator comm;
  const std::vector<Parameters> wells{
      {{"k1", -0.5397}, {"k2", -0.7794}, {"b", 1.9326}, {"e", 0.0}, {"a1", -0.0993}, {"a2", 0.0356}, {"a3", -0.0324},
       {"a4", -0.038}, {"q", 0.6365}, {"c", 0.7846}},
      {{"k1", -0.4027}, {"k2", -0.7933}, {"b", 1.9243}, {"e", 0.0}, {"a1", -0.0188}, {"a2", -0.0525}, {"a3", 0.0188},
       {"a4", 0.0653}, {"q", 0.5095}, {"c", 0.7374}}};
  for (std::size_t n = 0; n < wells.size(); ++n)
    for (const std::string start : {"0.0017", "0.0087", "0.0436"}) {
      SCOPED_TRACE(std::to_string(n) + " " + start);
      const survey::Summary summary = survey_of(
          comm, wells[n], "side_by_side",
          {"survey.depth=1", "survey.subharmonics=2", "limits.energy=[-.inf, 0.1]",
           "starts.fixed_points.grid=[[0], [0], [0], [0]]", "continuation.start=" + start});
      if (!comm.is_root()) continue;
      EXPECT_EQ(summary.failures, 0U);
      const test::Atlas atlas(summary.atlas);
      EXPECT_THAT(atlas.families().texts("name"),
                  UnorderedElementsAre("Equilibrium 1, mode 1", "Equilibrium 1, mode 2", "Equilibrium 1, mode 1 D1",
                                       "Equilibrium 1, mode 1 D2"));
      EXPECT_THAT(atlas.crossings().texts("kind"),
                  UnorderedElementsAre("period-doubling", "period-doubling", "fold-energy", "subharmonic",
                                       "subharmonic"));
      for (const survey::FindingSummary& line : summary.findings)
        EXPECT_EQ(line.severity, survey::Severity::cut) << line.text;
    }
}

}  // namespace
}  // namespace magnetic_well_test
