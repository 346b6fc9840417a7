#include <gmock/gmock.h>

#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <numbers>
#include <stdexcept>

#include "archive/sample.hpp"
#include "orbweaver/archive/read/reader.hpp"
#include "orbweaver/report/summary_text.hpp"
#include "orbweaver/survey/run/survey.hpp"
#include "orbweaver/systems/quad_system.hpp"
#include "orbweaver/systems/registry.hpp"
#include "support/delegating_system.hpp"
#include "survey/scenes.hpp"

namespace failures_test {
namespace {

using namespace orbweaver;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;

/// The pendulum with a field that is spoilt by `spoil(nodes, th1, th2, f)` at some states, or refused where it throws.
class SpoiltPendulum final : public test::DelegatingSystem, public systems::QuadSystem {
 public:
  using Spoil = std::function<void(std::size_t nodes, double th1, double th2, double& f)>;
  explicit SpoiltPendulum(Spoil spoil)
      : DelegatingSystem(systems::make_system("double_pendulum")), _spoil(std::move(spoil)) {}

  void field(std::size_t nodes, const double* z, double* f) const override {
    whole().field(nodes, z, f);
    spoil(nodes, z, f);
  }
  void field_jacobian(std::size_t nodes, const double* z, double* f, double* jacobian) const override {
    whole().field_jacobian(nodes, z, f, jacobian);
    spoil(nodes, z, f);
  }
  void linearize(const numerics::QuadVector& z, numerics::QuadVector& f,
                 numerics::QuadMatrix& jacobian) const override {
    dynamic_cast<const systems::QuadSystem&>(whole()).linearize(z, f, jacobian);
    double force = 0.0;
    _spoil(linearization, z(0).convert_to<double>(), z(1).convert_to<double>(), force);
  }

  static constexpr std::size_t linearization = 0;  ///< nodes, where an equilibrium is linearised

 private:
  void spoil(std::size_t nodes, const double* z, double* f) const {
    for (std::size_t j = 0; j < nodes; ++j) _spoil(nodes, z[j], z[nodes + j], f[2 * nodes + j]);
  }

  Spoil _spoil;
};

// Up to T = 8.5 only the Up-Down family takes the outer rod into this sector. Single nodes are left alone: the
// certificate's integrator tries steps that leave the orbit.
bool is_spoilt(std::size_t nodes, double th2) {
  const double angle = std::abs(std::remainder(th2, 2.0 * std::numbers::pi));
  return nodes > 1 && angle > 1.5 && angle < 2.2;
}

class Failures : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    shared = std::make_unique<core::Communicator>();
    scene = std::make_unique<scene::Scene>(test::quick_scene({"limits.period=8.5"}));
    const auto folder = test::fresh_folder(own("clean"), shared->get());
    clean_summary = survey::run_survey(*shared, *scene, systems::make_system("double_pendulum"), folder, {});
    if (shared->is_root()) clean = std::make_unique<archive::Archive>(clean_summary.atlas);
  }
  static void TearDownTestSuite() {
    clean.reset();
    shared.reset();
  }
  static std::string own(const std::string& name) { return name + std::to_string(shared->size()); }

  static survey::Summary run(const std::string& name, SpoiltPendulum::Spoil spoil) {
    const auto folder = test::fresh_folder(own(name), shared->get());
    return survey::run_survey(*shared, *scene, std::make_shared<SpoiltPendulum>(std::move(spoil)), folder, {});
  }

  /// The orbits of a family have the same numbers as in the clean survey, as far as `count`.
  static void expect_rows_of_the_clean_survey(const archive::Archive& atlas, std::size_t family, std::size_t count) {
    const auto mine = static_cast<std::size_t>(atlas.families().integers("first_orbit")[family]);
    const auto theirs = static_cast<std::size_t>(clean->families().integers("first_orbit")[family]);
    for (std::size_t n = 0; n < count; ++n) {
      for (const char* column : {"period", "energy", "action", "arclength", "loss_rms", "closure", "single_shot"})
        EXPECT_EQ(atlas.orbits().reals(column)[mine + n], clean->orbits().reals(column)[theirs + n]) << column;
      EXPECT_EQ(atlas.modes(mine + n), clean->modes(theirs + n));
    }
  }

