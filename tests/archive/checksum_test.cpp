#include <gmock/gmock.h>

#include <cstdint>
#include <fstream>
#include <functional>
#include <iterator>
#include <random>

#include <fmt/format.h>

#include "archive/sample.hpp"
#include "file/h5_handle.hpp"
#include "orbweaver/archive/read/reader.hpp"
#include "orbweaver/archive/write/consolidate.hpp"
#include "orbweaver/archive/write/segment.hpp"
#include "orbweaver/core/error.hpp"
#include "schema/row_checksum.hpp"

namespace checksum_test {
namespace {

using namespace orbweaver;
using namespace orbweaver::archive;
using ::testing::AnyOf;
using ::testing::HasSubstr;

std::string bytes_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void write_bytes(const std::filesystem::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

/// What reading everything says; empty: nothing is wrong.
std::string read_whole(const std::filesystem::path& path) {
  try {
    const Archive atlas(path);
    for (std::size_t row = 0; row < atlas.orbits().rows(); ++row) {
      (void)atlas.modes(row);
      (void)atlas.time_map(row);
    }
  } catch (const core::InputError& error) {
    return error.what();
  }
  return "";
}

/// Where a dataset's values lie in the file, and how many bytes a row has.
struct Place {
  std::uint64_t offset = 0;
  std::uint64_t rows = 0;
  std::uint64_t width = 0;
};

Place place_of(const std::filesystem::path& path, const std::string& name) {
  const H5Handle file(check_h5(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), "H5Fopen"), H5Fclose);
  const H5Handle dataset(check_h5(H5Dopen2(file.get(), name.c_str(), H5P_DEFAULT), name), H5Dclose);
  const H5Handle space(H5Dget_space(dataset.get()), H5Sclose);
  std::vector<hsize_t> extents(static_cast<std::size_t>(H5Sget_simple_extent_ndims(space.get())));
  H5Sget_simple_extent_dims(space.get(), extents.data(), nullptr);
  return {H5Dget_offset(dataset.get()), extents[0],
          extents[0] == 0 ? 0 : H5Dget_storage_size(dataset.get()) / extents[0]};
}

class Checksums : public ::testing::Test {
 protected:
  void SetUp() override {
    folder = test::fresh_folder(::testing::UnitTest::GetInstance()->current_test_info()->name());
    header = test::sample_header();
    records = test::sample_records(header);
    atlas = test::write_sample_atlas(folder, header, records);
    segment = folder / "segment.h5";
  }

