#include <gtest/gtest.h>

#include <algorithm>
#include <deque>

#include <fmt/format.h>

#include "archive/sample.hpp"
#include "orbweaver/archive/read/reader.hpp"
#include "orbweaver/archive/write/consolidate.hpp"
#include "orbweaver/archive/write/segment.hpp"
#include "orbweaver/core/mpi/communicator.hpp"

namespace same_bytes_test {
namespace {

using namespace orbweaver;
using namespace orbweaver::archive;

// The first `size` ranks; the others get nothing.
class SubCommunicator {
 public:
  explicit SubCommunicator(int size) {
    int rank = 0;
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Comm_split(MPI_COMM_WORLD, rank < size ? 0 : MPI_UNDEFINED, rank, &_comm);
  }
  SubCommunicator(const SubCommunicator&) = delete;
  SubCommunicator& operator=(const SubCommunicator&) = delete;
  ~SubCommunicator() {
    if (_comm != MPI_COMM_NULL) MPI_Comm_free(&_comm);
  }
  [[nodiscard]] bool is_member() const { return _comm != MPI_COMM_NULL; }
  [[nodiscard]] MPI_Comm get() const { return _comm; }

 private:
  MPI_Comm _comm = MPI_COMM_NULL;
};

struct Case {
  int segments;
  unsigned seed;
  std::size_t block_values;
};

std::filesystem::path write_case(MPI_Comm comm, const std::string& folder, const Case& how, const Records& records,
                                 const Header& header) {
  int rank = 0;
  int size = 1;
  MPI_Comm_rank(comm, &rank);
  MPI_Comm_size(comm, &size);
  const std::filesystem::path place = test::fresh_folder(folder, comm);
  std::vector<std::filesystem::path> segments;
  for (int i = 0; i < how.segments; ++i) {
    segments.push_back(place / fmt::format("segment_{}.h5", i));
    const Records mine = test::deal(records, i * size + rank, how.segments * size, how.seed);
    write_segment(comm, segments.back(), header, mine);
  }
  if (how.seed % 2 == 0) std::reverse(segments.begin(), segments.end());
  const Records tables = rank == 0 ? test::tables_of(records) : Records{};
  consolidate(comm, rank == 0 ? segments : decltype(segments){}, place / "atlas.h5", rank == 0 ? header : Header{},
              tables, {how.block_values});
  return place / "atlas.h5";
}

TEST(SameBytes, ForAnyRanksDistributionSegmentsAndBlocks) {
  const core::Communicator world;
  const Header header = test::sample_header();
  const Records records = test::sample_records(header);
  std::deque<SubCommunicator> communicators;  // made before anything can fail on one rank alone
  for (int ranks = 1; ranks <= world.size(); ++ranks) communicators.emplace_back(ranks);
  const std::filesystem::path alone = test::fresh_folder(fmt::format("alone_{}", world.rank()));
  const auto expected = test::dataset_bytes(test::write_sample_atlas(alone, header, records));
  ASSERT_EQ(expected.size(), 12u + 37u + 16u + 4u + 21u + 11u + 13u + 2u + 2u);
  for (int ranks = 1; ranks <= world.size(); ++ranks) {
    const SubCommunicator& some = communicators[static_cast<std::size_t>(ranks - 1)];
    if (!some.is_member()) continue;
    for (const Case& how : {Case{1, 1, 1 << 20}, Case{1, 2, 1}, Case{3, 3, 300}, Case{7, 4, 1000}}) {
      const std::string folder = fmt::format("ranks_{}_segments_{}_seed_{}", ranks, how.segments, how.seed);
      const auto atlas = write_case(some.get(), folder, how, records, header);
      EXPECT_TRUE(test::dataset_bytes(atlas) == expected) << folder;
      EXPECT_NO_THROW(Archive{atlas});
      EXPECT_FALSE(std::filesystem::exists(atlas.string() + ".part"));
    }
  }
}

TEST(SameBytes, TheOrderOfFamiliesAndCrossingsDoesNotMatter) {
  const core::Communicator world;
  const Header header = test::sample_header();
  Records records = test::sample_records(header);
  const std::string folder = fmt::format("order_{}", world.rank());
  const auto expected = test::dataset_bytes(test::write_sample_atlas(test::fresh_folder(folder), header, records));
  std::reverse(records.families.begin(), records.families.end());
  std::reverse(records.crossings.begin(), records.crossings.end());
  for (FamilyRecord& family : records.families) {
    if (family.crossing >= 0) family.crossing = 2 - family.crossing;
    if (family.end_crossing >= 0) family.end_crossing = 2 - family.end_crossing;
  }
  EXPECT_TRUE(test::dataset_bytes(test::write_sample_atlas(test::fresh_folder(folder), header, records)) == expected);
}

}  // namespace
}  // namespace same_bytes_test
