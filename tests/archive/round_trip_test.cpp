#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "archive/sample.hpp"
#include "file/h5_handle.hpp"
#include "orbweaver/archive/read/reader.hpp"
#include "orbweaver/archive/write/consolidate.hpp"
#include "orbweaver/archive/write/segment.hpp"

namespace round_trip_test {
namespace {

using namespace orbweaver;
using namespace orbweaver::archive;
using orbweaver::test::sample_header;
using orbweaver::test::sample_records;
using ::testing::ElementsAre;

std::vector<double> slice(const std::vector<double>& values, std::size_t row, std::size_t width) {
  const auto begin = values.begin() + static_cast<std::ptrdiff_t>(row * width);
  return {begin, begin + static_cast<std::ptrdiff_t>(width)};
}

void expect_equal(double actual, double expected) {
  if (std::isnan(expected)) {
    EXPECT_TRUE(std::isnan(actual));
  } else {
    EXPECT_EQ(actual, expected);
  }
}

void expect_vector(const std::vector<double>& actual, const std::vector<double>& expected) {
  if (!expected.empty()) {
    EXPECT_EQ(actual, expected);
    return;
  }
  for (const double value : actual) EXPECT_TRUE(std::isnan(value));
}

void expect_row(const Archive& atlas, std::size_t row, const OrbitRecord& orbit) {
  const Table& orbits = atlas.orbits();
  const std::size_t stability = stability_width(atlas.header());
  EXPECT_EQ(orbits.integers("step")[row], orbit.step);
  EXPECT_EQ(orbits.integers("cutoff")[row], orbit.cutoff);
  expect_equal(orbits.reals("arclength")[row], orbit.arclength);
  expect_equal(orbits.reals("period")[row], orbit.period);
  expect_equal(orbits.reals("energy")[row], orbit.energy);
  expect_equal(orbits.reals("action")[row], orbit.action);
  expect_equal(orbits.reals("parameter")[row], orbit.parameter);
  expect_equal(orbits.reals("loss_rms")[row], orbit.loss_rms);
  expect_equal(orbits.reals("off_branch_eigenvalue")[row], orbit.off_branch_eigenvalue);
  expect_equal(orbits.reals("stability_error")[row], orbit.stability_error);
  expect_equal(orbits.reals("log_volume")[row], orbit.log_volume);
  expect_equal(orbits.reals("closure")[row], orbit.closure);
  expect_equal(orbits.reals("single_shot")[row], orbit.single_shot);
  expect_equal(orbits.reals("energy_drift")[row], orbit.energy_drift);
  expect_equal(orbits.reals("tail")[row], orbit.tail);
  EXPECT_EQ(orbits.integers("verdict")[row], orbit.verdict);
  expect_equal(orbits.reals("orbit_distance")[row], orbit.orbit_distance);
  expect_vector(slice(orbits.reals("stability"), row, stability), orbit.stability);
  expect_vector(slice(orbits.reals("fundamental_stability"), row, stability), orbit.fundamental_stability);
  expect_vector(slice(orbits.reals("state"), row, 2), orbit.state);
  expect_vector(slice(orbits.reals("winding"), row, 1), orbit.winding);
  EXPECT_EQ(atlas.modes(row), orbit.modes);
  EXPECT_EQ(atlas.time_map(row), orbit.time_map);
}

std::size_t row_of(const Archive& atlas, std::int64_t family, int step) {
  const auto& families = atlas.orbits().integers("family");
  const auto& steps = atlas.orbits().integers("step");
  for (std::size_t i = 0; i < families.size(); ++i)
    if (families[i] == family && steps[i] == step) return i;
  ADD_FAILURE() << "no row for step " << step << " of family " << family;
  return 0;
}

void expect_round_trip(const std::string& folder, const Header& header) {
  const Records records = sample_records(header);
  const Archive atlas(test::write_sample_atlas(test::fresh_folder(folder), header, records));
  EXPECT_EQ(atlas.header().scene, header.scene);
  EXPECT_EQ(atlas.header().state_names, header.state_names);
  EXPECT_EQ(atlas.header().winding_names, header.winding_names);
  EXPECT_EQ(atlas.header().winding_coordinates, header.winding_coordinates);
  EXPECT_EQ(atlas.header().orbweaver_version, header.orbweaver_version);
  EXPECT_EQ(atlas.header().pairs, header.pairs);
  EXPECT_EQ(atlas.header().system, header.system);
  EXPECT_EQ(atlas.header().effects, header.effects);
  EXPECT_EQ(atlas.header().parameter_names, header.parameter_names);
  EXPECT_EQ(atlas.header().parameter_values, header.parameter_values);
  EXPECT_EQ(atlas.header().scale_names, header.scale_names);
  EXPECT_EQ(atlas.header().scales, header.scales);
  const std::vector<std::string> keys{"0001", "0001.0002", "0002", "0003", "0003.0001"};
  ASSERT_EQ(atlas.orbits().rows(), 29u);
  for (const OrbitRecord& orbit : records.orbits) {
    const auto family = std::find(keys.begin(), keys.end(), orbit.family_key) - keys.begin();
    expect_row(atlas, row_of(atlas, family, orbit.step), orbit);
  }
}

TEST(RoundTrip, EveryOrbitComesBackBitForBit) { expect_round_trip("orbits", sample_header()); }

TEST(RoundTrip, ComplexStabilityKeepsBothParts) {
  expect_round_trip("dissipative", sample_header(1, false));
  expect_round_trip("two_pairs", sample_header(2, true));
  expect_round_trip("no_pairs", sample_header(0, true));
}

TEST(RoundTrip, TablesStandInCanonicalOrderWithIndices) {
  const Header header = sample_header();
  const Archive atlas(test::write_sample_atlas(test::fresh_folder("tables"), header, sample_records(header)));
  const Table& families = atlas.families();
  EXPECT_THAT(families.texts("name"), ElementsAre("In-Phase", "ID1", "Up-Down", "Out-Phase", "Ästhetik \"B\", 1"));
  EXPECT_EQ(families.texts("end_reason")[2], "no first orbit could be found – the Newton iteration stalled");
  EXPECT_THAT(families.integers("parent"), ElementsAre(-1, 0, -1, -1, 3));
  EXPECT_THAT(families.integers("crossing"), ElementsAre(-1, 1, -1, -1, 2));
  EXPECT_THAT(families.integers("end_family"), ElementsAre(-1, -1, -1, -1, 1));
  EXPECT_THAT(families.integers("end_crossing"), ElementsAre(-1, -1, -1, -1, 0));
  EXPECT_THAT(families.integers("multiplicity"), ElementsAre(1, 1, 1, 1, 2));
  EXPECT_THAT(families.integers("first_orbit"), ElementsAre(0, 12, 15, 15, 24));
  EXPECT_THAT(families.integers("orbit_count"), ElementsAre(12, 3, 0, 9, 5));
  EXPECT_EQ(atlas.orbits().integers("step")[15], -4);
  const Table& crossings = atlas.crossings();
  EXPECT_THAT(crossings.integers("family"), ElementsAre(0, 0, 3));
  EXPECT_THAT(crossings.reals("arclength"), ElementsAre(0.5, 2.5, 1.5));
  EXPECT_THAT(crossings.texts("kind"), ElementsAre("fold-energy", "period-doubling", "branch-point"));
  EXPECT_THAT(crossings.reals("state"), ElementsAre(0.5, -1, 2.5, -1, 1.5, -1));
  EXPECT_TRUE(std::isnan(crossings.reals("test_value")[0]));
}

TEST(RoundTrip, SectionsAreSortedByOrbitAndTimeAndOtherwiseKeepTheirOrder) {
  const Header header = sample_header();
  const Archive atlas(test::write_sample_atlas(test::fresh_folder("sections"), header, sample_records(header)));
  const Table& sections = atlas.sections();
  ASSERT_GE(sections.rows(), 4u);
  EXPECT_THAT(slice(sections.reals("time"), 0, 4), ElementsAre(0.25, 0.25, 1.5, 1.5));
  EXPECT_EQ(sections.integers("orbit")[2], 0);
  EXPECT_EQ(sections.integers("orbit")[3], 1);
  EXPECT_EQ(sections.reals("state")[0], 9.5);  // the first orbit of 0001 is the tenth of the sample
  EXPECT_EQ(sections.reals("state")[2], 9.75);
}

TEST(RoundTrip, AnEmptyAtlasIsValid) {
  const std::filesystem::path folder = test::fresh_folder("empty");
  Header header = sample_header();
  header.winding_names.clear();
  header.winding_coordinates.clear();
  header.scene.clear();
  const Archive none(test::write_sample_atlas(folder, header, {}));
  EXPECT_EQ(none.families().rows() + none.orbits().rows() + none.crossings().rows() + none.sections().rows(), 0u);
  EXPECT_EQ(none.header().scene, "");
  EXPECT_TRUE(none.header().winding_names.empty());
  consolidate(MPI_COMM_SELF, {}, folder / "no_segments.h5", header, {});
  EXPECT_EQ(Archive(folder / "no_segments.h5").orbits().rows(), 0u);
}

herr_t expect_no_time(hid_t, const char* name, const H5O_info_t* info, void*) {
  EXPECT_EQ(info->ctime, 0) << name;
  EXPECT_EQ(info->mtime, 0) << name;
  return 0;
}

TEST(RoundTrip, TextsAreFixedUtf8AndNothingCarriesATime) {
  const Header header = sample_header();
  const auto path = test::write_sample_atlas(test::fresh_folder("plain"), header, sample_records(header));
  const H5Handle file(check_h5(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), "H5Fopen"), H5Fclose);
  const H5Handle names(check_h5(H5Dopen2(file.get(), "families/name", H5P_DEFAULT), "H5Dopen2"), H5Dclose);
  const H5Handle type(check_h5(H5Dget_type(names.get()), "H5Dget_type"), H5Tclose);
  EXPECT_EQ(H5Tget_cset(type.get()), H5T_CSET_UTF8);
  EXPECT_EQ(H5Tis_variable_str(type.get()), 0);
  EXPECT_EQ(H5Tget_size(type.get()), std::string("Ästhetik \"B\", 1").size());
  check_h5(H5Ovisit(file.get(), H5_INDEX_NAME, H5_ITER_INC, expect_no_time, nullptr), "H5Ovisit");
}

TEST(RoundTrip, ASegmentSaysWhatItHolds) {
  const std::filesystem::path folder = test::fresh_folder("info");
  const Header header = sample_header();
  const Records records = sample_records(header);
  write_segment(MPI_COMM_SELF, folder / "s.h5", header, test::rows_of(records));
  const SegmentInfo info = inspect_segment(folder / "s.h5");
  EXPECT_EQ(info.orbits, records.orbits.size());
  EXPECT_EQ(info.sections, records.sections.size());
  EXPECT_EQ(info.header.scene, header.scene);
  std::size_t modes = 0;
  for (const OrbitRecord& orbit : records.orbits) modes += orbit.modes.size();
  EXPECT_EQ(info.mode_values, modes);
}

TEST(RoundTrip, OrbitsLargerThanAStageArePassedOnInPieces) {
  const std::filesystem::path folder = test::fresh_folder("large");
  const Header header = sample_header();
  Records records;
  records.families = {sample_records(header).families[2]};
  OrbitRecord orbit = sample_records(header).orbits[9];
  orbit.cutoff = 1 << 20;
  orbit.modes.assign((2 * static_cast<std::size_t>(orbit.cutoff) + 1) * 2, 0.0);
  for (std::size_t i = 0; i < orbit.modes.size(); ++i) orbit.modes[i] = static_cast<double>(i);
  records.orbits = {orbit, orbit};
  records.orbits[1].step = orbit.step + 1;
  records.orbits[1].modes[7] = -7;
  const Archive atlas(test::write_sample_atlas(folder, header, records));
  EXPECT_TRUE(atlas.modes(0) == records.orbits[0].modes);
  EXPECT_TRUE(atlas.modes(1) == records.orbits[1].modes);
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace round_trip_test
