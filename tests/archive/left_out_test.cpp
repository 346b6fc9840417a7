#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "archive/sample.hpp"
#include "orbweaver/archive/read/reader.hpp"
#include "orbweaver/archive/write/consolidate.hpp"
#include "orbweaver/archive/write/segment.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/core/mpi/communicator.hpp"

namespace left_out_test {
namespace {

using namespace orbweaver;
using namespace orbweaver::archive;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

class LeftOut : public ::testing::Test {
 protected:
  // The atlas of the ranks' shares of `rows`, in two segments, under `tables`.
  [[nodiscard]] std::filesystem::path write(const std::string& name, const Records& rows, const Records& tables) const {
    const std::filesystem::path folder = test::fresh_folder(name, world.get());
    const std::vector<std::filesystem::path> segments{folder / "a.h5", folder / "b.h5"};
    for (int i = 0; i < 2; ++i)
      write_segment(world.get(), segments[static_cast<std::size_t>(i)], header,
                    test::deal(rows, 2 * world.rank() + i, 2 * world.size(), 7));
    consolidate(world.get(), segments, folder / "atlas.h5", header,
                world.is_root() ? test::tables_of(tables) : Records{});
    return folder / "atlas.h5";
  }

  // As it would be had the rows that `drop(key, step)` names never been there.
  template <class Drop>
  [[nodiscard]] std::filesystem::path write_without(const std::string& name, const Drop& drop) const {
    Records less = records;
    std::erase_if(less.orbits, [&](const OrbitRecord& o) { return drop(o.family_key, o.step); });
    std::erase_if(less.sections, [&](const SectionRecord& s) { return drop(s.family_key, s.step); });
    return write(name, less, less);
  }

