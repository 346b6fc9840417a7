#include <gmock/gmock.h>

#include <cmath>
#include <fstream>

#include "archive/sample.hpp"
#include "orbweaver/archive/read/reader.hpp"
#include "orbweaver/certificate/verdict.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/survey/run/survey.hpp"
#include "orbweaver/survey/tree/family_end.hpp"
#include "orbweaver/systems/quad_system.hpp"
#include "orbweaver/systems/registry.hpp"
#include "support/delegating_system.hpp"
#include "support/stated_system.hpp"
#include "survey/scenes.hpp"

namespace run_test {
namespace {

using namespace orbweaver;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsSupersetOf;
using ::testing::UnorderedElementsAre;

survey::Summary run(const core::Communicator& comm, const scene::Scene& scene, const std::filesystem::path& folder) {
  const auto system = systems::make_system(scene.system.name, scene.system.parameters, scene.system.effects);
  return survey::run_survey(comm, scene, system, folder, {});
}

/// The pendulum, with a sign missing in its first reversor.
class WrongReversor final : public test::DelegatingSystem {
 public:
  WrongReversor() : DelegatingSystem(systems::make_system("double_pendulum")), _structure(whole().structure()) {
    _structure.reversors.front().map.matrix(3, 3) *= -1.0;
  }
  [[nodiscard]] const systems::Structure& structure() const override { return _structure; }

 private:
  systems::Structure _structure;
};

class WithTwoQuantities final : public test::DelegatingSystem {
 public:
  WithTwoQuantities() : DelegatingSystem(systems::make_system("double_pendulum")), _structure(whole().structure()) {
    _structure.conserved.emplace_back("momentum");
  }
  [[nodiscard]] const systems::Structure& structure() const override { return _structure; }

 private:
  systems::Structure _structure;
};

/// x'' = -x - x'/2 and y'' = -2 y - y'/2, which conserve nothing.
class Damped final : public test::StatedSystem, public systems::QuadSystem {
 public:
  Damped() : StatedSystem(test::structure_of(4)) {}
  void field(std::size_t nodes, const double* z, double* f) const override {
    for (std::size_t j = 0; j < nodes; ++j)
      for (std::size_t i = 0; i < 4; ++i) {
        f[i * nodes + j] = 0.0;
        for (std::size_t l = 0; l < 4; ++l) f[i * nodes + j] += matrix()(i, l) * z[l * nodes + j];
      }
  }
  void field_jacobian(std::size_t nodes, const double* z, double* f, double* jacobian) const override {
    field(nodes, z, f);
    for (std::size_t i = 0; i < 16; ++i)
      for (std::size_t j = 0; j < nodes; ++j) jacobian[i * nodes + j] = matrix()(i / 4, i % 4);
  }
  void linearize(const numerics::QuadVector& z, numerics::QuadVector& f,
                 numerics::QuadMatrix& jacobian) const override {
    jacobian = matrix().cast<numerics::Quad>();
    f = jacobian * z;
  }

