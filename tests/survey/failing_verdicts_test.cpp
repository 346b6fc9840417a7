#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <set>
#include <span>

#include <fmt/format.h>

#include "orbweaver/ad/lanes.hpp"
#include "orbweaver/certificate/verdict.hpp"
#include "orbweaver/report/summary_text.hpp"
#include "orbweaver/survey/verify/verify.hpp"
#include "orbweaver/systems/quad_system.hpp"
#include "summary_status.hpp"
#include "support/delegating_system.hpp"
#include "survey/atlas.hpp"

namespace failing_verdicts_test {
namespace {

using namespace orbweaver;
using certificate::Verdict;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::Field;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;

/// 1 in the middle of a sector around th2 = 1.85 into which up to T = 7.5 Up-Down alone takes the outer rod; smooth,
/// and 0 outside.
double in_sector(double th2) {
  const double off = (std::abs(std::remainder(th2, 2.0 * std::numbers::pi)) - 1.85) / 0.35;
  return std::abs(off) < 1.0 ? std::pow(1.0 - off * off, 4) : 0.0;
}

/// The pendulum of the scene, off in that sector: the field at few states at a time, as certificates ask for it, and
/// the energy.
class FaultyPendulum final : public test::DelegatingSystem, public systems::QuadSystem {
 public:
  FaultyPendulum(double of_integrators, double of_energy)
      : DelegatingSystem(systems::make_system("double_pendulum")),
        _of_integrators(of_integrators),
        _of_energy(of_energy) {}

  void field(std::size_t nodes, const double* z, double* f) const override {
    whole().field(nodes, z, f);
    if (nodes == 1 || nodes > ad::Lanes::width) return;  // models are checked one state at a time
    for (std::size_t j = 0; j < nodes; ++j) f[2 * nodes + j] += _of_integrators * in_sector(z[nodes + j]);
  }
  [[nodiscard]] double conserved(int k, std::span<const double> z) const override {
    return whole().conserved(k, z) + _of_energy * in_sector(z[1]);
  }
  void linearize(const numerics::QuadVector& z, numerics::QuadVector& f,
                 numerics::QuadMatrix& jacobian) const override {
    dynamic_cast<const systems::QuadSystem&>(whole()).linearize(z, f, jacobian);
  }

 private:
  double _of_integrators;
  double _of_energy;
};

class FailingVerdicts : public ::testing::Test {
 protected:
  core::Communicator world;

  survey::Summary run(const std::string& name, const std::shared_ptr<const systems::System>& system,
                      std::vector<std::string> more) {
    more.insert(more.end(), {"limits.period=7.5", "starts.sweep.period=[2,7]"});
    const auto folder = test::fresh_folder(name + std::to_string(world.size()), world.get());
    return survey::run_survey(world, test::quick_scene(more), system, folder, {});
  }

  /// All orbits hold but some of these families, which have one of these verdicts, and every place says so. On rank 0.
  static void expect_listed(const survey::Summary& summary, const std::vector<std::string>& families,
                            const std::set<Verdict>& verdicts) {
    const test::Atlas atlas(summary.atlas);
    const std::string text = report::to_text(summary);
    std::size_t listed = 0;
    for (const survey::FamilySummary& family : summary.families) {
      SCOPED_TRACE(family.name);
      ASSERT_GT(family.orbits, 0);
      const auto row = static_cast<std::int64_t>(atlas.row_of(family.name));
      const auto first_orbit =
          static_cast<std::size_t>(atlas.families().integers("first_orbit")[atlas.row_of(family.name)]);
      std::string doubts;
      for (int number = 0; number <= static_cast<int>(last_of(Verdict{})); ++number) {
        const auto verdict = static_cast<Verdict>(number);
        const auto rows =
            std::span(atlas.orbits().integers("verdict")).subspan(first_orbit, static_cast<std::size_t>(family.orbits));
        const auto count = std::count(rows.begin(), rows.end(), number);
        if (verdict == Verdict::holds || count == 0) continue;
        EXPECT_TRUE(verdicts.contains(verdict)) << name_of(verdict);
        const std::string sentence = fmt::format("{}: {} of {} orbits are not what they are said to be: {}",
                                                 family.name, count, family.orbits, name_of(verdict));
        EXPECT_THAT(summary.findings,
                    Contains(AllOf(Field(&survey::FindingSummary::severity, survey::Severity::contradiction),
                                   Field(&survey::FindingSummary::kind, survey::FindingKind::failed_certificate),
                                   Field(&survey::FindingSummary::text, HasSubstr(sentence)))));
        EXPECT_THAT(text, HasSubstr("contradiction: " + sentence));
        doubts +=
            fmt::format("{}{} of {} orbits: {}", doubts.empty() ? "" : "; ", count, family.orbits, name_of(verdict));
        const std::size_t failing =
            first_orbit + static_cast<std::size_t>(std::find(rows.begin(), rows.end(), number) - rows.begin());
        EXPECT_EQ(rows_of(atlas, row, sentence, atlas.orbits().reals("period")[failing],
                          atlas.orbits().reals("energy")[failing]),
                  1);
        ++listed;
      }
      const bool may_fail = std::find(families.begin(), families.end(), family.name) != families.end();
      EXPECT_EQ(may_fail, !doubts.empty());
      EXPECT_EQ(family.doubts, doubts);
    }
    EXPECT_GE(listed, families.size());
    EXPECT_EQ(summary.failures, listed);
    EXPECT_THAT(summary.failed_tasks, IsEmpty());
    EXPECT_THAT(text, HasSubstr(fmt::format(", {} failed", listed)));
  }

