// Surveys of families in a parameter, against what is known of them and against trajectories.
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <functional>
#include <numbers>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include "orbweaver/archive/read/loop_of.hpp"
#include "orbweaver/certificate/integrate.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/loop/curve/loop.hpp"
#include "orbweaver/survey/verify/verify.hpp"
#include "survey/atlas.hpp"
#include "survey/atlas_records.hpp"

namespace parameter_families_test {
namespace {

using namespace orbweaver;

scene::Scene scene_of(const std::string& name, const std::vector<std::string>& more = {}) {
  return scene::load(ORBWEAVER_SOURCE_DIR "/drivers/scenes/" + name, more);
}

TEST(ParameterFamilies, VanDerPolHasTheKnownPeriods) {
  const core::Communicator comm;
  const survey::Summary summary = test::run(
      comm, scene_of("van_der_pol.yaml", {"limits.parameter=[0.01, 10]", "compute.stability=true"}), "van_der_pol");
  if (!comm.is_root()) return;
  EXPECT_EQ(summary.failures, 0U);
  ASSERT_EQ(summary.families.size(), 1U);
  const test::Atlas atlas(summary.atlas);
  const std::vector<double> mu = atlas.column("parameter", "Cycle");
  const std::vector<double> period = atlas.column("period", "Cycle");
  const auto& steps = atlas.orbits().integers("step");
  const auto start = static_cast<std::size_t>(std::find(steps.begin(), steps.end(), 0) - steps.begin());
  ASSERT_LT(start, mu.size());
  EXPECT_GT(start, 0U) << "it runs to both sides";
  EXPECT_EQ(mu[start], 1.0);
  EXPECT_NEAR(period[start], 6.663286859323130, 1e-11);
  EXPECT_EQ(mu.back(), 10.0);
  EXPECT_NEAR(period.back(), 19.07836956694, 1e-11);
  EXPECT_EQ(mu.front(), 0.01);
  EXPECT_TRUE(std::is_sorted(mu.begin(), mu.end()));
  EXPECT_NEAR(period.front(), 2.0 * std::numbers::pi * (1.0 + 0.01 * 0.01 / 16.0), 1e-9) << "Lindstedt's series";
  const std::vector<double>& multipliers = atlas.orbits().reals("stability");
  const std::vector<double>& errors = atlas.orbits().reals("stability_error");
  const std::vector<double>& log_volumes = atlas.orbits().reals("log_volume");
  for (std::size_t n = 0; n < mu.size(); ++n)
    EXPECT_NEAR(std::exp(log_volumes[n]), multipliers[2 * n], errors[n] + 1e-12) << mu[n];
}

// Beyond mu = 75 the orbits would need more than 4096 harmonics without a time map for scales far apart.
void expect_relaxation_oscillations(const std::string& mu_to, const std::string& name) {
  const core::Communicator comm;
  const survey::Summary summary = test::run(
      comm, scene_of("van_der_pol.yaml", {"compute.certificate=none", "limits.parameter=[0.01, " + mu_to + "]"}), name);
  if (!comm.is_root()) return;
  EXPECT_EQ(summary.failures, 0U);
  const test::Atlas atlas(summary.atlas);
  const std::vector<double> mu = atlas.column("parameter", "Cycle");
  const std::vector<double> period = atlas.column("period", "Cycle");
  EXPECT_EQ(mu.back(), std::stod(mu_to));
  if (mu.back() == 1000.0) {
    // By Taylor series of order 26 in long double, three times around from (2, 0).
    constexpr double period_at_1000 = 1614.40112580833;
    EXPECT_NEAR(period.back(), period_at_1000, 1e-8);
  }
  for (std::size_t n = 0; n < mu.size(); ++n) {  // Dorodnicyn's series, whose next term is of the order of ln(mu)/mu
    if (mu[n] <= 100.0) continue;
    const double law = (3.0 - 2.0 * std::numbers::ln2) * mu[n] + 7.0143 / std::cbrt(mu[n]);
    EXPECT_NEAR(period[n], law, std::log(mu[n]) / mu[n]);
  }
  // Without maps of the density's logarithm 4096 end the family at mu = 75.
  const std::vector<std::int64_t>& cutoffs = atlas.orbits().integers("cutoff");
  EXPECT_LT(*std::max_element(cutoffs.begin(), cutoffs.end()), 1100);
}

TEST(ParameterFamilies, VanDerPolGoesOnToRelaxationOscillations) {
  expect_relaxation_oscillations("150", "relaxation");
}

TEST(ParameterFamilies, VanDerPolGoesOnToMuOfAThousand) { expect_relaxation_oscillations("1000", "thousand"); }

// The oscillations of mu = 0 are circles of any size. The Hopf point lies on the limit, where rounding has it on either
// side.
TEST(ParameterFamilies, OrbitsOfOneParameterAndPeriodAreNotFollowed) {
  const core::Communicator comm;
  const scene::Scene scene =
      scene_of("van_der_pol.yaml", {"starts={fixed_points: {grid: [[0]]}}", "limits.parameter=[0, 10]"});
  const survey::Summary summary = test::run(comm, scene, "circles");
  if (!comm.is_root()) return;
  EXPECT_EQ(summary.failures, 0U);
  ASSERT_EQ(summary.families.size(), 1U);
  EXPECT_GT(summary.families.front().orbits, 0);
  EXPECT_NE(summary.families.front().end_reason.find("not isolated"), std::string::npos)
      << summary.families.front().end_reason;
}

/// x'' + 0.1 x' + x + x^3 = 0.3 cos(frequency t) by the classical Runge-Kutta method from (x, v, phase): the largest
/// |x| of the last 100 of 3000 time units.
double late_amplitude(std::array<double, 3> state, double frequency) {
  constexpr double step = 0.01;
  constexpr int steps = 300000;
  constexpr int late = 290000;
  const auto rate = [&](const std::array<double, 3>& s) {
    const double force = 0.3 * std::cos(s[2]) - 0.1 * s[1] - s[0] - s[0] * s[0] * s[0];
    return std::array<double, 3>{s[1], force, frequency};
  };
  const auto moved = [](std::array<double, 3> s, const std::array<double, 3>& k, double by) {
    for (std::size_t i = 0; i < 3; ++i) s[i] += by * k[i];
    return s;
  };
  double largest = 0.0;
  for (int n = 0; n < steps; ++n) {
    const auto a = rate(state);
    const auto b = rate(moved(state, a, 0.5 * step));
    const auto c = rate(moved(state, b, 0.5 * step));
    const auto d = rate(moved(state, c, step));
    for (std::size_t i = 0; i < 3; ++i) state[i] += step / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]);
    if (n >= late) largest = std::max(largest, std::abs(state[0]));
  }
  return largest;
}