  Header header;
  Records records;
  std::filesystem::path folder;
  std::filesystem::path atlas;
  std::filesystem::path segment;
};

TEST_F(Checksums, ValuesAreSummedAsDocumented) {
  // zlib.crc32(struct.pack('<3d', 1.0, -0.0, 2.5)) in Python.
  const std::vector<double> values{1.0, -0.0, 2.5};
  const std::vector<double> other{1.0, 0.0, 2.5};
  EXPECT_EQ(values_checksum(values), 1331143776);
  EXPECT_NE(values_checksum(values), values_checksum(other));
}

TEST_F(Checksums, AnUnchangedArchiveHoldsAndAnOlderOneCarriesNone) {
  EXPECT_EQ(read_whole(atlas), "");
  EXPECT_TRUE(Archive(atlas).has_checksums());
  test::remove_checksums(atlas);
  EXPECT_EQ(read_whole(atlas), "");
  EXPECT_FALSE(Archive(atlas).has_checksums());
  EXPECT_THAT(Archive(atlas).orbits().integers("checksum"), ::testing::Each(-1));
}

/// Every 29th byte of those that are no values, and a hundred anywhere in the file.
TEST_F(Checksums, AByteThatChangesAnywhereIsFound) {
  const std::string whole = bytes_of(atlas);
  std::vector<bool> is_value(whole.size(), false);
  for (const auto& [name, bytes] : test::dataset_bytes(atlas)) {
    const Place place = place_of(atlas, name);
    for (std::uint64_t at = place.offset; place.rows > 0 && at < place.offset + place.rows * place.width; ++at)
      is_value[at] = true;
  }
  std::vector<std::size_t> places;
  std::size_t others = 0;
  for (std::size_t at = 0; at < whole.size(); ++at)
    if (!is_value[at] && others++ % 29 == 0) places.push_back(at);
  std::mt19937 generator(2026);
  for (int n = 0; n < 100; ++n) places.push_back(generator() % whole.size());
  const std::filesystem::path copy = folder / "copy.h5";
  std::size_t unseen = 0;
  std::size_t values_unseen = 0;
  for (const std::size_t at : places) {
    std::string bytes = whole;
    bytes[at] = static_cast<char>(bytes[at] ^ static_cast<char>(1 + generator() % 255));
    write_bytes(copy, bytes);
    if (!read_whole(copy).empty()) continue;
    fmt::print("byte {} of {}\n", at, whole.size());
    ++unseen;
    if (is_value[at]) ++values_unseen;
  }
  fmt::print("{} of {} bytes that are no values can change unseen\n", unseen, places.size() - 100);
  EXPECT_EQ(values_unseen, 0U);
  EXPECT_EQ(unseen, 0U);
}

/// A hundred changed bytes in the values of all columns and loops: each row is named.
TEST_F(Checksums, TheRowOfAChangedByteIsNamed) {
  std::vector<std::pair<std::string, Place>> datasets;
  for (const auto& [name, bytes] : test::dataset_bytes(atlas)) {
    const Place place = place_of(atlas, name);
    if (place.rows > 0 && place.width > 0) datasets.emplace_back(name, place);
  }
  const Archive sound(atlas);
  const auto owner = [&](const char* column, std::uint64_t value) {
    const auto& begins = sound.orbits().integers(column);
    return static_cast<std::size_t>(std::upper_bound(begins.begin(), begins.end(), static_cast<std::int64_t>(value)) -
                                    begins.begin()) -
           1;
  };
  const std::string whole = bytes_of(atlas);
  const std::filesystem::path copy = folder / "copy.h5";
  std::mt19937 generator(7);
  for (int n = 0; n < 100; ++n) {
    const auto& [name, place] = datasets[static_cast<std::size_t>(n) % datasets.size()];
    const std::uint64_t row = generator() % place.rows;
    std::string bytes = whole;
    const std::size_t at = place.offset + row * place.width + generator() % place.width;
    bytes[at] = static_cast<char>(bytes[at] ^ static_cast<char>(1 + generator() % 255));
    write_bytes(copy, bytes);
    const std::string text = read_whole(copy);
    const bool is_flat = name == "modes" || name == "time_maps";
    // Several orbits without a time map begin at the same value: the last of them owns it.
    const std::size_t named = is_flat ? owner(name == "modes" ? "modes_begin" : "time_map_begin", row) : row;
    EXPECT_THAT(text, HasSubstr(fmt::format("row {}", named))) << "byte " << at << ", /" << name << " row " << row;
    const Archive listed = [&] {
      try {
        return Archive(copy, ChangedRows::listed);
      } catch (const core::InputError&) {
        return Archive(atlas);
      }
    }();
    if (is_flat) {
      EXPECT_EQ(listed.changed_loop(named).size(), 1U) << text;
    } else {
      ASSERT_EQ(listed.changed_rows().size(), 1U) << text;
      EXPECT_EQ(listed.changed_rows()[0].row, row);
      EXPECT_EQ(listed.changed_rows()[0].table, name.substr(0, name.find('/')));
    }
  }
}

TEST_F(Checksums, AChangedAttributeIsFound) {
  {
    const H5Handle file(check_h5(H5Fopen(atlas.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), "H5Fopen"), H5Fclose);
    const H5Handle scales(check_h5(H5Aopen(file.get(), "parameter_values", H5P_DEFAULT), "parameter_values"), H5Aclose);
    const H5Handle space(H5Aget_space(scales.get()), H5Sclose);
    std::vector<double> values(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space.get())));
    ASSERT_FALSE(values.empty()) << "the sample names no parameter";
    check_h5(H5Aread(scales.get(), H5T_NATIVE_DOUBLE, values.data()), "parameter_values");
    values[0] += 1e-9;
    check_h5(H5Awrite(scales.get(), H5T_NATIVE_DOUBLE, values.data()), "parameter_values");
  }
  EXPECT_THAT(read_whole(atlas), HasSubstr("root attributes that were changed"));
}

/// Damaged segments are seen by a resume, which inspects them, and by consolidation.
TEST_F(Checksums, AChangedByteOfASegmentIsFoundWhenItIsReadAgain) {
  const std::string whole = bytes_of(segment);
  for (const char* name :
       {"orbits/period", "orbits/stability", "orbits/family_key", "sections/state", "modes", "time_maps"}) {
    const Place place = place_of(segment, name);
    ASSERT_GT(place.rows, 2U) << name;
    std::string bytes = whole;
    const std::size_t at = place.offset + 2 * place.width;
    bytes[at] = static_cast<char>(bytes[at] ^ 4);
    const std::filesystem::path copy = folder / "copy.h5";
    write_bytes(copy, bytes);
    for (const auto& read : std::vector<std::function<void()>>{
             [&] { (void)inspect_segment(copy); },
             [&] { consolidate(MPI_COMM_SELF, {copy}, folder / "again.h5", header, test::tables_of(records)); }})
      try {
        read();
        ADD_FAILURE() << name << ": the segment was taken for good";
      } catch (const core::InputError& error) {
        EXPECT_THAT(error.what(), HasSubstr("copy.h5' has a changed")) << name;
        EXPECT_THAT(error.what(), HasSubstr("row ")) << name;
      }
    EXPECT_FALSE(std::filesystem::exists(folder / "again.h5"));
  }
}

}  // namespace
}  // namespace checksum_test
