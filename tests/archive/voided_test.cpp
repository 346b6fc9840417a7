#include <gmock/gmock.h>

#include "archive/sample.hpp"
#include "orbweaver/archive/read/reader.hpp"
#include "orbweaver/archive/write/consolidate.hpp"
#include "orbweaver/archive/write/segment.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/core/mpi/communicator.hpp"

namespace voided_test {
namespace {

using namespace orbweaver;
using namespace orbweaver::archive;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

// Three segments: the sample dealt to two as a first run left it, and what a run with wider limits added.
class Voided : public ::testing::Test {
 protected:
  void begin(const std::string& name) { folder = test::fresh_folder(name, world.get()); }

  [[nodiscard]] std::vector<std::filesystem::path> write_segments(const Records& old, const Records& later) const {
    const std::vector<std::filesystem::path> segments{folder / "a.h5", folder / "b.h5", folder / "c.h5"};
    for (int i = 0; i < 2; ++i)
      write_segment(world.get(), segments[static_cast<std::size_t>(i)], old_header,
                    test::deal(old, 2 * world.rank() + i, 2 * world.size(), 7));
    write_segment(world.get(), segments[2], header, test::deal(later, world.rank(), world.size(), 3));
    return segments;
  }

  std::filesystem::path write(const Records& old, const Records& later, const Records& tables) const {
    consolidate(world.get(), write_segments(old, later), folder / "atlas.h5", header,
                world.is_root() ? test::tables_of(tables) : Records{});
    return folder / "atlas.h5";
  }

  // The rows of `records` that `keep(key, step)` names, with `shift` added to their arclengths.
  template <class Keep>
  [[nodiscard]] Records some(const Keep& keep, double shift) const {
    Records rows = test::rows_of(records);
    std::erase_if(rows.orbits, [&](const OrbitRecord& o) { return !keep(o.family_key, o.step); });
    std::erase_if(rows.sections, [&](const SectionRecord& s) { return !keep(s.family_key, s.step); });
    for (OrbitRecord& orbit : rows.orbits) orbit.arclength += shift;
    for (SectionRecord& section : rows.sections) section.time += shift;
    return rows;
  }

  static Records joined(Records first, const Records& second) {
    first.orbits.insert(first.orbits.end(), second.orbits.begin(), second.orbits.end());
    first.sections.insert(first.sections.end(), second.sections.begin(), second.sections.end());
    return first;
  }

  core::Communicator world;
  std::filesystem::path folder;
  Header header = test::sample_header();
  Header old_header = header;
  Records records = test::sample_records(header);
};

bool is_computed_again(const std::string& key, int step) {
  return (key == "0001" && step >= 8) || (key == "0003" && (step <= -3 || step >= 4)) || key == "0003.0001";
}

Records with_voided(Records tables, int before_segment) {
  tables.voided = {{"0003", 4, 4, before_segment},
                   {"0001", 8, 1000, before_segment},
                   {"0003.0001", std::numeric_limits<int>::min(), std::numeric_limits<int>::max(), before_segment},
                   {"0003", -7, -3, before_segment}};
  return tables;
}

TEST_F(Voided, RowsOfEarlierSegmentsMakeWayForThoseOfALaterOne) {
  const Records later = some(is_computed_again, 0.125);
  begin("as_if_never_there");
  const auto expected = test::dataset_bytes(
      write(some([](const std::string& k, int s) { return !is_computed_again(k, s); }, 0.0), later, records));
  begin("voided");
  const auto atlas = write(records, later, with_voided(records, 2));
  EXPECT_TRUE(test::dataset_bytes(atlas) == expected);
  EXPECT_THAT(Archive(atlas).families().integers("orbit_count"), ElementsAre(12, 3, 0, 9, 5));
  EXPECT_EQ(Archive(atlas).orbits().reals("arclength")[8], 2.125) << "step 8 of the first family is the new one";
}

TEST_F(Voided, RowsWithNothingInTheirPlaceAreGoneWithTheirSections) {
  begin("gone_before");
  const auto expected = test::dataset_bytes(
      write(some([](const std::string& k, int s) { return !is_computed_again(k, s); }, 0.0), {}, records));
  begin("gone");
  const auto atlas = write(records, {}, with_voided(records, 3));
  EXPECT_TRUE(test::dataset_bytes(atlas) == expected);
  EXPECT_THAT(Archive(atlas).families().integers("orbit_count"), ElementsAre(8, 3, 0, 6, 0));
}

TEST_F(Voided, SegmentsFromBeforeSegmentOnKeepTheirRows) {
  begin("kept_before");
  const auto expected = test::dataset_bytes(write(records, {}, records));
  begin("kept");
  EXPECT_TRUE(test::dataset_bytes(write(records, {}, with_voided(records, 0))) == expected);
}

TEST_F(Voided, AFamilyThatIsNoMoreMayHaveVoidedRows) {
  Records less = records;
  std::erase_if(less.families, [](const FamilyRecord& f) { return f.key == "0003.0001"; });
  less.voided = {{"0003.0001", -100, 100, 2}};
  begin("no_more");
  EXPECT_EQ(Archive(write(records, {}, less)).orbits().rows(), 24u);
}

TEST_F(Voided, ARowThatIsNotVoidedStandsTwice) {
  const Records later = some(is_computed_again, 0.125);
  const auto refusal = [&](const Records& tables) -> std::string {
    begin("twice");
    try {
      write(records, later, tables);
    } catch (const core::InputError& error) {
      return error.what();
    }
    return "it was archived";
  };
  Records one_short = with_voided(records, 2);
  one_short.voided[1].first_step = 9;
  EXPECT_THAT(refusal(one_short), AllOf(HasSubstr("orbit 8 of family '0001'"), HasSubstr("stands twice")));
  EXPECT_THAT(refusal(with_voided(records, 1)), HasSubstr("stands twice"));
  EXPECT_THAT(refusal(records), HasSubstr("stands twice"));
}

TEST_F(Voided, SegmentsOfAnEarlierSceneAreTakenWhereItIsListed) {
  const Records later = some(is_computed_again, 0.125);
  begin("one_scene");
  const auto expected = test::dataset_bytes(write(records, later, with_voided(records, 2)));
  old_header.scene += "limits: {period: 10}\n";
  begin("two_scenes");
  Records tables = with_voided(records, 2);
  tables.earlier_scenes = {"another", old_header.scene};
  const auto atlas = write(records, later, tables);
  EXPECT_TRUE(test::dataset_bytes(atlas) == expected);
  EXPECT_EQ(Archive(atlas).header().scene, header.scene);
  tables.earlier_scenes.pop_back();
  EXPECT_THROW(write(records, later, tables), core::InputError);
}

}  // namespace
}  // namespace voided_test