TEST(ParameterFamilies, DuffingFoldsWhereTrajectoriesJump) {
  const core::Communicator comm;
  const survey::Summary summary = test::run(comm, scene_of("duffing.yaml"), "duffing");
  if (!comm.is_root()) return;
  EXPECT_EQ(summary.failures, 0U);
  ASSERT_EQ(summary.families.size(), 1U);
  const test::Atlas atlas(summary.atlas);
  ASSERT_EQ(atlas.crossings().rows(), 2U);
  std::vector<std::array<double, 3>> states;
  std::vector<double> frequencies;
  for (std::size_t row = 0; row < 2; ++row) {
    EXPECT_EQ(atlas.crossings().texts("kind")[row], "fold-parameter");
    frequencies.push_back(atlas.crossings().reals("parameter")[row]);
    EXPECT_NEAR(atlas.crossings().reals("period")[row] * frequencies[row], 2.0 * std::numbers::pi, 1e-10);
    const auto state = atlas.crossings().reals("state").begin() + static_cast<std::ptrdiff_t>(3 * row);
    states.push_back({state[0], state[1], state[2]});
  }
  EXPECT_NEAR(frequencies[0], 1.7797, 1e-4);
  EXPECT_NEAR(frequencies[1], 1.3242, 1e-4);
  // Beyond the upper fold the strong answer is gone, below the lower one the weak one: on the other sides both stay.
  constexpr double beside = 1e-3;
  constexpr double strong = 1.0;
  constexpr double weak = 0.7;
  EXPECT_GT(late_amplitude(states[0], frequencies[0] - beside), strong);
  EXPECT_LT(late_amplitude(states[0], frequencies[0] + beside), weak);
  EXPECT_LT(late_amplitude(states[1], frequencies[1] + beside), weak);
  EXPECT_GT(late_amplitude(states[1], frequencies[1] - beside), strong);
}

