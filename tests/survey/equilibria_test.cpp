// The equilibria that a survey knows, in /equilibria of its archive, and what verify says of them.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "orbweaver/survey/verify/verify.hpp"
#include "survey/atlas.hpp"
#include "survey/atlas_records.hpp"

namespace equilibria_test {
namespace {

using namespace orbweaver;

scene::Scene scene_of(const std::string& name, const std::vector<std::string>& more) {
  return scene::load(ORBWEAVER_SOURCE_DIR "/drivers/scenes/" + name, more);
}

scene::Scene lorenz() { return scene_of("lorenz.yaml", {"limits.steps=3", "limits.parameter=[0.5, 30]"}); }

std::string objections_to(const core::Communicator& comm, const std::filesystem::path& atlas) {
  std::string text;
  for (const survey::Objection& o : survey::verify(comm, atlas).objections)
    text += fmt::format("{} {} {}: {}\n", o.table, o.row, o.column, o.text);
  return text;
}

std::vector<std::size_t> rows_of(const archive::Table& table, const std::string& kind) {
  std::vector<std::size_t> rows;
  for (std::size_t row = 0; row < table.rows(); ++row)
    if (table.texts("kind")[row] == kind) rows.push_back(row);
  return rows;
}

std::vector<std::string> unknown_branches(const test::Atlas& atlas) {
  std::vector<std::string> found;
  for (std::size_t row = 0; row < atlas.findings().rows(); ++row)
    if (atlas.findings().texts("kind")[row] == "unknown-branch") {
      found.push_back(atlas.findings().texts("text")[row]);
      EXPECT_EQ(atlas.findings().texts("severity")[row], "undecided");
    }
  return found;
}

// The two equilibria that leave the origin at rho = 1 have the only Hopf points.
TEST(Equilibria, WhatBranchesOffWithoutACurveOfItsOwnIsSaid) {
  const core::Communicator comm;
  const scene::Scene scene = scene_of(
      "lorenz.yaml", {"limits.steps=3", "limits.parameter=[0.5, 30]", "starts.fixed_points.grid=[[0], [0], [0]]"});
  const survey::Summary summary = test::run(comm, scene, "origin");
  EXPECT_EQ(objections_to(comm, summary.atlas), "");
  if (!comm.is_root()) return;
  const test::Atlas atlas(summary.atlas);
  ASSERT_EQ(rows_of(atlas.equilibria(), "branch-point").size(), 1U);
  EXPECT_THAT(unknown_branches(atlas), testing::ElementsAre(testing::HasSubstr("Equilibrium 1 at rho = 1: other")));
}

TEST(Equilibria, OfLorenzLieOnTwoCurves) {
  // x = y = +-sqrt(beta (rho - 1)), whose rho turns at 1, with Hopf points at 470/19, of period
  // 2 pi/sqrt(2 sigma (sigma + 1) beta/(sigma - beta - 1)); and the origin, stable below rho = 1.
  constexpr double sigma = 10.0;
  constexpr double beta = 8.0 / 3.0;
  const double period = 2.0 * std::numbers::pi / std::sqrt(2.0 * sigma * (sigma + 1.0) * beta / (sigma - beta - 1.0));
  const core::Communicator comm;
  const survey::Summary summary = test::run(comm, lorenz(), "lorenz");
  EXPECT_EQ(objections_to(comm, summary.atlas), "");
  if (!comm.is_root()) return;
  const test::Atlas atlas(summary.atlas);
  const archive::Table& table = atlas.equilibria();
  const std::vector<std::size_t> hopf = rows_of(table, "hopf");
  ASSERT_EQ(hopf.size(), 2U) << "each once, though two equilibria lie on the curve";
  for (const std::size_t row : hopf) {
    EXPECT_NEAR(table.reals("parameter")[row], 470.0 / 19.0, 1e-11);
    EXPECT_NEAR(table.reals("periods")[row], period, 1e-11);
    EXPECT_EQ(table.integers("multiplicity")[row], 1);
    EXPECT_EQ(table.texts("stability")[row], "neutral");
    EXPECT_NEAR(std::abs(table.reals("state")[3 * row]), std::sqrt(beta * (470.0 / 19.0 - 1.0)), 1e-11);
  }
  const std::vector<std::size_t> folds = rows_of(table, "fold-parameter");
  ASSERT_EQ(folds.size(), 1U);
  EXPECT_EQ(rows_of(table, "branch-point").size(), 2U) << "of either curve, where they meet";
  EXPECT_THAT(unknown_branches(atlas), testing::IsEmpty());
  EXPECT_NEAR(table.reals("parameter")[folds[0]], 1.0, 1e-10);
  EXPECT_EQ(rows_of(table, "return").size(), 1U);
  std::set<std::int64_t> numbers;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    SCOPED_TRACE(row);
    const double rho = table.reals("parameter")[row];
    const double x = table.reals("state")[3 * row];
    const std::string& kind = table.texts("kind")[row];
    numbers.insert(table.integers("equilibrium")[row]);
    double trace = 0.0;
    for (std::size_t n = 0; n < 3; ++n) trace += table.reals("eigenvalues")[6 * row + 2 * n];
    EXPECT_NEAR(trace, -(sigma + 1.0 + beta), 1e-10);
    if (kind != "equilibrium" || std::abs(rho - 1.0) < 1e-9) continue;
    const bool is_stable = std::abs(x) < 1e-6 ? rho < 1.0 : rho < 470.0 / 19.0;
    EXPECT_EQ(table.texts("stability")[row], is_stable ? "stable" : "unstable");
    EXPECT_TRUE(std::isnan(table.reals("energy")[row]));
  }
  EXPECT_EQ(numbers.size(), 3U);
  EXPECT_EQ(table.texts("note").back(), "on the curve of Equilibrium 1");
  EXPECT_EQ(table.texts("note").front(), "parameter limit (rho = 30)");
}

TEST(Equilibria, OfPendulaHaveTheirLinearPeriods) {
  const core::Communicator comm;
  const survey::Summary summary =
      test::run(comm, scene_of("double_pendulum.yaml", {"survey.depth=0", "limits.steps=3"}), "pendulum");
  EXPECT_EQ(objections_to(comm, summary.atlas), "");
  const survey::Summary henon =
      test::run(comm, scene_of("henon_heiles.yaml", {"survey.depth=0", "limits.steps=3"}), "henon");
  EXPECT_EQ(objections_to(comm, henon.atlas), "");
  if (!comm.is_root()) return;
  const test::Atlas atlas(summary.atlas);
  const archive::Table& table = atlas.equilibria();
  ASSERT_EQ(table.rows(), 4U);
  // Hanging, with equal masses and lengths: omega^2 = 2 -+ sqrt 2 and E = -3.
  for (const int sign : {-1, 1})
    EXPECT_NEAR(table.reals("periods")[sign < 0 ? 0 : 1],
                2.0 * std::numbers::pi / std::sqrt(2.0 + sign * std::numbers::sqrt2), 1e-13);
  EXPECT_EQ(table.integers("multiplicity")[1], 1);
  EXPECT_EQ(table.texts("stability")[0], "elliptic");
  EXPECT_NEAR(table.reals("energy")[0], -3.0, 1e-14);
  EXPECT_TRUE(std::isnan(table.reals("parameter")[0]));
  for (const std::size_t row : {1U, 2U, 3U}) EXPECT_EQ(table.texts("stability")[row], "unstable");
  const test::Atlas two(henon.atlas);
  EXPECT_EQ(two.equilibria().integers("multiplicity")[0], 2) << "omega = 1 twice";
  EXPECT_NEAR(two.equilibria().reals("periods")[0], 2.0 * std::numbers::pi, 1e-13);
  EXPECT_TRUE(std::isnan(two.equilibria().reals("periods")[1]));
  EXPECT_EQ(two.equilibria().integers("multiplicity")[1], -1);
}

TEST(Equilibria, OfADrivenSystemRestWhileThePhaseGoesOn) {
  const core::Communicator comm;
  const scene::Scene scene =
      scene_of("duffing.yaml", {"system.parameters.drive_amplitude=0", "starts={fixed_points: {grid: [[0]]}}",
                                "continuation.free=drive_amplitude", "limits.parameter=[0, 1]", "limits.steps=3"});
  const survey::Summary summary = test::run(comm, scene, "driven");
  EXPECT_EQ(objections_to(comm, summary.atlas), "");
  if (!comm.is_root()) return;
  const test::Atlas atlas(summary.atlas);
  ASSERT_EQ(atlas.equilibria().rows(), 1U);
  EXPECT_EQ(atlas.equilibria().texts("stability")[0], "stable") << "damped; the phase does not count";
  EXPECT_EQ(atlas.equilibria().reals("eigenvalues")[0], 0.0);
}

TEST(Equilibria, HaveTheSameBytesOnAllRanksAndResumed) {
  const core::Communicator comm;
  const scene::Scene scene = lorenz();
  const auto system = scene::bound_system(scene.system);
  const auto folder = test::fresh_folder(fmt::format("resumed{}", comm.size()), comm.get());
  survey::RunOptions options;
  options.walltime = 0.1;
  (void)survey::run_survey(comm, scene, system, folder, options);
  const survey::Summary resumed = survey::run_survey(comm, scene, system, folder, {survey::Display::none, true});
  EXPECT_FALSE(resumed.stopped_early);
  if (!comm.is_root()) return;
  const core::Communicator alone(MPI_COMM_SELF);
  const survey::Summary whole = survey::run_survey(alone, scene, system, test::fresh_folder("alone"), {});
  EXPECT_EQ(test::dataset_bytes(resumed.atlas), test::dataset_bytes(whole.atlas));
}

TEST(Equilibria, ChangedNumbersAreFound) {
  constexpr double part = 1e-6;
  const core::Communicator comm;
  const survey::Summary summary = test::run(comm, lorenz(), "changed");
  const test::Atlas atlas(summary.atlas);
  archive::Records changed = test::complete_records_of(atlas);
  const std::size_t hopf = rows_of(atlas.equilibria(), "hopf").front();
  ASSERT_GT(hopf, 2U);
  ASSERT_GT(changed.equilibria.size(), 40U);
  std::set<std::int64_t> expected;
  const auto change = [&](std::size_t row, const auto& how) {
    how(changed.equilibria[row]);
    expected.insert(static_cast<std::int64_t>(row));
  };
  change(1, [](auto& point) { point.stability = "stable"; });
  change(hopf, [](auto& point) { point.periods[0] *= 1.0 + part; });
  change(hopf + 3, [](auto& point) { point.eigenvalues[0] *= 1.0 + part; });
  change(hopf + 5, [](auto& point) { point.kind = "hopf"; });
  change(hopf + 7, [](auto& point) { point.state[1] += part; });
  change(hopf + 8, [](auto&) {});  // its way from the row before
  change(hopf + 10, [](auto& point) { point.parameter += part; });
  change(hopf + 11, [](auto&) {});
  change(hopf + 13, [](auto& point) { point.arclength += part; });
  change(hopf + 14, [](auto&) {});
  const auto folder = test::fresh_folder(fmt::format("changed_numbers{}", comm.size()), comm.get());
  if (comm.is_root()) test::write_sample_atlas(folder, atlas.header(), changed);
  MPI_Barrier(comm.get());
  std::set<std::int64_t> rows;
  for (const survey::Objection& objection : survey::verify(comm, folder / "atlas.h5").objections)
    if (objection.table == "equilibria") rows.insert(objection.row);
  if (!comm.is_root()) return;
  EXPECT_EQ(rows, expected);
}

}  // namespace
}  // namespace equilibria_test
