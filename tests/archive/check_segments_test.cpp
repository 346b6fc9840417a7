#include <gmock/gmock.h>

#include <fstream>

#include <fmt/format.h>

#include "archive/sample.hpp"
#include "file/h5_handle.hpp"
#include "orbweaver/archive/read/check_segments.hpp"
#include "orbweaver/core/mpi/communicator.hpp"

namespace check_segments_test {
namespace {

using namespace orbweaver;
using namespace orbweaver::archive;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
namespace fs = std::filesystem;

constexpr int segments = 5;

class CheckSegments : public ::testing::Test {
 protected:
  void SetUp() override {
    folder = test::fresh_folder(::testing::UnitTest::GetInstance()->current_test_info()->name(), world.get());
    for (int i = 0; i < segments; ++i)
      listed.push_back(write_segment(world.get(), path(i), header,
                                     test::deal(records, segments * world.rank() + i, segments * world.size(), 11)));
  }

  [[nodiscard]] fs::path path(int segment) const { return folder / fmt::format("segment-{}.h5", segment); }

  // What all ranks hear after rank 0 has done `damage`; only rank 0 knows what was listed.
  template <class Damage>
  std::vector<std::string> complaints(const Damage& damage) {
    MPI_Barrier(world.get());
    if (world.is_root()) damage();
    MPI_Barrier(world.get());
    const bool root = world.is_root();
    const auto found =
        check_segments(world.get(), root ? folder : fs::path("elsewhere"),
                       root ? listed : std::vector<WrittenSegment>{}, root ? scenes : std::vector<std::string>{});
    std::string all;
    for (const std::string& text : found) all += text + '\n';
    std::string of_root = all;
    of_root.resize(4000);
    MPI_Bcast(of_root.data(), static_cast<int>(of_root.size()), MPI_CHAR, 0, world.get());
    EXPECT_EQ(all, of_root.c_str()) << "the ranks differ";
    return found;
  }

  core::Communicator world;
  Header header = test::sample_header();
  Records records = test::sample_records(header);
  fs::path folder;
  std::vector<WrittenSegment> listed;
  std::vector<std::string> scenes{"another scene", header.scene};
};

TEST_F(CheckSegments, WholeSegmentsGiveNoCause) {
  EXPECT_THAT(complaints([] {}), IsEmpty());
  std::uint64_t orbits = 0;
  std::uint64_t sections = 0;
  for (int i = 0; i < segments; ++i) {
    const WrittenSegment& segment = listed[static_cast<std::size_t>(i)];
    EXPECT_EQ(segment.name, fmt::format("segment-{}.h5", i));
    EXPECT_EQ(segment.bytes, fs::file_size(path(i)));
    EXPECT_EQ(segment.fingerprint, inspect_segment(path(i)).fingerprint);
    orbits += segment.orbits;
    sections += segment.sections;
  }
  EXPECT_EQ(orbits, records.orbits.size());
  EXPECT_EQ(sections, records.sections.size());
}

TEST_F(CheckSegments, NoSegmentsAreFine) {
  listed.clear();
  EXPECT_THAT(complaints([] {}), IsEmpty());
}

TEST_F(CheckSegments, MissingTornAndForeignSegmentsAreNamedInTheirOrder) {
  const auto found = complaints([&] {
    fs::remove(path(4));
    fs::resize_file(path(3), fs::file_size(path(3)) - 1);
    std::ofstream(path(1), std::ios::trunc) << "something else";
    fs::remove(path(0));
    fs::create_directory(path(0));
  });
  const auto bytes = [&](std::size_t i, std::uint64_t now) {
    return fmt::format("segment-{}.h5' has {} bytes; {} were written", i, now, listed[i].bytes);
  };
  ASSERT_THAT(found, ElementsAre(HasSubstr("segment-0.h5' is a folder"), HasSubstr(bytes(1, 14)),
                                 HasSubstr(bytes(3, listed[3].bytes - 1)), HasSubstr("segment-4.h5' does not exist")));
}

// The same length, other bytes: torn in its middle.
TEST_F(CheckSegments, ASegmentOverwrittenInPlaceIsNamed) {
  const auto found = complaints([&] {
    for (const int segment : {0, 2}) {
      std::fstream file(path(segment), std::ios::in | std::ios::out | std::ios::binary);
      const std::string zeros(segment == 0 ? 64 : static_cast<std::size_t>(fs::file_size(path(2))), '\0');
      file.write(zeros.data(), static_cast<std::streamsize>(zeros.size()));
    }
  });
  ASSERT_THAT(found, ElementsAre(HasSubstr("segment-0.h5' is not an HDF5 file"), HasSubstr("segment-2.h5'")));
}

TEST_F(CheckSegments, ExchangedSegmentsAreNamedEvenIfTheyAreOfEqualLength) {
  Records one;
  Records two;
  if (world.is_root()) one.orbits.assign(1, records.orbits[0]);
  if (world.is_root()) two.orbits.assign(1, records.orbits[0]);
  for (OrbitRecord& orbit : two.orbits) ++orbit.step;
  listed[1] = write_segment(world.get(), path(1), header, one);
  listed[3] = write_segment(world.get(), path(3), header, two);
  ASSERT_EQ(listed[1].bytes, listed[3].bytes);
  EXPECT_THAT(complaints([] {}), IsEmpty());
  const auto exchange = [&](int a, int b) {
    fs::rename(path(a), folder / "between");
    fs::rename(path(b), path(a));
    fs::rename(folder / "between", path(b));
  };
  const auto found = complaints([&] { exchange(1, 3); });
  EXPECT_THAT(found, ElementsAre(AllOf(HasSubstr("segment-1.h5'"), HasSubstr("other orbits")),
                                 AllOf(HasSubstr("segment-3.h5'"), HasSubstr("other orbits"))));
  EXPECT_THAT(complaints([&] {
                exchange(1, 3);
                exchange(0, 2);
              }),
              ElementsAre(HasSubstr("segment-0.h5'"), HasSubstr("segment-2.h5'")));
}

TEST_F(CheckSegments, ASegmentOfAnotherSceneIsNamed) {
  Header other = header;
  other.scene.back() = '#';
  listed[2] = write_segment(world.get(), path(2), other, {});
  EXPECT_THAT(complaints([] {}), ElementsAre(HasSubstr("segment-2.h5' was written for another scene")));
  scenes.push_back(other.scene);
  EXPECT_THAT(complaints([] {}), IsEmpty());
}

TEST_F(CheckSegments, OtherNumbersOfRowsAreNamed) {
  listed[1].orbits += 1;
  listed[2].sections += 1;
  EXPECT_THAT(complaints([] {}), ElementsAre(HasSubstr(fmt::format("holds {} orbits", listed[1].orbits - 1)),
                                             HasSubstr(fmt::format("and {} were written", listed[2].sections))));
}

// What a segment is does not depend on how many ranks wrote it, nor on the order of its rows.
TEST_F(CheckSegments, AFingerprintIsThatOfTheRowsInAnyOrder) {
  const Records share = test::deal(records, world.rank(), world.size(), 5);
  const WrittenSegment together = write_segment(world.get(), path(0), header, share);
  Records reversed;
  if (world.is_root()) reversed.orbits.assign(records.orbits.rbegin(), records.orbits.rend());
  EXPECT_EQ(write_segment(world.get(), path(1), header, reversed).fingerprint, together.fingerprint);
  if (world.is_root()) reversed.orbits.back().period += 1e-12;
  EXPECT_NE(write_segment(world.get(), path(1), header, reversed).fingerprint, together.fingerprint);
}

}  // namespace
}  // namespace check_segments_test