/// Subharmonic answers of order three: a closed curve, on which the phase of s = 0 goes on. One side is all of it.
TEST(ParameterFamilies, AnIsolaIsAClosedLoopOnce) {
  const core::Communicator comm;
  const survey::Summary summary = test::run(
      comm,
      scene_of("duffing.yaml",
               {"system.parameters.damping=0.05", "system.parameters.drive_amplitude=2",
                "system.parameters.drive_frequency=3.8", "limits.parameter=[1, 12]",
                "starts={states: [{state: [-0.45641065, -1.08432332, 0], period: 4.960409453036515, name: Sub}]}"}),
      "isola");
  EXPECT_TRUE(survey::verify(comm, summary.atlas).objections.empty());
  if (!comm.is_root()) return;
  EXPECT_EQ(summary.failures, 0U);
  ASSERT_EQ(summary.families.size(), 1U);
  EXPECT_EQ(summary.families[0].end_reason.rfind("closed loop", 0), 0U) << summary.families[0].end_reason;
  const test::Atlas atlas(summary.atlas);
  ASSERT_EQ(atlas.crossings().rows(), 2U) << "each fold once";
  EXPECT_NEAR(atlas.crossings().reals("parameter")[0], 6.007239331, 1e-8);
  EXPECT_NEAR(atlas.crossings().reals("parameter")[1], 3.205566885, 1e-8);
}

/// Of a symmetric double well the answers in either well are images, and both are stored.
TEST(ParameterFamilies, AnswersInTwoWellsAreImages) {
  const core::Communicator comm;
  const survey::Summary summary =
      test::run(comm,
                scene_of("duffing.yaml", {"system.parameters.alpha=-1", "system.parameters.damping=0.25",
                                          "system.parameters.drive_amplitude=0", "system.parameters.drive_frequency=1",
                                          "starts={fixed_points: {grid: [[-1, 0, 1]]}}",
                                          "continuation.free=drive_amplitude", "limits.parameter=[0, 0.3]"}),
                "wells");
  if (!comm.is_root()) return;
  EXPECT_EQ(summary.failures, 0U);
  ASSERT_EQ(summary.families.size(), 3U);
  EXPECT_EQ(test::Atlas(summary.atlas).crossings().rows(), 6U);
}

TEST(ParameterFamilies, AnswersComeToADriveOfNoStrength) {
  const core::Communicator comm;
  const survey::Summary summary = test::run(
      comm,
      scene_of("duffing.yaml", {"system.parameters.alpha=-1", "system.parameters.damping=0.25",
                                "system.parameters.drive_amplitude=0.02", "system.parameters.drive_frequency=1",
                                "starts={states: [{state: [1.02, 0, 0], period: 6.283185307179586, name: Right}]}",
                                "continuation.free=drive_amplitude", "limits.parameter=[0, 0.2]"}),
      "through_zero");
  if (!comm.is_root()) return;
  EXPECT_EQ(summary.failures, 0U);
  ASSERT_EQ(summary.families.size(), 1U);
  EXPECT_EQ(summary.families[0].end_reason,
            "forwards: parameter limit (drive_amplitude = 0.2); backwards: parameter limit (drive_amplitude = 0)");
}