  /// How many rows of /findings say that of the family, at this orbit.
  static int rows_of(const test::Atlas& atlas, std::int64_t family, const std::string& sentence, double period,
                     double energy) {
    const archive::Table& findings = atlas.findings();
    int count = 0;
    for (std::size_t row = 0; row < findings.rows(); ++row)
      if (findings.integers("family")[row] == family && findings.texts("kind")[row] == "failed-certificate" &&
          findings.texts("severity")[row] == "contradiction" && findings.reals("period")[row] == period &&
          findings.reals("energy")[row] == energy && findings.texts("text")[row].starts_with(sentence))
        ++count;
    return count;
  }
};

TEST_F(FailingVerdicts, AreNoneWhereNothingIsWrong) {
  const survey::Summary summary = run("verdicts_none", std::make_shared<FaultyPendulum>(0.0, 0.0), {});
  EXPECT_EQ(drivers::status_of(summary), core::ExitStatus::done);
  if (world.is_root()) expect_listed(summary, {}, {});
}

TEST_F(FailingVerdicts, AreListedWhereTheIntegratorFindsAnotherOrbit) {
  const survey::Summary summary = run("verdicts_closure", std::make_shared<FaultyPendulum>(1e-4, 0.0), {});
  EXPECT_EQ(drivers::status_of(summary), core::ExitStatus::goal_missed);
  if (world.is_root()) expect_listed(summary, {"Up-Down"}, {Verdict::closure_contradicts});
}

TEST_F(FailingVerdicts, AreListedWhereTheEnergyIsNotConserved) {
  const survey::Summary summary = run("verdicts_drift", std::make_shared<FaultyPendulum>(0.0, 1e-4), {});
  EXPECT_EQ(drivers::status_of(summary), core::ExitStatus::goal_missed);
  if (world.is_root()) expect_listed(summary, {"Up-Down"}, {Verdict::drift_contradicts});
}

/// The branches followed a pendulum that is not the scene's: its gravity is off by a part in ten thousand.
TEST_F(FailingVerdicts, AreListedByTasksAndByVerifyWhereOrbitsAreOfAnotherSystem) {
  const auto other = [] { return systems::make_system("double_pendulum", {{"g", 1.0 + 1e-4}}); };
  for (const std::string level : {"closure", "full"}) {
    const survey::Summary summary = run("verdicts_" + level, other(), {"compute.certificate=" + level});
    EXPECT_EQ(drivers::status_of(summary), core::ExitStatus::goal_missed);
    if (world.is_root())
      expect_listed(summary, {"Out-Phase", "Down-Up", "Up-Down"},
                    {Verdict::closure_contradicts, Verdict::wrong_period});
  }
  // The branches' own certificates integrate what the branches followed.
  const survey::Summary summary = run("verdicts_own", other(), {});
  EXPECT_EQ(drivers::status_of(summary), core::ExitStatus::done);
  const survey::Verification found = survey::verify(world, summary.atlas);
  if (!world.is_root()) return;
  expect_listed(summary, {}, {});
  std::set<std::int64_t> rows;
  for (const survey::Objection& objection : found.objections)
    if (objection.text.find("its certificate contradicts it") != std::string::npos) rows.insert(objection.row);
  EXPECT_EQ(static_cast<std::int64_t>(rows.size()), found.orbits);
}

// Of masses up to the largest numbers there are: no step of the curve in (T, m2) can be told from none.
TEST_F(FailingVerdicts, ACurveOfCrossingsWithoutAStepIsAFailure) {
  const survey::Summary summary = test::run(
      world,
      test::quick_scene({"starts.fixed_points.grid=[[0], [0]]", "starts.sweep.period=[8, 8.5]", "limits.period=8.6",
                         "survey.subharmonics=2", "loci=[{of: [period-doubling], free: [m2], range: [0.5, 1e308]}]"}),
      "locus");
  EXPECT_EQ(summary.failures, 1U);
  EXPECT_EQ(drivers::status_of(summary), core::ExitStatus::goal_missed);
  if (!world.is_root()) return;
  EXPECT_THAT(summary.failed_tasks,
              ElementsAre(AllOf(StartsWith("In-Phase: locus from period-doubling T 8."), HasSubstr("at the start"))));
  const test::Atlas atlas(summary.atlas);
  ASSERT_EQ(atlas.loci().rows(), 1U) << "the crossing itself";
  EXPECT_THAT(atlas.loci().texts("note").front(), HasSubstr("failure ("));
  EXPECT_THAT(summary.findings, Contains(AllOf(Field(&survey::FindingSummary::kind, survey::FindingKind::failed_task),
                                               Field(&survey::FindingSummary::text, HasSubstr("locus ")))));
}

}  // namespace
}  // namespace failing_verdicts_test
