// Surveys with loci: curves of crossings in two parameters as tasks of the queue, and what verify says of them.
#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <functional>
#include <limits>
#include <map>
#include <numbers>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>
#include <Eigen/Dense>

#include "orbweaver/certificate/integrate.hpp"
#include "orbweaver/numerics/decompositions.hpp"
#include "orbweaver/survey/verify/verify.hpp"
#include "survey/atlas.hpp"
#include "survey/atlas_records.hpp"

namespace loci_test {
namespace {

using namespace orbweaver;

scene::Scene scene_of(const std::string& name, const std::vector<std::string>& more) {
  return scene::load(ORBWEAVER_SOURCE_DIR "/drivers/scenes/" + name, more);
}

scene::Scene folds_of_duffing() {
  return scene_of("duffing.yaml", {"loci=[{of: [fold-parameter], free: [drive_amplitude], range: [0.01, 0.5]}]"});
}

/// Raised from rest: a symmetric answer, its pair of unsymmetric ones, and their doubling.
scene::Scene doublings_of_duffing(double frequency, const std::string& loci) {
  return scene_of("duffing.yaml", {"survey.depth=1", "survey.subharmonics=2", "system.parameters.damping=0.2",
                                   "system.parameters.drive_amplitude=0",
                                   fmt::format("system.parameters.drive_frequency={}", frequency),
                                   "starts={fixed_points: {grid: [[0]]}}", "continuation.free=drive_amplitude",
                                   "limits.parameter=[0, 20]", "limits.period=30", "loci=" + loci});
}

constexpr const char* doublings = "[{of: [period-doubling, branch-point], free: [drive_frequency], range: [1, 1.6]}]";

struct Point {
  double period, parameter, second;
  std::string note;
  std::vector<double> state;
};

/// The curves of a kind.
std::vector<std::vector<Point>> loci_of(const test::Atlas& atlas, const std::string& kind) {
  const archive::Table& loci = atlas.loci();
  const std::size_t d = atlas.header().state_names.size();
  std::map<std::int64_t, std::vector<Point>> curves;
  for (std::size_t row = 0; row < loci.rows(); ++row) {
    if (loci.texts("kind")[row] != kind) continue;
    const auto first = loci.reals("state").begin() + static_cast<std::ptrdiff_t>(row * d);
    curves[loci.integers("locus")[row]].push_back({loci.reals("period")[row],
                                                   loci.reals("parameter")[row],
                                                   loci.reals("second_parameter")[row],
                                                   loci.texts("note")[row],
                                                   {first, first + static_cast<std::ptrdiff_t>(d)}});
  }
  std::vector<std::vector<Point>> out;
  for (auto& [number, curve] : curves) out.push_back(std::move(curve));
  return out;
}

std::string objections_to(const core::Communicator& comm, const std::filesystem::path& atlas) {
  std::string text;
  for (const survey::Objection& o : survey::verify(comm, atlas).objections)
    text += fmt::format("{} {} {}: {}\n", o.table, o.row, o.column, o.text);
  return text;
}

/// The folds of the answer raised from rest at a frequency, in the drive's amplitude.
std::vector<double> folds_at(const core::Communicator& comm, double frequency) {
  const scene::Scene scene = scene_of(
      "duffing.yaml",
      {"system.parameters.drive_amplitude=0", fmt::format("system.parameters.drive_frequency={}", frequency),
       "starts={fixed_points: {grid: [[0]]}}", "continuation.free=drive_amplitude", "limits.parameter=[0, 0.2]"});
  const test::Atlas atlas(test::run(comm, scene, "beside_cusp").atlas);
  std::vector<double> found;
  for (std::size_t row = 0; row < atlas.crossings().rows(); ++row)
    if (atlas.crossings().texts("kind")[row] == "fold-parameter")
      found.push_back(atlas.crossings().reals("parameter")[row]);
  std::sort(found.begin(), found.end());
  return found;
}

/// The least cosine between neighbouring ways of a curve in the plane of the two parameters, each told in its range.
double sharpest_turn(const std::vector<Point>& curve) {
  const auto range = [&](double Point::*value) {
    const auto [least, largest] = std::minmax_element(
        curve.begin(), curve.end(), [value](const Point& a, const Point& b) { return a.*value < b.*value; });
    return (*largest).*value - (*least).*value;
  };
  const double width = range(&Point::parameter);
  const double height = range(&Point::second);
  double least = 1.0;
  for (std::size_t n = 2; n < curve.size(); ++n) {
    const std::complex<double> before((curve[n - 1].parameter - curve[n - 2].parameter) / width,
                                      (curve[n - 1].second - curve[n - 2].second) / height);
    const std::complex<double> behind((curve[n].parameter - curve[n - 1].parameter) / width,
                                      (curve[n].second - curve[n - 1].second) / height);
    least = std::min(least, std::cos(std::arg(behind / before)));
  }
  return least;
}

TEST(Loci, FoldsOfDuffingAreOneCurveWithACusp) {
  const core::Communicator comm;
  const survey::Summary summary = test::run(comm, folds_of_duffing(), "folds");
  EXPECT_EQ(objections_to(comm, summary.atlas), "");
  if (!comm.is_root()) return;
  EXPECT_EQ(summary.failures, 0U);
  const test::Atlas atlas(summary.atlas);
  const auto curves = loci_of(atlas, "fold-parameter");
  ASSERT_EQ(curves.size(), 1U) << "it comes to the other fold, where another would begin";
  const std::vector<Point>& curve = curves.front();
  const auto is_cusp = [](const Point& p) { return p.note == "cusp"; };
  ASSERT_EQ(std::count_if(curve.begin(), curve.end(), is_cusp), 1);
  const Point& cusp = *std::find_if(curve.begin(), curve.end(), is_cusp);
  constexpr double beside = 5e-4;
  const core::Communicator alone(MPI_COMM_SELF);
  EXPECT_TRUE(folds_at(alone, cusp.parameter - beside).empty());
  const std::vector<double> near = folds_at(alone, cusp.parameter + beside);
  const std::vector<double> far = folds_at(alone, cusp.parameter + 4.0 * beside);
  ASSERT_EQ(near.size(), 2U);
  ASSERT_EQ(far.size(), 2U);
  EXPECT_NEAR((4.0 * (near[0] + near[1]) - (far[0] + far[1])) / 6.0, cusp.second, 1e-5);
  EXPECT_NEAR((far[1] - far[0]) / (near[1] - near[0]), 8.0, 0.2) << "the power 3/2 of the distance";
  EXPECT_LT(sharpest_turn(curve), -0.9);
  const auto back = std::find_if(curve.begin(), curve.end(), [](const Point& p) { return p.note == "return"; });
  ASSERT_NE(back, curve.end());
  EXPECT_NEAR(back->parameter, atlas.crossings().reals("parameter")[1], 1e-9);
  for (const Point* end : {&curve.front(), &curve.back()}) {
    EXPECT_NEAR(end->second, 0.5, 1e-10);
    EXPECT_EQ(end->note, "parameter limit (drive_amplitude = 0.5)");
  }
}

/// The doublings of the family in the drive's amplitude that passes near a point of a locus, from its state.
std::vector<double> located_near(const core::Communicator& comm, const Point& point) {
  constexpr double beside = 0.02;
  constexpr double within = 0.1;
  const scene::Scene scene =
      scene_of("duffing.yaml",
               {"system.parameters.damping=0.2", fmt::format("system.parameters.drive_frequency={}", point.second),
                fmt::format("system.parameters.drive_amplitude={}", point.parameter + beside),
                "continuation.free=drive_amplitude",
                fmt::format("starts={{states: [{{state: [{}, {}, {}], period: {}}}]}}", point.state[0], point.state[1],
                            point.state[2] / std::numbers::pi * 180.0, point.period),
                fmt::format("limits.parameter=[{}, {}]", point.parameter - within, point.parameter + within)});
  const test::Atlas atlas(test::run(comm, scene, "direct").atlas);
  std::vector<double> found;
  for (std::size_t row = 0; row < atlas.crossings().rows(); ++row)
    if (atlas.crossings().texts("kind")[row] == "period-doubling")
      found.push_back(atlas.crossings().reals("parameter")[row]);
  return found;
}

TEST(Loci, DoublingsOfDuffingLieWhereTheyAreLocated) {
  const core::Communicator comm;
  const survey::Summary summary = test::run(comm, doublings_of_duffing(1.2, doublings), "doublings");
  EXPECT_EQ(objections_to(comm, summary.atlas), "");
  if (!comm.is_root()) return;
  EXPECT_EQ(summary.failures, 0U);
  const test::Atlas atlas(summary.atlas);
  EXPECT_EQ(loci_of(atlas, "branch-point").size(), 1U) << "the mirror image enforces it";
  const auto curves = loci_of(atlas, "period-doubling");
  ASSERT_EQ(curves.size(), 1U);
  const std::vector<Point>& curve = curves.front();
  EXPECT_GT(sharpest_turn(curve), 0.5) << "no cusp: no fold lies on it (docs/mathematics.md)";
  const core::Communicator alone(MPI_COMM_SELF);
  int compared = 0;
  for (std::size_t n = 1; n + 1 < curve.size(); n += curve.size() / 7) {
    if (!curve[n].note.empty()) continue;
    SCOPED_TRACE(curve[n].second);
    const std::vector<double> found = located_near(alone, curve[n]);
    ASSERT_EQ(found.size(), 1U);
    EXPECT_NEAR(found.front(), curve[n].parameter, 1e-8);
    ++compared;
  }
  EXPECT_GE(compared, 5);
}

/// A damped double pendulum shaken upwards, which hangs still until its rest doubles the drive's period: by Floquet's
/// theory of the linear equations (integrated by scipy) at these frequencies. On either side the rest is followed. The
/// fold of the doubled orbits ends where they come to rest, on the curve of the doublings themselves.
TEST(Loci, OfAShakenPendulumEndWhereItRests) {
  const core::Communicator comm;
  if (comm.size() != 2) GTEST_SKIP() << "it takes seconds";
  const survey::Summary summary = test::run(
      comm,
      scene_of("damped_driven_double_pendulum.yaml",
               {"system={name: double_pendulum, effects: [damping, pivot_drive], parameters: {c1: 0.05, c2: 0.05, "
                "pivot_amplitude: 0.1, drive_frequency: 1.5}}",
                "starts={fixed_points: {grid: [[0], [0]]}}", "continuation.free=drive_frequency", "survey.depth=1",
                "limits.parameter=[0.9, 1.7]", "limits.period=80",
                "loci=[{of: [fold-parameter], free: [pivot_amplitude], range: [0, 0.2]}]"}),
      "shaken");
  EXPECT_EQ(objections_to(comm, summary.atlas), "");
  if (!comm.is_root()) return;
  EXPECT_EQ(summary.failures, 0U);
  const test::Atlas atlas(summary.atlas);
  std::vector<double> found;
  for (std::size_t row = 0; row < atlas.crossings().rows(); ++row)
    if (atlas.crossings().texts("kind")[row] == "period-doubling")
      found.push_back(atlas.crossings().reals("parameter")[row]);
  std::sort(found.begin(), found.end());
  ASSERT_EQ(found.size(), 2U);
  EXPECT_NEAR(found[0], 1.44976620424, 1e-9);
  EXPECT_NEAR(found[1], 1.63026204936, 1e-9);
  const auto curves = loci_of(atlas, "fold-parameter");
  ASSERT_EQ(curves.size(), 1U);
  const auto at_rest = std::find_if(curves[0].begin(), curves[0].end(), [](const Point& point) {
    return point.note.rfind("met orbits of more symmetry (1@1/2", 0) == 0;
  });
  ASSERT_NE(at_rest, curves[0].end());
  EXPECT_NEAR(at_rest->parameter, 1.53067, 0.02) << "a step before";
  for (const Point& point : curves[0]) EXPECT_NE(point.note, "cusp") << point.parameter;
}

TEST(Loci, OfThePendulumInPeriodAndMass) {
  const core::Communicator comm;
  const survey::Summary summary = test::run(
      comm,
      scene_of("double_pendulum.yaml", {"survey.depth=0", "starts.fixed_points.grid=[[0], [0]]", "limits.period=9",
                                        "loci=[{of: [period-doubling], free: [m2], range: [0.5, 2]}]"}),
      "pendulum");
  EXPECT_EQ(objections_to(comm, summary.atlas), "");
  if (!comm.is_root()) return;
  EXPECT_EQ(summary.failures, 0U);
  const test::Atlas atlas(summary.atlas);
  const auto curves = loci_of(atlas, "period-doubling");
  const bool found = std::any_of(curves.begin(), curves.end(), [](const std::vector<Point>& curve) {
    return std::any_of(curve.begin(), curve.end(), [](const Point& point) {
      return point.note == "start" && std::abs(point.period - 8.442930704977588) < 1e-9 && std::isnan(point.parameter);
    });
  });
  EXPECT_TRUE(found) << "In-Phase's first doubling";
}

TEST(Loci, TorusPointsOfADoubledFamily) {
  const core::Communicator comm;
  if (comm.size() != 2) GTEST_SKIP() << "it takes seconds; that ranks agree is asked of doublings below";
  const survey::Summary summary = test::run(
      comm,
      scene_of("damped_driven_double_pendulum.yaml", {"survey.depth=1", "limits.parameter=[1.4115, 1.4243]",
                                                      "loci=[{of: [torus], free: [c1], range: [0.19, 0.21]}]"}),
      "torus");
  EXPECT_EQ(objections_to(comm, summary.atlas), "") << "it integrates each point: two multipliers of modulus 1";
  if (!comm.is_root()) return;
  EXPECT_EQ(summary.failures, 0U);
  const auto curves = loci_of(test::Atlas(summary.atlas), "torus");
  ASSERT_EQ(curves.size(), 1U);
  const std::vector<Point>& curve = curves.front();
  EXPECT_GE(curve.size(), 4U);
  EXPECT_EQ(std::count_if(curve.begin(), curve.end(), [](const Point& p) { return p.note == "start"; }), 1);
  EXPECT_NEAR(curve.front().parameter, 1.4243, 1e-10);
  EXPECT_NEAR(curve.back().parameter, 1.4115, 1e-10);
  for (const Point& point : curve) EXPECT_NEAR(point.period, 4.0 * std::numbers::pi / 0.9, 1e-9) << "twice the drive's";
}

/// Near the end of a curve of torus points: a doubled orbit beside one of them, at `c1`.
struct BesideTorus {
  const char* state;
  double amplitude, c1;
  const char* amplitudes;
  const char* range;
};

constexpr BesideTorus beside_one_to_one{"142.543227, 51.7950766, 0, 1.9202047, 793.885987", 2.03960946, 0.4396474,
                                        "2.03, 2.041", "0.435, 0.445"};
constexpr BesideTorus beside_one_to_two{"134.655271, 32.9582412, 0, 1.77260063, 92.6773591", 1.65352684, 0.1855684,
                                        "1.645, 1.655", "0.181, 0.186"};

scene::Scene torus_points(const BesideTorus& at, const std::string& amplitudes) {
  return scene_of(
      "damped_driven_double_pendulum.yaml",
      {fmt::format("starts={{states: [{{state: [{}], period: {}}}]}}", at.state, 4.0 * std::numbers::pi / 0.9),
       fmt::format("system.parameters.torque1_amplitude={}", at.amplitude),
       fmt::format("system.parameters.c1={}", at.c1), fmt::format("limits.parameter=[{}]", amplitudes),
       fmt::format("loci=[{{of: [torus], free: [c1], range: [{}]}}]", at.range), "survey.depth=0"});
}

/// Of the orbit, integrated: the two multipliers nearest to `resonant`, nearest first.
std::array<std::complex<double>, 2> multipliers_near(const scene::Scene& scene, const Point& point, double resonant) {
  std::map<std::string, double> values = scene::bound_system(scene.system)->parameters();
  values["torque1_amplitude"] = point.parameter;
  values["c1"] = point.second;
  const auto system = scene::bound_system(scene.system)->with_parameters(values);
  const std::vector<double> flow = certificate::transitions(*system, {point.state}, point.period, 1e-13).front();
  const auto d = static_cast<Eigen::Index>(point.state.size());
  const Eigen::MatrixXd map = Eigen::Map<const Eigen::MatrixXd>(flow.data(), d, d).topLeftCorner(d - 1, d - 1);
  Eigen::VectorXcd all = Eigen::EigenSolver<Eigen::MatrixXd>(map).eigenvalues();  // without the phase, of multiplier 1
  std::sort(all.begin(), all.end(), [resonant](std::complex<double> a, std::complex<double> b) {
    return std::abs(a - resonant) < std::abs(b - resonant);
  });
  return {all(0), all(1)};
}

void expect_end_at(double resonant, const BesideTorus& beside, const std::string& name) {
  const core::Communicator comm(MPI_COMM_SELF);
  const scene::Scene scene = torus_points(beside, beside.amplitudes);
  const survey::Summary summary = test::run(comm, scene, "resonant");
  EXPECT_EQ(objections_to(comm, summary.atlas), "") << "multipliers that coincide are known to half the digits";
  EXPECT_EQ(summary.failures, 0U);
  const auto curves = loci_of(test::Atlas(summary.atlas), "torus");
  ASSERT_EQ(curves.size(), 1U);
  const Point& end = curves.front().back();
  EXPECT_EQ(end.note, "strong resonance (" + name + ")");
  const auto mu = multipliers_near(scene, end, resonant);
  // Each moves away with the square root of what is left; their sum and product do not.
  EXPECT_LT(std::abs(mu[0] + mu[1] - 2.0 * resonant), 1e-7);
  EXPECT_LT(std::abs(mu[0] * mu[1] - 1.0), 1e-7);
}

TEST(Loci, OfTorusPointsEndWhereBothMultipliersAreOne) {
  if (core::Communicator().size() != 1) GTEST_SKIP() << "it takes seconds; that ranks agree is asked below";
  expect_end_at(1.0, beside_one_to_one, "1:1, both multipliers are 1");
}

TEST(Loci, OfTorusPointsEndWhereBothMultipliersAreMinusOne) {
  if (!core::Communicator().is_root()) return;
  expect_end_at(-1.0, beside_one_to_two, "1:2, both multipliers are -1");
}

TEST(Loci, OfTorusPointsHaveTheSameBytesResumedAndWithWiderLimits) {
  const core::Communicator comm;
  const BesideTorus& beside = beside_one_to_one;
  const auto system = scene::bound_system(torus_points(beside, beside.amplitudes).system);
  const auto survey_to = [&](const std::filesystem::path& folder, const std::string& amplitudes, bool resume,
                             double walltime) {
    return survey::run_survey(comm, torus_points(beside, amplitudes), system, folder,
                              {survey::Display::none, resume, walltime});
  };
  constexpr double ever = std::numeric_limits<double>::infinity();
  const auto other = test::fresh_folder("torus_whole", comm.get());
  const survey::Summary whole = survey_to(other, beside.amplitudes, false, ever);
  const auto folder = test::fresh_folder("torus_resumed", comm.get());
  const survey::Summary narrow = survey_to(folder, "2.036, 2.0405", false, ever);
  if (comm.is_root()) {
    const auto curves = loci_of(test::Atlas(narrow.atlas), "torus");
    ASSERT_EQ(curves.size(), 1U);
    EXPECT_EQ(curves.front().back().note, "parameter limit (torque1_amplitude = 2.036)");
  }
  // Broken off again and again while the families or the curve go on.
  survey::Summary summary = survey_to(folder, beside.amplitudes, true, 0.3);
  int times = 1;
  for (; summary.stopped_early && times < 8; ++times) summary = survey_to(folder, beside.amplitudes, true, 0.3 * times);
  EXPECT_GT(times, 1);
  summary = survey_to(folder, beside.amplitudes, true, ever);
  EXPECT_FALSE(summary.stopped_early);
  if (!comm.is_root()) return;
  EXPECT_EQ(test::dataset_bytes(summary.atlas), test::dataset_bytes(whole.atlas));
}

TEST(Loci, HaveTheSameBytesOnAllRanksAndResumed) {
  const core::Communicator comm;
  const scene::Scene scene = doublings_of_duffing(1.2, doublings);
  const auto system = scene::bound_system(scene.system);
  const auto folder = test::fresh_folder(fmt::format("resumed{}", comm.size()), comm.get());
  survey::RunOptions options;
  options.walltime = 0.2;
  (void)survey::run_survey(comm, scene, system, folder, options);
  const survey::Summary resumed = survey::run_survey(comm, scene, system, folder, {survey::Display::none, true});
  EXPECT_FALSE(resumed.stopped_early);
  if (!comm.is_root()) return;
  const core::Communicator alone(MPI_COMM_SELF);
  const auto other = test::fresh_folder("alone");
  const survey::Summary whole = survey::run_survey(alone, scene, system, other, {});
  EXPECT_EQ(test::dataset_bytes(resumed.atlas), test::dataset_bytes(whole.atlas));
}

TEST(Loci, ChangedNumbersAreFound) {
  constexpr double part = 1e-6;
  const core::Communicator comm;
  const survey::Summary summary = test::run(comm, folds_of_duffing(), "changed");
  const test::Atlas atlas(summary.atlas);
  archive::Records changed = test::complete_records_of(atlas);
  ASSERT_GT(changed.loci.size(), 20U);
  changed.loci[3].parameter *= 1.0 + part;
  changed.loci[6].second_parameter *= 1.0 + part;
  changed.loci[9].period *= 1.0 + part;
  changed.loci[12].state[0] += part;
  changed.loci[15].kind = archive::CrossingKind::period_doubling;
  const auto folder = test::fresh_folder(fmt::format("changed_numbers{}", comm.size()), comm.get());
  if (comm.is_root()) test::write_sample_atlas(folder, atlas.header(), changed);
  MPI_Barrier(comm.get());
  std::set<std::int64_t> rows;
  for (const survey::Objection& objection : survey::verify(comm, folder / "atlas.h5").objections)
    if (objection.table == "loci") rows.insert(objection.row);
  if (!comm.is_root()) return;
  EXPECT_EQ(rows, (std::set<std::int64_t>{3, 6, 9, 12, 15}));
}

}  // namespace
}  // namespace loci_test