  /// Up-Down failed with some orbits, the other families are those of the clean survey, and summary and archive agree.
  static void expect_up_down_alone_failed(const survey::Summary& summary,
                                          const ::testing::Matcher<std::string>& reason) {
    EXPECT_EQ(summary.failures, 1U);
    if (!shared->is_root()) return;
    ASSERT_EQ(summary.families.size(), 4U);
    const archive::Archive atlas(summary.atlas);
    EXPECT_THAT(atlas.families().texts("name"), ElementsAre("In-Phase", "Out-Phase", "Down-Up", "Up-Down"));
    for (std::size_t n = 0; n < 3; ++n) {
      EXPECT_FALSE(summary.families[n].failed);
      EXPECT_EQ(summary.families[n].end_reason, "period limit (T = 8.5)");
      ASSERT_EQ(summary.families[n].orbits, clean_summary.families[n].orbits);
      expect_rows_of_the_clean_survey(atlas, n, static_cast<std::size_t>(summary.families[n].orbits));
    }
    const survey::FamilySummary& failed = summary.families[3];
    EXPECT_TRUE(failed.failed);
    EXPECT_THAT(failed.end_reason, reason);
    EXPECT_EQ(atlas.families().texts("end_reason")[3], failed.end_reason);
    ASSERT_EQ(summary.failed_tasks.size(), 1U);
    const std::string told =
        failed.end_reason.substr(0, 1000);  // with the task's name before it, it is shortened again
    EXPECT_THAT(summary.failed_tasks[0], AllOf(StartsWith("Up-Down: "), HasSubstr(told)));
    EXPECT_THAT(report::to_text(summary), AllOf(HasSubstr("1 failed"), HasSubstr(told)));
    EXPECT_EQ(atlas.families().integers("orbit_count")[3], failed.orbits);
    EXPECT_EQ(atlas.orbits().rows(), static_cast<std::size_t>(summary.orbits));
    ASSERT_GE(failed.orbits, 8);
    expect_rows_of_the_clean_survey(atlas, 3, 8);
    const auto last = static_cast<std::size_t>(atlas.families().integers("first_orbit")[3] + failed.orbits - 1);
    EXPECT_EQ(failed.period_to, atlas.orbits().reals("period")[last]);
    EXPECT_GT(failed.period_to, 6.0);
    EXPECT_LT(failed.period_to, 7.2);
  }

  static inline std::unique_ptr<core::Communicator> shared;
  static inline std::unique_ptr<scene::Scene> scene;
  static inline std::unique_ptr<archive::Archive> clean;
  static inline survey::Summary clean_summary;
};

TEST_F(Failures, AFamilyThatMeetsNotANumberFailsAlone) {
  const survey::Summary summary = run("nan", [](std::size_t nodes, double, double th2, double& f) {
    if (is_spoilt(nodes, th2)) f = std::numeric_limits<double>::quiet_NaN();
  });
  expect_up_down_alone_failed(summary, AllOf(StartsWith("failure ("), HasSubstr("finite")));
}

TEST_F(Failures, AFamilyWhoseFieldThrowsFailsAlone) {
  const survey::Summary summary = run("throws", [](std::size_t nodes, double, double th2, double&) {
    if (is_spoilt(nodes, th2)) throw std::runtime_error("the table of forces ends here");
  });
  expect_up_down_alone_failed(summary, StartsWith("failure (the table of forces ends here)"));
}

// Latin-1, control characters, and longer than an archive's text may be.
TEST_F(Failures, WordsOfAnyBytesAreKeptAsTheyCanBeShown) {
  const std::string words = "Kr\xf6mmung " + std::string(10'000, '\x1b');
  expect_up_down_alone_failed(run("bytes",
                                  [&](std::size_t nodes, double, double th2, double&) {
                                    if (is_spoilt(nodes, th2)) throw std::runtime_error(words);
                                  }),
                              StartsWith(R"(failure (Kr\xf6mmung \x1b)"));
  const survey::Summary summary = run("sweep_bytes", [&](std::size_t nodes, double th1, double th2, double&) {
    const bool at_up_down = std::abs(th1 - std::numbers::pi) < 1e-9 && std::abs(th2) < 1e-9;
    if (nodes == SpoiltPendulum::linearization && at_up_down) throw std::runtime_error(words);
  });
  EXPECT_EQ(summary.failures, 1U);
  if (!shared->is_root()) return;
  EXPECT_THAT(summary.failed_tasks, ElementsAre(StartsWith(R"(Equilibrium 3: Kr\xf6mmung)")));
}

TEST_F(Failures, ASweepThatThrowsCostsItsFamiliesOnly) {
  const survey::Summary summary = run("sweep", [](std::size_t nodes, double th1, double th2, double&) {
    const bool at_up_down = std::abs(th1 - std::numbers::pi) < 1e-9 && std::abs(th2) < 1e-9;
    if (nodes == SpoiltPendulum::linearization && at_up_down) throw std::runtime_error("no forces here");
  });
  EXPECT_EQ(summary.failures, 1U);
  if (!shared->is_root()) return;
  EXPECT_THAT(summary.failed_tasks, ElementsAre("Equilibrium 3: no forces here"));
  ASSERT_EQ(summary.families.size(), 4U);
  const archive::Archive atlas(summary.atlas);
  EXPECT_THAT(atlas.families().texts("name"), ElementsAre("In-Phase", "Out-Phase", "Down-Up", "Equilibrium 3"));
  EXPECT_THAT(atlas.families().texts("end_reason")[3],
              AllOf(StartsWith("failure (the sweep at th1 = 180 deg, th2 = 0 deg"), HasSubstr("no forces here")));
  EXPECT_TRUE(summary.families[3].failed);
  EXPECT_EQ(summary.families[3].end_reason, atlas.families().texts("end_reason")[3]);
  for (std::size_t n = 0; n < 3; ++n) {
    EXPECT_FALSE(summary.families[n].failed);
    expect_rows_of_the_clean_survey(atlas, n, static_cast<std::size_t>(summary.families[n].orbits));
  }
}

}  // namespace
}  // namespace failures_test