/// From where it began on a limit: beyond a wider one lies its other side.
TEST(ParameterFamilies, ARestHasAnotherSideBeyondAWiderLimit) {
  const core::Communicator comm;
  const auto scene = [](const char* limits) {
    return scene_of("duffing.yaml",
                    {"system.parameters.drive_amplitude=0", "system.parameters.drive_frequency=1",
                     "starts={fixed_points: {grid: [[0]]}}", std::string("limits.parameter=") + limits});
  };
  const auto system = scene::bound_system(scene("[0.5, 2]").system);
  const auto folder = test::fresh_folder(fmt::format("rest{}", comm.size()), comm.get());
  const survey::Summary narrow = survey::run_survey(comm, scene("[1, 2]"), system, folder, {survey::Display::none});
  const survey::Summary wide =
      survey::run_survey(comm, scene("[0.5, 2]"), system, folder, {survey::Display::none, true});
  if (!comm.is_root()) return;
  EXPECT_EQ(narrow.families.at(0).end_reason, "parameter limit (drive_frequency = 2)");
  EXPECT_EQ(wide.families.at(0).end_reason,
            "forwards: parameter limit (drive_frequency = 2); backwards: parameter limit (drive_frequency = 0.5)");
}

/// The second vector beside the mirror image's branch point needs more harmonics than the orbit and the kernel.
TEST(ParameterFamilies, BranchesOfADrivenFamilyHold) {
  const core::Communicator comm;
  const scene::Scene scene = scene_of(
      "duffing.yaml",
      {"survey.depth=1", "survey.subharmonics=2", "system.parameters.damping=0.2",
       "system.parameters.drive_amplitude=0", "system.parameters.drive_frequency=1.3178123854595376",
       "starts={fixed_points: {grid: [[0]]}}", "continuation.free=drive_amplitude", "limits.parameter=[0, 20]"});
  const survey::Summary summary = test::run(comm, scene, "branches");
  const survey::Verification verified = survey::verify(comm, summary.atlas);
  if (!comm.is_root()) return;
  EXPECT_EQ(summary.failures, 0U);
  for (const survey::Objection& o : verified.objections) ADD_FAILURE() << o.table << " " << o.row << ": " << o.text;
  const test::Atlas atlas(summary.atlas);
  ASSERT_EQ(summary.families.size(), 2U);
  EXPECT_EQ(summary.families[1].name, "Equilibrium 1 B");
  EXPECT_EQ(summary.families[1].depth, 1);
  const auto& kinds = atlas.crossings().texts("kind");
  EXPECT_EQ(std::count(kinds.begin(), kinds.end(), "branch-point"), 1);
  EXPECT_EQ(std::count(kinds.begin(), kinds.end(), "period-doubling"), 1);
}

/// The mean over a period, by so many equal steps that the smooth ones among these orbits leave rounding only.
double mean_over_period(const loop::Loop& loop, const std::function<double(const std::vector<double>&)>& power) {
  const int steps = 16 * loop.cutoff + 64;
  double sum = 0.0;
  for (int n = 0; n < steps; ++n) sum += power(loop::state_at(loop, loop.period * n / steps));
  return sum / steps;
}