  core::Communicator world;
  Header header = test::sample_header();
  Records records = test::sample_records(header);
};

FamilyRecord& family(Records& records, const std::string& key) {
  return *std::find_if(records.families.begin(), records.families.end(),
                       [&](const FamilyRecord& f) { return f.key == key; });
}

TEST_F(LeftOut, RowsBeyondTheStepsOfAFamilyAreNotInTheArchive) {
  Records cut = records;
  family(cut, "0001").last_step = 6;
  family(cut, "0003").first_step = -2;
  family(cut, "0003").last_step = 3;
  family(cut, "0003.0001").first_step = 6;  // beyond its last: no orbit is left
  const auto atlas = write("cut", records, cut);
  const auto expected = write_without("cut_before", [](const std::string& key, int step) {
    if (key == "0001") return step > 6;
    if (key == "0003") return step < -2 || step > 3;
    return key == "0003.0001";
  });
  EXPECT_TRUE(test::dataset_bytes(atlas) == test::dataset_bytes(expected));
  const Archive read(atlas);
  EXPECT_THAT(read.families().integers("orbit_count"), ElementsAre(7, 3, 0, 6, 0));
  EXPECT_THAT(read.families().integers("first_orbit"), ElementsAre(0, 7, 10, 10, 16));
  EXPECT_EQ(read.orbits().integers("step")[10], -2) << "the first orbit has the least step";
}

TEST_F(LeftOut, FamiliesThatAreLeftOutLeaveNoRows) {
  Records less = records;
  std::erase_if(less.families, [](const FamilyRecord& f) { return f.key == "0003.0001"; });
  less.left_out_keys = {"0003.0001", "0001.0007"};
  Records more = records;  // a family that never was in the tables
  for (OrbitRecord orbit : records.orbits) {
    if (orbit.family_key != "0001.0002") continue;
    orbit.family_key = "0001.0007";
    more.orbits.push_back(orbit);
    more.sections.push_back({orbit.family_key, orbit.step, 0.5, {1, 2}});
  }
  const auto atlas = write("dropped", more, less);
  std::erase_if(records.families, [](const FamilyRecord& f) { return f.key == "0003.0001"; });
  const auto expected = write_without("dropped_before", [](const std::string& key, int) { return key == "0003.0001"; });
  EXPECT_TRUE(test::dataset_bytes(atlas) == test::dataset_bytes(expected));
  EXPECT_EQ(Archive(atlas).families().rows(), 4u);
}

TEST_F(LeftOut, AnOrbitOfAFamilyThatIsNeitherListedNorLeftOutIsRefused) {
  Records less = records;
  std::erase_if(less.families, [](const FamilyRecord& f) { return f.key == "0003.0001"; });
  less.left_out_keys = {"0003.0002"};
  try {
    static_cast<void>(write("neither", records, less));
    ADD_FAILURE() << "it was archived";
  } catch (const core::InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("rows of family '0003.0001'"));
  }
}

TEST_F(LeftOut, NothingMayReferToAFamilyThatIsLeftOut) {
  const auto refusal = [&](const auto& change) -> std::string {
    Records tables = records;
    change(tables);
    try {
      static_cast<void>(write("references", records, tables));
    } catch (const core::MisuseError& error) {
      return error.what();
    }
    return "it was archived";
  };
  const auto leave_out = [](Records& t, const std::string& key) {
    std::erase_if(t.families, [&](const FamilyRecord& f) { return f.key == key; });
    t.left_out_keys.push_back(key);
  };
  EXPECT_THAT(refusal([&](Records& t) {
                leave_out(t, "0003");
                std::erase_if(t.crossings, [](const CrossingRecord& c) { return c.family_key == "0003"; });
                for (FamilyRecord& f : t.families) f.crossing = f.end_crossing = -1;
              }),
              HasSubstr("parent_key '0003'"));
  EXPECT_THAT(refusal([&](Records& t) { leave_out(t, "0001.0002"); }), HasSubstr("end_family_key '0001.0002'"));
  EXPECT_THAT(refusal([&](Records& t) {
                leave_out(t, "0001");
                for (FamilyRecord& f : t.families)
                  if (f.parent_key == "0001") f.parent_key.clear();
              }),
              HasSubstr("family_key '0001'"))
      << "its crossings must go with it";
}

// A side does not know how far the other side's first orbit lies from the birth.
TEST_F(LeftOut, OrbitsBehindABirthStandFromIt) {
  Records born = records;
  family(born, "0003").birth_arclength = -0.375;
  const Archive from(write("born", born, born));
  const Archive otherwise(write("born_nowhere", records, records));
  EXPECT_THAT(std::vector(from.orbits().reals("arclength").begin() + 15, from.orbits().reals("arclength").begin() + 21),
              ElementsAre(-1.375, -1.125, -0.875, -0.625, 0.0, 0.25));
  EXPECT_EQ(otherwise.orbits().reals("arclength")[15], -1.0);
  EXPECT_EQ(from.families().reals("birth_arclength")[3], -0.375);
  EXPECT_TRUE(std::isnan(otherwise.families().reals("birth_arclength")[3]));
}

// Three generations; the youngest goes back to a crossing of the eldest on its side of negative steps.
TEST_F(LeftOut, ATreeOfFamiliesComesBackWithAllItsReferences) {
  Records tree = records;
  family(tree, "0003.0001").last_step = 3;
  FamilyRecord youngest = family(tree, "0003.0001");
  youngest.key = "0003.0001.0001";
  youngest.name = "youngest";
  youngest.parent_key = "0003.0001";
  youngest.multiplicity = 3;
  youngest.end_family_key = "0003";
  const auto add_crossing = [&](const char* key, double arclength, CrossingKind kind) {
    CrossingRecord crossing = records.crossings.front();
    crossing.family_key = key;
    crossing.arclength = arclength;
    crossing.kind = kind;
    tree.crossings.push_back(crossing);
    return static_cast<int>(tree.crossings.size()) - 1;
  };
  youngest.end_crossing = add_crossing("0003", -0.75, CrossingKind::krein);
  youngest.crossing = add_crossing("0003.0001", 0.5, CrossingKind::subharmonic);
  tree.families.insert(tree.families.begin(), youngest);
  OrbitRecord orbit = records.orbits.back();
  orbit.family_key = youngest.key;
  tree.orbits.push_back(orbit);
  const Archive atlas(write("tree", tree, tree));
  const Table& families = atlas.families();
  EXPECT_THAT(families.integers("parent"), ElementsAre(-1, 0, -1, -1, 3, 4));
  EXPECT_THAT(families.integers("crossing"), ElementsAre(-1, 1, -1, -1, 3, 4));
  EXPECT_THAT(families.integers("end_family"), ElementsAre(-1, -1, -1, -1, 1, 3));
  EXPECT_THAT(families.integers("end_crossing"), ElementsAre(-1, -1, -1, -1, 0, 2));
  EXPECT_THAT(families.integers("multiplicity"), ElementsAre(1, 1, 1, 1, 2, 3));
  EXPECT_THAT(families.integers("orbit_count"), ElementsAre(12, 3, 0, 9, 3, 1));
  EXPECT_THAT(atlas.crossings().integers("family"), ElementsAre(0, 0, 3, 3, 4));
  EXPECT_THAT(atlas.crossings().reals("arclength"), ElementsAre(0.5, 2.5, -0.75, 1.5, 0.5));
  EXPECT_EQ(atlas.crossings().texts("kind")[2], "krein");
}

}  // namespace
}  // namespace left_out_test