 private:
  static Eigen::Matrix4d matrix() {
    Eigen::Matrix4d matrix = Eigen::Matrix4d::Zero();
    matrix(0, 2) = matrix(1, 3) = 1.0;
    matrix(2, 0) = -1.0;
    matrix(3, 1) = -2.0;
    matrix(2, 2) = matrix(3, 3) = -0.5;
    return matrix;
  }
};

std::vector<std::string> files_in(const std::filesystem::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) names.push_back(entry.path().filename());
  return names;
}

std::string own_folder(const core::Communicator& comm, const std::string& name) {
  return name + std::to_string(comm.size());
}

TEST(RunSurvey, SummaryArchiveAndFolderAgree) {
  const core::Communicator comm;
  const auto folder = test::fresh_folder(own_folder(comm, "whole"), comm.get());
  if (comm.is_root()) {
    std::filesystem::create_directory(folder / "segments");
    std::ofstream(folder / "segments" / "segment-000001.h5") << "left over from a run that was killed";
  }
  const survey::Summary summary = run(comm, test::quick_scene({"limits.period=9"}), folder);
  EXPECT_EQ(summary.failures, 0U);
  EXPECT_FALSE(summary.stopped_early);
  if (!comm.is_root()) return;

  EXPECT_THAT(files_in(folder), UnorderedElementsAre("atlas.h5", "segments"));
  EXPECT_EQ(summary.atlas, folder / "atlas.h5");
  EXPECT_EQ(summary.peak_memory_mib.size(), static_cast<std::size_t>(comm.size()));
  for (const double mib : summary.peak_memory_mib) EXPECT_GT(mib, 1.0);
  EXPECT_GT(summary.seconds, 0.0);
  EXPECT_TRUE(summary.failed_tasks.empty());
  EXPECT_THAT(summary.remarks,
              ::testing::Contains(HasSubstr("no small oscillations around th1 = 180 deg, th2 = 180 deg")));

  const archive::Archive atlas(summary.atlas);
  EXPECT_EQ(atlas.orbits().rows(), static_cast<std::size_t>(summary.orbits));
  ASSERT_EQ(summary.families.size(), 4U);
  EXPECT_THAT(atlas.families().texts("name"), ElementsAre("In-Phase", "Out-Phase", "Down-Up", "Up-Down"));
  const auto& periods = atlas.orbits().reals("period");
  const auto& energies = atlas.orbits().reals("energy");
  for (std::size_t n = 0; n < 4; ++n) {
    const survey::FamilySummary& family = summary.families[n];
    const auto first = static_cast<std::size_t>(atlas.families().integers("first_orbit")[n]);
    const auto last = first + static_cast<std::size_t>(family.orbits) - 1;
    EXPECT_FALSE(family.failed);
    EXPECT_EQ(family.name, atlas.families().texts("name")[n]);
    EXPECT_EQ(family.isotropy, atlas.families().texts("isotropy")[n]);
    EXPECT_EQ(family.orbits, atlas.families().integers("orbit_count")[n]);
    EXPECT_EQ(family.end_reason, "period limit (T = 9)");
    EXPECT_EQ(family.end_reason, atlas.families().texts("end_reason")[n]);
    EXPECT_EQ(family.period_from, periods[first]);
    EXPECT_EQ(family.period_to, periods[last]);
    EXPECT_EQ(family.period_to, 9.0);
    EXPECT_EQ(family.level_from, energies[first]);
    EXPECT_EQ(family.level_to, energies[last]);
  }
  EXPECT_NEAR(summary.families[0].level_to, -0.764030789928, 1e-11);  // in-phase at T = 9
  const auto last = static_cast<std::size_t>(summary.families[0].orbits) - 1;
  EXPECT_NEAR(atlas.orbits().reals("state")[4 * last], 1.360312422366, 1e-11);
}

TEST(RunSurvey, StabilityColumnsHoldTheIndexAndABoundOfItsError) {
  const core::Communicator comm;
  const auto folder = test::fresh_folder(own_folder(comm, "stability"), comm.get());
  const survey::Summary summary =
      run(comm, test::quick_scene({"limits.period=10", "starts.sweep.period=[8,9]"}), folder);
  if (!comm.is_root()) return;
  const archive::Archive atlas(summary.atlas);
  const auto& full = atlas.orbits().reals("stability");
  const auto& half = atlas.orbits().reals("fundamental_stability");
  const auto& error = atlas.orbits().reals("stability_error");
  ASSERT_EQ(full.size(), atlas.orbits().rows());
  ASSERT_GT(full.size(), 5U);
  for (std::size_t row = 0; row < full.size(); ++row) {
    EXPECT_NEAR(full[row], half[row] * half[row] - 2.0, 1e-14 * (4.0 + std::abs(full[row])));
    EXPECT_GE(error[row], 0.0);
    EXPECT_LE(error[row], 1e-9 * (1.0 + std::abs(full[row])));
  }
  // In-phase at T = 10, from the quarter period in quadruple precision (tests/spectrum/floquet_pendulum_test.cpp).
  const double reference = 0.42291741949564062723;
  EXPECT_EQ(atlas.orbits().reals("period").back(), 10.0);
  EXPECT_NEAR(full.back(), reference * reference - 2.0, error.back());
  EXPECT_NEAR(half.back(), reference, 1e-10);
}

TEST(RunSurvey, WithoutStabilityTheSameOrbitsHaveNoMultipliers) {
  const core::Communicator comm;
  const auto folder = test::fresh_folder(own_folder(comm, "without_stability"), comm.get());
  const auto with = run(comm, test::quick_scene({"limits.period=12"}), folder / "with");
  const auto without =
      run(comm, test::quick_scene({"limits.period=12", "compute.stability=false"}), folder / "without");
  if (!comm.is_root()) return;
  EXPECT_EQ(without.failures, 0U);
  const archive::Archive whole(with.atlas);
  const archive::Archive bare(without.atlas);
  ASSERT_GT(bare.orbits().rows(), 10U);
  ASSERT_GT(whole.crossings().rows(), 0U);
  EXPECT_EQ(bare.crossings().rows(), 0U);
  for (const char* column : {"period", "energy", "action", "state", "closure"})
    EXPECT_EQ(bare.orbits().reals(column), whole.orbits().reals(column)) << column;
  for (const char* column : {"stability", "fundamental_stability", "stability_error"})
    for (const double value : bare.orbits().reals(column)) EXPECT_TRUE(std::isnan(value)) << column;
  for (const std::int64_t verdict : bare.orbits().integers("verdict"))
    EXPECT_EQ(verdict, static_cast<std::int64_t>(certificate::Verdict::holds));
}

TEST(RunSurvey, ManySmallFlushesGiveTheArchiveOfOneRankAndOneFlush) {
  const core::Communicator comm;
  scene::Scene scene = test::quick_scene({"limits.period=8.5", "section={coordinate: w1, value: 0}"});
  const auto pieces = test::fresh_folder(own_folder(comm, "pieces"), comm.get());
  const auto foreign = pieces / "segments" / "notes.txt";
  if (comm.is_root()) {
    std::filesystem::create_directory(pieces / "segments");
    std::ofstream(foreign) << "not ours";
  }
  scene.output.flush_orbits = 3;  // in the struct alone: the archive stores the text
  (void)run(comm, scene, pieces);
  if (!comm.is_root()) return;
  const core::Communicator alone(MPI_COMM_SELF);
  const auto whole = test::fresh_folder(own_folder(comm, "whole_alone"));
  scene.output.flush_orbits = 100000;
  scene.output.flush_seconds = 1e6;
  (void)run(alone, scene, whole);
  EXPECT_EQ(test::dataset_bytes(pieces / "atlas.h5"), test::dataset_bytes(whole / "atlas.h5"));
  EXPECT_GT(archive::Archive(pieces / "atlas.h5").orbits().rows(), 30U);
  EXPECT_THAT(files_in(pieces / "segments"), IsSupersetOf({"notes.txt", "checkpoint", "segment-000002.h5"}));
  EXPECT_EQ(std::filesystem::file_size(foreign), 8U);
}

TEST(RunSurvey, AFolderThatCannotBeMadeIsAnEnvironmentErrorOnEveryRank) {
  const core::Communicator comm;
  const auto folder = test::fresh_folder(own_folder(comm, "blocked"), comm.get());
  if (comm.is_root()) std::ofstream(folder / "file") << "text";
  const scene::Scene scene = test::quick_scene({"limits.period=8.5"});
  try {
    (void)run(comm, scene, folder / "file" / "inside");
    FAIL() << "no exception";
  } catch (const core::EnvironmentError& error) {
    EXPECT_THAT(error.what(), HasSubstr("cannot create the folder " + (folder / "file" / "inside").string()));
  }
}

TEST(RunSurvey, FollowsNoMoreFamiliesThanAllowed) {
  const core::Communicator comm;
  const auto folder = test::fresh_folder(own_folder(comm, "limited"), comm.get());
  const survey::Summary summary = run(comm, test::quick_scene({"limits.steps=2", "limits.families=3"}), folder);
  if (!comm.is_root()) return;
  ASSERT_EQ(summary.families.size(), 3U);
  EXPECT_EQ(summary.families[2].name, "Down-Up");
  EXPECT_EQ(summary.families[2].end_reason, "step limit (2 orbits)");
  EXPECT_THAT(summary.remarks, ::testing::Contains("4 families found, 3 followed (limits.families)"));
}

// A light outer bob has two modes that a step of 0.1237 saw as one, a heavy one ended the eigenvalue solver of whole
// equilibria. All are found, and named by the mode.
TEST(RunSurvey, AllModesOfPendulumsOfAnyProportionsAreFoundAndNamed) {
  const core::Communicator comm;
  int number = 0;
  for (const char* proportion : {"m2=1e-3", "m2=1e-6", "m2=1e3", "m2=1e6", "l2=1e-3", "l2=1e3"}) {
    const auto folder = test::fresh_folder(own_folder(comm, "proportion" + std::to_string(number++) + "_"), comm.get());
    const scene::Scene scene = scene::load(
        ORBWEAVER_SOURCE_DIR "/drivers/scenes/double_pendulum.yaml",
        {"starts.sweep.period=auto", "starts.sweep.step=0.1237", "survey.depth=0", "limits.steps=1",
         "limits.period=1e9", "continuation.tolerance=1e-6", std::string("system.parameters.") + proportion});
    const survey::Summary summary = run(comm, scene, folder);
    EXPECT_EQ(summary.failures, 0U) << proportion;
    if (!comm.is_root()) continue;
    std::vector<std::string> names;
    for (const survey::FamilySummary& family : summary.families) names.push_back(family.name);
    EXPECT_THAT(names, ElementsAre("In-Phase", "Out-Phase", "Down-Up", "Up-Down")) << proportion;
    ASSERT_EQ(summary.families.size(), 4U);
    EXPECT_GT(summary.families[0].period_from, summary.families[1].period_from) << proportion;
  }
}

TEST(RunSurvey, AModeOutsideTheRangeKeepsItsNameAndIsToldOf) {
  const core::Communicator comm;
  const auto folder = test::fresh_folder(own_folder(comm, "excluded"), comm.get());
  const survey::Summary summary = run(comm, test::quick_scene({"limits.steps=2", "starts.sweep.period=[3,4]"}), folder);
  if (!comm.is_root()) return;
  ASSERT_EQ(summary.families.size(), 1U);
  EXPECT_EQ(summary.families[0].name, "Out-Phase");
  EXPECT_EQ(summary.families[0].key, "0000.0001");
  EXPECT_THAT(summary.remarks,
              IsSupersetOf({AllOf(HasSubstr("left out at th1 = 0 deg, th2 = 0 deg"),
                                  HasSubstr("In-Phase with T = 8.20937722, outside starts.sweep.period [3, 4]")),
                            AllOf(HasSubstr("left out"), HasSubstr("Up-Down with T = 5.28"))}));
}

TEST(RunSurvey, MoreNamesThanModesAreRefused) {
  const core::Communicator comm;
  const auto folder = test::fresh_folder(own_folder(comm, "names"), comm.get());
  try {
    (void)run(
        comm,
        test::quick_scene({"starts.fixed_points.names={[0, 180]: [Down-Up, Other]}", "starts.fixed_points.letters={}"}),
        folder);
    ADD_FAILURE() << "accepted";
  } catch (const core::InputError& error) {
    EXPECT_THAT(error.what(),
                AllOf(HasSubstr("at most 1 for the equilibrium"), HasSubstr("th2 = 180 deg"), HasSubstr("got 2")));
  }
}

TEST(RunSurvey, ASceneWithNothingToFindGivesAnEmptyArchiveAndFails) {
  const core::Communicator comm;
  const auto folder = test::fresh_folder(own_folder(comm, "nothing"), comm.get());
  const survey::Summary summary = run(comm, test::quick_scene({"starts.fixed_points.grid=[[180],[180]]"}), folder);
  EXPECT_EQ(summary.failures, 1U);
  if (!comm.is_root()) return;
  EXPECT_TRUE(summary.families.empty());
  EXPECT_THAT(summary.failed_tasks, ElementsAre(HasSubstr("no family found, and the archive is empty: none of the "
                                                          "equilibria has small oscillations")));
  EXPECT_EQ(archive::Archive(folder / "atlas.h5").families().rows(), 0U);
}

TEST(RunSurvey, WhyNothingWasFoundIsSaid) {
  const core::Communicator comm;
  const auto excluded = test::fresh_folder(own_folder(comm, "nothing_in_range"), comm.get());
  const survey::Summary summary =
      run(comm,
          test::quick_scene({"starts.sweep.period=[20,21]", "starts.fixed_points.grid=[[0],[0]]",
                             "starts.fixed_points.names={}", "starts.fixed_points.letters={}"}),
          excluded);
  EXPECT_THAT(summary.failed_tasks.empty() ? "" : summary.failed_tasks.front(),
              comm.is_root() ? HasSubstr("all their periods lie outside starts.sweep.period") : HasSubstr(""));

  const auto damped = test::fresh_folder(own_folder(comm, "damped"), comm.get());
  EXPECT_THAT(
      [&] {
        (void)survey::run_survey(comm,
                                 test::quick_scene({"starts.fixed_points.grid=[[0],[0]]",
                                                    "starts.fixed_points.names={}", "starts.fixed_points.letters={}"}),
                                 std::make_shared<Damped>(), damped, {});
      },
      ::testing::ThrowsMessage<core::InputError>(AllOf(HasSubstr("expected `continuation: {free: ...}`"),
                                                       HasSubstr("conserves nothing: the model wants one"),
                                                       HasSubstr("name that in the model's structure.conserved"))));
}

TEST(RunSurvey, GridPointsWithoutAFieldArePassedOverAndTold) {
  const core::Communicator comm;
  const auto folder = test::fresh_folder(own_folder(comm, "hole"), comm.get());
  const scene::Scene scene = scene::load(ORBWEAVER_SOURCE_DIR "/drivers/scenes/swinging_spring.yaml",
                                         {"starts.fixed_points.grid=[[0],[0,-1]]", "limits.steps=2", "survey.depth=0"});
  const survey::Summary summary = run(comm, scene, folder);
  EXPECT_EQ(summary.failures, 0U);
  if (!comm.is_root()) return;
  EXPECT_FALSE(summary.families.empty());
  EXPECT_THAT(
      summary.remarks,
      ::testing::Contains(
          "points of starts.fixed_points.grid passed over, where the field or a derivative of it is not finite: 1, "
          "the first x = 0, y = 0, vx = 0, vy = 0"));
}

TEST(RunSurvey, AFamilyBeyondALimitIsLeftOutByIt) {
  const core::Communicator comm;
  const auto folder = test::fresh_folder(own_folder(comm, "left_out"), comm.get());
  const survey::Summary summary = run(comm, test::quick_scene({"limits.period=8"}), folder);
  EXPECT_EQ(summary.failures, 0U);
  if (!comm.is_root()) return;
  EXPECT_EQ(summary.families[0].orbits, 0);
  EXPECT_THAT(summary.families[0].end_reason, HasSubstr("period limit (left out: begins at T = 8.20"));
  EXPECT_EQ(survey::ends_in(summary.families[0].end_reason), std::vector{survey::EndKind::period_limit});
}

TEST(RunSurvey, WhereLimitsLeaveAllFamiliesOutItSaysSo) {
  const core::Communicator comm;
  const auto folder = test::fresh_folder(own_folder(comm, "all_left_out"), comm.get());
  const survey::Summary summary = run(comm, test::quick_scene({"limits.period=3"}), folder);
  EXPECT_EQ(summary.failures, 0U);
  if (!comm.is_root()) return;
  EXPECT_EQ(summary.orbits, 0);
  EXPECT_THAT(summary.remarks, ::testing::Contains(HasSubstr("every family begins beyond the scene's limits")));
}

TEST(RunSurvey, ASystemWithTwoConservedQuantitiesIsRefused) {
  const core::Communicator comm;
  const auto folder = test::fresh_folder(own_folder(comm, "two"), comm.get());
  try {
    (void)survey::run_survey(comm, test::quick_scene({}), std::make_shared<WithTwoQuantities>(), folder, {});
    ADD_FAILURE() << "surveyed";
  } catch (const core::InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("conserves one quantity, got double_pendulum with energy, momentum"));
  }
}

TEST(RunSurvey, AModelThatContradictsItsStructureIsRefusedOnEveryRank) {
  const core::Communicator comm;
  const auto folder = test::fresh_folder(own_folder(comm, "wrong"), comm.get());
  try {
    (void)survey::run_survey(comm, test::quick_scene({}), std::make_shared<WrongReversor>(), folder, {});
    ADD_FAILURE() << "surveyed";
  } catch (const core::InputError& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("contradicts its structure"), HasSubstr("f(R z) = -R f(z)")));
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "segments" / "checkpoint"));
}

}  // namespace
}  // namespace run_test
