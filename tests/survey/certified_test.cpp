#include "tasks/certified.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "orbweaver/loop/curve/measures.hpp"
#include "orbweaver/survey/verify/verify.hpp"
#include "support/delegating_system.hpp"
#include "survey/atlas.hpp"
#include "verify/verified_atlas.hpp"

namespace certified_test {
namespace {

using namespace orbweaver;
using certificate::Certifier;
using certificate::Level;
using certificate::Verdict;
using ::testing::Each;
using ::testing::IsEmpty;

scene::Scene short_scene(const std::string& name, std::vector<std::string> more) {
  more.insert(more.end(), {"survey.depth=0", "limits.steps=8"});
  return scene::load(fmt::format("{}/drivers/scenes/{}.yaml", ORBWEAVER_SOURCE_DIR, name), more);
}

/// A Jacobian that is not the field's: its trace is off by a thousandth.
class WrongJacobian final : public test::DelegatingSystem {
 public:
  using DelegatingSystem::DelegatingSystem;
  void field_jacobian(std::size_t nodes, const double* z, double* f, double* jacobian) const override {
    whole().field_jacobian(nodes, z, f, jacobian);
    for (std::size_t j = 0; j < nodes; ++j) jacobian[j] += 1e-3;
  }
};

class Certified : public ::testing::TestWithParam<const char*> {
 protected:
  core::Communicator world;
};

/// One orbit of every family, and what each defect makes of it.
TEST_P(Certified, EachDefectHasItsVerdict) {
  const survey::Summary summary = test::run(world, short_scene(GetParam(), {}), std::string("certified_") + GetParam());
  const survey::VerifiedAtlas atlas(summary.atlas);
  std::size_t judged = 0;
  for (std::size_t family = 0; family < atlas.tree().families.size(); ++family) {
    if (atlas.tree().families[family].orbits() < 5) continue;
    const std::size_t row = atlas.tree().families[family].first_orbit + 4;
    const loop::Loop loop = atlas.loop(row);
    const certificate::Evidence evidence = survey::stored_evidence(atlas, row, loop);
    const loop::Isotropy& isotropy = atlas.isotropy(family);
    SCOPED_TRACE(fmt::format("{}, T = {}", atlas.tree().families[family].name, loop.period));
    const auto verdict = [&](const loop::Loop& changed, const certificate::Evidence& claimed, Level level,
                             const loop::Isotropy& symmetries) {
      Certifier certifier(*atlas.system(), symmetries, {.level = level});
      return name_of(certificate::judge(certifier(changed), claimed).verdict);
    };
    const bool reverses =
        std::any_of(isotropy.begin(), isotropy.end(), [](const loop::SymmetryElement& g) { return g.reversing; });
    // What closure may be off, as residual and multipliers explain it.
    const double reach = certificate::certify(*atlas.system(), loop).reach;
    const double explained = 1e3 * (loop.period * evidence.residual + 1e-13 * reach) * std::max(1.0, evidence.growth);
    for (const Level level : {Level::closure, Level::full}) {
      EXPECT_EQ(verdict(loop, evidence, level, isotropy), name_of(Verdict::holds));

      loop::Loop shifted = loop;
      shifted.modes[5] += 100.0 * explained;
      EXPECT_EQ(verdict(shifted, evidence, level, {}), name_of(Verdict::closure_contradicts));

      loop::Loop stretched = loop;
      stretched.period += 32.0 * 10.0 * explained / loop::rms_speed(loop);
      EXPECT_EQ(verdict(stretched, evidence, level, isotropy), name_of(Verdict::wrong_period));

      if (reverses) {
        EXPECT_EQ(verdict(loop::time_shifted(loop, 0.1), evidence, level, isotropy), name_of(Verdict::not_symmetric));
      }

      const loop::Loop even = loop::evenly_in_time(loop);
      certificate::Evidence twice = evidence;
      twice.period *= 2.0;
      twice.index = certificate::unknown;
      EXPECT_EQ(verdict(even, evidence, level, {}), name_of(Verdict::holds));
      EXPECT_EQ(verdict(loop::repeated(even, 2), twice, level, {}), name_of(Verdict::not_minimal));
    }
    certificate::Evidence other = evidence;
    other.index += 1e-3 * (1.0 + std::abs(other.index)) + 1e3 * other.index_error;
    EXPECT_EQ(verdict(loop, other, Level::full, isotropy), name_of(Verdict::other_multipliers));
    const WrongJacobian wrong(atlas.system());
    Certifier certifier(wrong, isotropy, {.level = Level::full});
    EXPECT_EQ(name_of(certificate::judge(certifier(loop), evidence).verdict), name_of(Verdict::unpaired));
    ++judged;
  }
  EXPECT_GE(judged, 2U);
}

INSTANTIATE_TEST_SUITE_P(Systems, Certified, ::testing::Values("double_pendulum", "henon_heiles", "pcr3bp_earth_moon"),
                         [](const auto& of) { return std::string(of.param); });

/// By the branches, by tasks of the queue, and not at all.
TEST(CertifiedSurvey, DoesWhatItsSceneAsks) {
  const core::Communicator world;
  const auto survey_of = [&](const std::string& level) {
    return test::run(world, short_scene("henon_heiles", {"compute.certificate=" + level}), "certificate_" + level);
  };
  const survey::Summary by_branches = survey_of("automatic");
  const survey::Summary by_tasks = survey_of("closure");
  const survey::Summary full = survey_of("full");
  const survey::Summary none = survey_of("none");
  for (const survey::Summary* summary : {&by_branches, &by_tasks, &full, &none}) {
    EXPECT_EQ(summary->failures, 0U);
    const survey::Verification found = survey::verify(world, summary->atlas);
    if (!world.is_root()) continue;
    std::string text;
    for (const survey::Objection& o : found.objections) text += fmt::format("{} {} {}\n", o.row, o.column, o.text);
    EXPECT_THAT(text, IsEmpty());
  }
  if (!world.is_root()) return;
  const test::Atlas branches(by_branches.atlas);
  const test::Atlas tasks(by_tasks.atlas);
  const test::Atlas most(full.atlas);
  const test::Atlas least(none.atlas);
  EXPECT_THAT(branches.orbits().integers("verdict"), Each(0));
  EXPECT_THAT(least.orbits().integers("verdict"), Each(-1));
  EXPECT_THAT(least.orbits().reals("closure"), Each(::testing::IsNan()));
  for (const char* column : {"closure", "single_shot", "taylor_closure", "symmetry_defect", "recurrence"}) {
    EXPECT_THAT(branches.orbits().reals(column),
                ::testing::Pointwise(::testing::DoubleNear(1e-12), tasks.orbits().reals(column)))
        << column;
    EXPECT_EQ(tasks.orbits().reals(column), most.orbits().reals(column)) << column;
  }
  EXPECT_THAT(branches.orbits().reals("orbit_distance"), Each(::testing::IsNan()));
  EXPECT_THAT(most.orbits().integers("verdict"), Each(0));
  for (const char* column : {"orbit_distance", "pairing", "index_gap"})
    EXPECT_THAT(most.orbits().reals(column), Each(::testing::Lt(1e-6))) << column;
}

}  // namespace
}  // namespace certified_test