/// What a drive gives a closed orbit, friction takes.
TEST(ParameterFamilies, DrivesAndFrictionDoNoNetWork) {
  const core::Communicator comm;
  const auto hold = [&](const scene::Scene& scene, const char* name, const auto& drive, const auto& friction) {
    const survey::Summary summary = test::run(comm, scene, name);
    EXPECT_EQ(summary.failures, 0U);
    if (!comm.is_root()) return;
    const test::Atlas atlas(summary.atlas);
    const std::vector<int> angles = scene::bound_system(scene.system)->structure().angles;
    ASSERT_GT(atlas.orbits().rows(), 10U);
    double largest = 0.0;
    for (std::size_t row = 0; row < atlas.orbits().rows(); ++row) {
      const loop::Loop loop = archive::loop_of(atlas, row, angles);
      const double given = loop.period * mean_over_period(loop, [&](const auto& z) { return drive(z, loop); });
      const double taken = loop.period * mean_over_period(loop, [&](const auto& z) { return friction(z, loop); });
      EXPECT_NEAR(given + taken, 0.0, 1e-10) << "orbit " << row;
      largest = std::max(largest, given);
    }
    EXPECT_GT(largest, 0.1) << "the drive does work";
  };
  hold(
      scene_of("duffing.yaml"), "work_duffing",
      [](const std::vector<double>& z, const loop::Loop&) { return 0.3 * std::cos(z[2]) * z[1]; },
      [](const std::vector<double>& z, const loop::Loop&) { return -0.1 * z[1] * z[1]; });
  // Torques act on the angles of the joints, th1 and th2 - th1.
  hold(
      scene::load(ORBWEAVER_SOURCE_DIR "/drivers/scenes/double_pendulum.yaml",
                  {"name=torque",
                   "system={name: double_pendulum, effects: [damping, joint_torque], parameters: {c1: 0.2, "
                   "c2: 0.1, torque1: 0.3, torque1_amplitude: 0, drive_frequency: 0.7}}",
                   "starts={fixed_points: {grid: [[0], [0]]}}", "continuation.free=torque1_amplitude",
                   "limits.parameter=[0, 1]", "survey.depth=0"}),
      "work_pendulum",
      [](const std::vector<double>& z, const loop::Loop& loop) {
        return (0.3 + loop.parameters.front() * std::cos(z[4])) * z[2];
      },
      [](const std::vector<double>& z, const loop::Loop&) {
        return -0.2 * z[2] * z[2] - 0.1 * (z[3] - z[2]) * (z[3] - z[2]);
      });
}

/// Where two real multipliers have the product 1, twice in one step (816 and 1/816, then 689 and 1/689): the torus
/// function changes its sign there, no pair passes the unit circle, and nothing is to be found or missed.
TEST(ParameterFamilies, NeutralSaddlesAreNoTori) {
  const core::Communicator comm;
  const survey::Summary summary = test::run(
      comm,
      scene_of("damped_driven_double_pendulum.yaml",
               {"survey.depth=0", "system.parameters.drive_frequency=0.7", "system.parameters.torque1_amplitude=1.796",
                "starts={states: [{state: [215.15, 106.9, 0, -0.7371, 192.77], period: 17.951958, name: Doubled}]}",
                "limits.parameter=[1.755, 1.81]"}),
      "saddles");
  if (!comm.is_root()) return;
  EXPECT_EQ(summary.failures, 0U);
  const test::Atlas atlas(summary.atlas);
  EXPECT_EQ(atlas.crossings().rows(), 0U);
  const std::vector<double> torques = atlas.column("parameter", "Doubled");
  const bool in_one_step = std::none_of(torques.begin(), torques.end(),
                                        [](double torque) { return torque > 1.766944727 && torque < 1.773493597; });
  EXPECT_TRUE(in_one_step) << "another start is needed";
}

/// The double pendulum's energy with m1 = l1 = l2 = g = 1.
double pendulum_energy(const std::vector<double>& z, double m2) {
  return 0.5 * (1.0 + m2) * z[2] * z[2] + 0.5 * m2 * z[3] * z[3] + m2 * z[2] * z[3] * std::cos(z[0] - z[1]) -
         (1.0 + m2) * std::cos(z[0]) - m2 * std::cos(z[1]);
}

/// Orbits with one mass each, all with one period or one energy: each closes, with its multipliers, under the system
/// that has its mass.
/// "period" where `verify` objects to that of an orbit in the middle, which is off by 1e-12 of it.
std::vector<std::string> objections_to_another_period(const core::Communicator& comm,
                                                      const std::filesystem::path& path) {
  const test::Atlas atlas(path);
  archive::Records records = test::complete_records_of(atlas);
  const std::size_t middle = records.orbits.size() / 2;
  records.orbits[middle].period *= 1.0 + 1e-12;
  const auto folder = test::fresh_folder(fmt::format("other_period{}", comm.size()), comm.get());
  if (comm.is_root()) test::write_sample_atlas(folder, atlas.header(), records);
  MPI_Barrier(comm.get());
  std::vector<std::string> columns;
  for (const survey::Objection& o : survey::verify(comm, folder / "atlas.h5").objections)
    if (o.table == "orbits" && o.row == static_cast<std::int64_t>(middle) && o.column == "period")
      columns.push_back(o.column);
  return columns;
}

