#include <gmock/gmock.h>

#include "archive/sample.hpp"
#include "orbweaver/archive/read/reader.hpp"
#include "orbweaver/archive/write/consolidate.hpp"
#include "orbweaver/archive/write/segment.hpp"
#include "orbweaver/core/mpi/communicator.hpp"

namespace findings_test {
namespace {

using namespace orbweaver;
using namespace orbweaver::archive;
using ::testing::ElementsAre;

class Findings : public ::testing::Test {
 protected:
  bool write(const Witness& witness) {
    folder = test::fresh_folder("findings", world.get());
    write_segment(world.get(), folder / "a.h5", header, test::deal(records, world.rank(), world.size(), 7));
    return consolidate(world.get(), {folder / "a.h5"}, folder / "atlas.h5", header,
                       world.is_root() ? test::tables_of(records) : Records{}, {}, witness);
  }

  core::Communicator world;
  Header header = test::sample_header();
  Records records = test::sample_records(header);
  std::filesystem::path folder;
};

TEST_F(Findings, AreSaidOfTheWholeFileAndStandInIt) {
  std::size_t seen = 0;
  const auto witness = [&](const std::filesystem::path& path) -> std::optional<std::vector<FindingRecord>> {
    EXPECT_FALSE(std::filesystem::exists(folder / "atlas.h5")) << "not published before";
    seen = Archive(path).orbits().rows();
    if (!world.is_root()) return std::vector<FindingRecord>{};
    return std::vector<FindingRecord>{
        {"contradiction", "duplicate-curve", 2, 4, -1, 5.5, -1.25, 0.75, 1e-9, "the same orbits – twice"},
        {"cut", "limited-end", 1, -1, 0, not_computed, not_computed, not_computed, not_computed, "a limit"}};
  };
  EXPECT_TRUE(write(witness));
  EXPECT_EQ(seen, records.orbits.size()) << "on every rank";
  const Archive atlas(folder / "atlas.h5");
  const Table& findings = atlas.findings();
  EXPECT_THAT(findings.texts("severity"), ElementsAre("contradiction", "cut"));
  EXPECT_THAT(findings.texts("kind"), ElementsAre("duplicate-curve", "limited-end"));
  EXPECT_THAT(findings.texts("text"), ElementsAre("the same orbits – twice", "a limit"));
  EXPECT_THAT(findings.integers("family"), ElementsAre(2, 1));
  EXPECT_THAT(findings.integers("other_family"), ElementsAre(4, -1));
  EXPECT_THAT(findings.integers("crossing"), ElementsAre(-1, 0));
  EXPECT_EQ(findings.reals("period")[0], 5.5);
  EXPECT_EQ(findings.reals("energy")[0], -1.25);
  EXPECT_EQ(findings.reals("parameter")[0], 0.75);
  EXPECT_EQ(findings.reals("deviation")[0], 1e-9);
  EXPECT_EQ(atlas.orbits().rows(), records.orbits.size());
}

TEST_F(Findings, ATableWithoutRowsIsThereWithoutAWitness) {
  EXPECT_TRUE(write({}));
  EXPECT_EQ(Archive(folder / "atlas.h5").findings().rows(), 0U);
  EXPECT_TRUE(test::dataset_bytes(folder / "atlas.h5").contains("findings/text"));
}

TEST_F(Findings, AWitnessThatWasStoppedLeavesNoFile) {
  EXPECT_FALSE(write([](const std::filesystem::path&) { return std::nullopt; }));
  if (!world.is_root()) return;  // who removes it
  EXPECT_FALSE(std::filesystem::exists(folder / "atlas.h5"));
  EXPECT_FALSE(std::filesystem::exists(folder / "atlas.h5.part"));
}

TEST_F(Findings, RowsOfCrossingsAreThoseOfTheFile) {
  EXPECT_TRUE(write({}));
  const Archive atlas(folder / "atlas.h5");
  const std::vector<int> rows = rows_of_crossings(records);
  ASSERT_EQ(rows.size(), records.crossings.size());
  for (std::size_t n = 0; n < rows.size(); ++n)
    EXPECT_EQ(atlas.crossings().reals("period")[static_cast<std::size_t>(rows[n])], records.crossings[n].period);
}

}  // namespace
}  // namespace findings_test