TEST(ParameterFamilies, ConservativeOnesHoldThePeriodOrTheEnergy) {
  constexpr double period = 9.0;
  const core::Communicator comm;
  for (const std::string hold : {"period", "energy"}) {
    SCOPED_TRACE(hold);
    const survey::Summary summary = test::run(
        comm,
        scene_of("double_pendulum.yaml",
                 {"starts={states: [{state: [77.94016062081789, 69.7471030938806, 0, 0], period: 9, name: Nine}]}",
                  "continuation.free=m2", "continuation.hold=" + hold, "survey.depth=1", "limits.parameter=[0.5, 2]",
                  "limits.period=15"}),
        "hold_" + hold);
    const survey::Verification verified = survey::verify(comm, summary.atlas);
    const std::vector<std::string> changed = objections_to_another_period(comm, summary.atlas);
    if (!comm.is_root()) continue;
    EXPECT_EQ(changed, std::vector<std::string>(hold == "period" ? 1 : 0, "period"))
        << "1e-12 of T is far below what the residual shows";
    EXPECT_EQ(summary.failures, 0U);
    for (const survey::Objection& o : verified.objections) ADD_FAILURE() << o.table << " " << o.row << ": " << o.text;
    const test::Atlas atlas(summary.atlas);
    ASSERT_EQ(summary.families.size(), hold == "period" ? 3U : 4U);
    EXPECT_EQ(summary.families.front().name, "Nine");
    const double energy = pendulum_energy({1.3603124223665, 1.21731659271614, 0.0, 0.0}, 1.0);
    const std::vector<double> masses = atlas.column("parameter", "Nine");
    EXPECT_EQ(masses.front(), 0.5);
    EXPECT_EQ(masses.back(), 2.0);
    double spread = 0.0;
    for (std::size_t row = 0; row < atlas.orbits().rows(); ++row) {
      SCOPED_TRACE(row);
      const loop::Loop loop = archive::loop_of(atlas, row, {0, 1});
      const std::vector<double> start = loop::state_at(loop, 0.0);
      const double mass = loop.parameters.front();
      const double off = hold == "period" ? loop.period - period : pendulum_energy(start, mass) - energy;
      EXPECT_NEAR(off, 0.0, 1e-10);
      spread = std::max(
          spread, hold == "period" ? std::abs(pendulum_energy(start, mass) - energy) : std::abs(loop.period - period));
      const auto system = systems::make_system("double_pendulum", {{"m2", mass}});
      const std::vector<double> end = certificate::integrate(*system, start, loop.period, 1e-14);
      const std::vector<double> flow = certificate::transitions(*system, {start}, loop.period, 1e-13).front();
      double size = 0.0;
      for (const double entry : flow) size = std::max(size, std::abs(entry));
      for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(end[i], start[i], 1e-11 * size) << i;
      const double trace = flow[0] + flow[5] + flow[10] + flow[15];  // two trivial multipliers, and a pair
      EXPECT_NEAR(trace - 2.0, atlas.orbits().reals("stability")[row], 1e-9 * size);
    }
    EXPECT_GT(spread, 0.4) << "what is not held moves";
  }
}

/// Duffing's response, and copies of it with changed numbers and checksums that match them.
TEST(ParameterFamilies, WiderLimitsOfTheParameterGiveTheArchiveOfTheWideOnes) {
  struct Case {
    std::string scene, narrow, wide;
    std::vector<std::string> more;
  };
  // The second begins again, since the unit of mu is 8 instead of 4, the last since its Hopf points are looked for.
  const std::vector<Case> cases{{"van_der_pol.yaml", "[0.05, 9]", "[0.01, 10]", {"compute.stability=true"}},
                                {"van_der_pol.yaml", "[0.01, 5]", "[0.01, 10]", {}},
                                {"duffing.yaml", "[0.3, 2.5]", "[0.3, 3]", {}},
                                {"lorenz.yaml", "[15, 30]", "[14, 30]", {"limits.steps=20"}}};
  const core::Communicator comm;
  int number = 0;
  for (const Case& given : cases) {
    SCOPED_TRACE(given.scene + " " + given.narrow);
    const auto limited = [&](const std::string& range) {
      std::vector<std::string> words = given.more;
      words.push_back("limits.parameter=" + range);
      return scene_of(given.scene, words);
    };
    const scene::Scene wide = limited(given.wide);
    const auto system = scene::bound_system(wide.system);
    const auto folder = test::fresh_folder(fmt::format("widened{}_{}", ++number, comm.size()), comm.get());
    const survey::Summary narrow = survey::run_survey(comm, limited(given.narrow), system, folder, {});
    const auto cut = test::dataset_bytes(narrow.atlas);
    const survey::Summary resumed = survey::run_survey(comm, wide, system, folder, {survey::Display::none, true});
    EXPECT_THROW((void)survey::run_survey(comm, limited(given.narrow), system, folder, {survey::Display::none, true}),
                 core::InputError);
    if (!comm.is_root()) continue;
    EXPECT_FALSE(resumed.stopped_early);
    EXPECT_NE(test::dataset_bytes(resumed.atlas), cut);
    const core::Communicator alone(MPI_COMM_SELF);
    const survey::Summary whole =
        survey::run_survey(alone, wide, system, test::fresh_folder(fmt::format("whole{}", number)), {});
    EXPECT_EQ(test::dataset_bytes(resumed.atlas), test::dataset_bytes(whole.atlas));
  }
}

TEST(ParameterFamilies, ChangedNumbersAreFound) {
  constexpr double part = 1e-8;
  const core::Communicator comm;
  const survey::Summary summary = test::run(comm, scene_of("duffing.yaml"), "response");
  const test::Atlas atlas(summary.atlas);
  const archive::Records records = test::complete_records_of(atlas);
  const auto named = [&](const archive::Records& changed) {
    const auto folder = test::fresh_folder(fmt::format("changed{}", comm.size()), comm.get());
    if (comm.is_root()) test::write_sample_atlas(folder, atlas.header(), changed);
    MPI_Barrier(comm.get());
    std::set<std::string> rows;
    for (const survey::Objection& objection : survey::verify(comm, folder / "atlas.h5").objections)
      rows.insert(fmt::format("{} {}", objection.table, objection.row));
    return rows;
  };
  const std::set<std::string> unchanged = named(records);
  EXPECT_TRUE(unchanged.empty()) << fmt::format("{}", fmt::join(unchanged, "; "));
  const std::vector<std::pair<std::string, std::function<void(archive::Records&)>>> changes{
      {"orbits 5", [](auto& r) { r.orbits[5].parameter *= 1.0 + part; }},
      {"orbits 12", [](auto& r) { r.orbits[12].period *= 1.0 + part; }},
      {"orbits 20", [](auto& r) { r.orbits[20].modes[r.orbits[20].modes.size() / 3] += part; }},
      {"orbits 30", [](auto& r) { r.orbits[30].stability[0] += part; }},
      {"orbits 35", [](auto& r) { r.orbits[35].log_volume *= 1.0 + part; }},
      {"orbits 40", [](auto& r) { r.orbits[40].parameter = archive::not_computed; }},
      {"crossings 0", [](auto& r) { r.crossings[0].parameter *= 1.0 + part; }},
      {"crossings 1", [](auto& r) { r.crossings[1].period *= 1.0 + part; }},
  };
  archive::Records changed = records;
  for (const auto& [place, change] : changes) change(changed);
  const std::set<std::string> found = named(changed);
  if (!comm.is_root()) return;
  for (const auto& [place, change] : changes)
    EXPECT_TRUE(found.contains(place)) << place << "; found were " << fmt::format("{}", fmt::join(found, "; "));
}

}  // namespace
}  // namespace parameter_families_test
