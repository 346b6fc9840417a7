#include <gmock/gmock.h>

#include <sys/resource.h>

#include <array>
#include <csignal>
#include <fstream>
#include <limits>

#include <fmt/format.h>

#include "archive/sample.hpp"
#include "orbweaver/archive/write/consolidate.hpp"
#include "orbweaver/archive/write/segment.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/core/mpi/communicator.hpp"

namespace failures_test {
namespace {

using namespace orbweaver;
using namespace orbweaver::archive;
using ::testing::HasSubstr;

// No file of this process may grow beyond `bytes`: as good as a full disk, for root too.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) : _handler(std::signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &_before);
    rlimit now = _before;
    now.rlim_cur = bytes;
    setrlimit(RLIMIT_FSIZE, &now);
  }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;
  ~FileSizeLimit() {
    setrlimit(RLIMIT_FSIZE, &_before);
    std::signal(SIGXFSZ, _handler);
  }

 private:
  rlimit _before{};
  void (*_handler)(int);
};

class Failures : public ::testing::Test {
 protected:
  // The rank's share of the sample.
  [[nodiscard]] Records mine() const { return test::deal(records, world.rank(), world.size(), 5); }

  // Runs `work` on all ranks and expects the same `Expected` everywhere; returns its text.
  template <class Expected, class Work>
  std::string failure_of(const Work& work) {
    std::string text;
    try {
      work();
      ADD_FAILURE() << "rank " << world.rank() << " met no error";
    } catch (const Expected& error) {
      text = error.what();
    }
    std::array<char, 1024> first{};
    text.copy(first.data(), first.size() - 1);
    MPI_Bcast(first.data(), static_cast<int>(first.size()), MPI_CHAR, 0, world.get());
    EXPECT_EQ(text.substr(0, first.size() - 1), first.data());
    return text;
  }

  template <class Change>
  std::string refusal_of(const Change& change) {
    const std::filesystem::path folder = test::fresh_folder("refused", world.get());
    Records changed = mine();
    if (world.rank() == world.size() - 1) change(changed);
    const std::string text =
        failure_of<core::MisuseError>([&] { write_segment(world.get(), folder / "s.h5", header, changed); });
    EXPECT_TRUE(std::filesystem::is_empty(folder));
    return text;
  }

  core::Communicator world;
  Header header = test::sample_header();
  Records records = test::sample_records(header);
};

OrbitRecord& some_orbit(Records& records) {
  records.orbits.resize(1, test::sample_records(test::sample_header()).orbits.front());
  return records.orbits.front();
}

TEST_F(Failures, AnInvalidRecordOfOneRankIsRefusedByAll) {
  EXPECT_THAT(refusal_of([](Records& r) { some_orbit(r).modes.pop_back(); }), HasSubstr("modes holds"));
  EXPECT_THAT(refusal_of([](Records& r) { some_orbit(r).family_key.clear(); }), HasSubstr("family key is empty"));
  EXPECT_THAT(refusal_of([](Records& r) { some_orbit(r).modes[0] = std::numeric_limits<double>::infinity(); }),
              HasSubstr("modes is inf"));
  EXPECT_THAT(refusal_of([](Records& r) { some_orbit(r).period = not_computed; }), HasSubstr("period is nan"));
  EXPECT_THAT(refusal_of([](Records& r) { some_orbit(r).stability.assign(2, 0.0); }), HasSubstr("stability holds 2"));
  EXPECT_THAT(refusal_of([](Records& r) { some_orbit(r).state.clear(); }), HasSubstr("state holds 0"));
  EXPECT_THAT(refusal_of([](Records& r) { some_orbit(r).winding.assign(3, 1.0); }), HasSubstr("winding holds 3"));
  EXPECT_THAT(refusal_of([](Records& r) { some_orbit(r).cutoff = -1; }), HasSubstr("cutoff is -1"));
  EXPECT_THAT(refusal_of([](Records& r) { some_orbit(r).family_key = "\xff\xfe"; }), HasSubstr("UTF-8"));
  EXPECT_THAT(refusal_of([](Records& r) { r.families.resize(1); }), HasSubstr("consolidate"));
  EXPECT_THAT(refusal_of([](Records& r) { r.left_out_keys = {"0001"}; }), HasSubstr("consolidate"));
  EXPECT_THAT(refusal_of([](Records& r) { r.voided = {{"0001", 0, 1, 0}}; }), HasSubstr("consolidate"));
  EXPECT_THAT(refusal_of([](Records& r) {
                r.sections.assign(1, {"0001", 0, not_computed, {0, 0}});
              }),
              HasSubstr("time is nan"));
}

TEST_F(Failures, RanksWithDifferentHeadersAreRefused) {
  if (world.size() == 1) return;
  const std::filesystem::path folder = test::fresh_folder("headers", world.get());
  Header own = header;
  own.scene += std::to_string(world.rank());
  const std::string text =
      failure_of<core::MisuseError>([&] { write_segment(world.get(), folder / "s.h5", own, mine()); });
  EXPECT_THAT(text, HasSubstr("different headers"));
}

TEST_F(Failures, AMissingFolderIsReportedByAllRanks) {
  const std::string text =
      failure_of<core::EnvironmentError>([&] { write_segment(world.get(), "no/such/folder/s.h5", header, mine()); });
  EXPECT_THAT(text, HasSubstr("no/such/folder/s.h5.part"));
  EXPECT_THAT(text, HasSubstr("No such file or directory"));
}

TEST_F(Failures, AFolderThatIsAFileIsReportedByAllRanks) {
  const std::filesystem::path folder = test::fresh_folder("file_as_folder", world.get());
  if (world.is_root()) std::ofstream(folder / "file") << "no folder";
  MPI_Barrier(world.get());
  const auto write = [&] { consolidate(world.get(), {}, folder / "file" / "atlas.h5", header, {}); };
  EXPECT_THAT(failure_of<core::EnvironmentError>(write), HasSubstr("Not a directory"));
}

TEST_F(Failures, ATargetThatIsAFolderCannotBeReplaced) {
  const std::filesystem::path folder = test::fresh_folder("target", world.get());
  if (world.is_root()) std::filesystem::create_directories(folder / "s.h5" / "inside");
  MPI_Barrier(world.get());
  const auto write = [&] { write_segment(world.get(), folder / "s.h5", header, mine()); };
  EXPECT_THAT(failure_of<core::EnvironmentError>(write), HasSubstr("rename"));
  EXPECT_FALSE(std::filesystem::exists(folder / "s.h5.part"));
}

// The limit on rank 0 is met before HDF5 writes, the limit on the last rank alone in the write itself.
TEST_F(Failures, AFullDiskIsReportedByAllRanksAndLeavesTheOldFile) {
  const std::filesystem::path folder = test::fresh_folder("full_disk", world.get());
  write_segment(world.get(), folder / "s.h5", header, mine());
  const auto size = std::filesystem::file_size(folder / "s.h5");
  const auto before = test::dataset_bytes(folder / "s.h5");
  for (const int limited : {0, world.size() - 1}) {
    // The file ends with what rank 0 writes.
    const std::uintmax_t end = limited == 0 ? 64 : 2048;
    for (const std::uintmax_t limit : {std::uintmax_t{0}, std::uintmax_t{600}, size / 2, size - end}) {
      if (limit == 0 && limited != 0) continue;  // Open MPI itself needs small files
      SCOPED_TRACE(fmt::format("limit {} of {} bytes on rank {}", limit, size, limited));
      MPI_Barrier(world.get());
      const std::string text = failure_of<core::EnvironmentError>([&] {
        const FileSizeLimit small(world.rank() == limited ? limit : RLIM_INFINITY);
        write_segment(world.get(), folder / "s.h5", header, mine());
      });
      EXPECT_THAT(text, HasSubstr("s.h5.part"));
      EXPECT_TRUE(test::dataset_bytes(folder / "s.h5") == before);
      EXPECT_FALSE(std::filesystem::exists(folder / "s.h5.part"));
    }
  }
  write_segment(world.get(), folder / "s.h5", header, mine());
  EXPECT_TRUE(test::dataset_bytes(folder / "s.h5") == before);
}

TEST_F(Failures, AFullDiskAmidLargeModesIsReportedByAllRanks) {
  const std::filesystem::path folder = test::fresh_folder("large_full_disk", world.get());
  Records large;
  large.orbits.assign(8, records.orbits.front());
  for (std::size_t i = 0; i < large.orbits.size(); ++i) {
    large.orbits[i].step = static_cast<int>(i) + 100 * world.rank();
    large.orbits[i].cutoff = 1 << 17;
    large.orbits[i].modes.assign(((std::size_t{2} << 17) + 1) * 2, 1.0);
  }
  failure_of<core::EnvironmentError>([&] {
    const FileSizeLimit small(world.rank() == world.size() - 1 ? 12 << 20 : RLIM_INFINITY);
    write_segment(world.get(), folder / "s.h5", header, large);
  });
  EXPECT_TRUE(std::filesystem::is_empty(folder));
}

TEST_F(Failures, InvalidTablesAreRefusedByAllRanks) {
  const std::filesystem::path folder = test::fresh_folder("tables", world.get());
  const auto refusal = [&](const auto& change) {
    Records tables = test::tables_of(records);
    change(tables);
    return failure_of<core::MisuseError>(
        [&] { consolidate(world.get(), {}, folder / "atlas.h5", header, world.is_root() ? tables : Records{}); });
  };
  EXPECT_THAT(refusal([](Records& t) { t.families[0].crossing = 3; }), HasSubstr("crossing is 3"));
  EXPECT_THAT(refusal([](Records& t) { t.families[0].end_crossing = -2; }), HasSubstr("end_crossing is -2"));
  EXPECT_THAT(refusal([](Records& t) { t.families[1].key = t.families[0].key; }), HasSubstr("same key"));
  EXPECT_THAT(refusal([](Records& t) { t.families[0].parent_key = "9"; }), HasSubstr("parent_key '9'"));
  EXPECT_THAT(refusal([](Records& t) { t.families[0].end_family_key = "9"; }), HasSubstr("end_family_key '9'"));
  EXPECT_THAT(refusal([](Records& t) { t.families[0].end_reason.clear(); }), HasSubstr("end_reason"));
  EXPECT_THAT(refusal([](Records& t) {
                t.families[0].first_step = 3;
                t.families[0].last_step = 2;
              }),
              HasSubstr("steps end at 2 before they begin at 3"));
  EXPECT_THAT(refusal([](Records& t) { t.left_out_keys = {"9", "0003"}; }), HasSubstr("left out too"));
  EXPECT_THAT(refusal([](Records& t) {
                t.voided = {{"0003", 3, 2, 0}};
              }),
              HasSubstr("steps end at 2 before they begin at 3"));
  EXPECT_THAT(refusal([](Records& t) { t.voided = {{"0003", 0, 2, 1}}; }), HasSubstr("before_segment is 1; 0 ... 0"));
  EXPECT_THAT(refusal([](Records& t) { t.voided = {{"", 0, 2, 0}}; }), HasSubstr("family key is empty"));
  EXPECT_THAT(refusal([](Records& t) { t.crossings[0].family_key = "9"; }), HasSubstr("family_key '9'"));
  EXPECT_THAT(refusal([](Records& t) { t.crossings[0].arclength = not_computed; }), HasSubstr("arclength is nan"));
  EXPECT_THAT(refusal([&](Records& t) { t.orbits = records.orbits; }), HasSubstr("write_segment"));
  EXPECT_TRUE(std::filesystem::is_empty(folder));
}

TEST_F(Failures, ASceneThatDoesNotFitIsTheUsersError) {
  Header large = header;
  large.scene.assign(70000, 'x');
  const auto write = [&] { consolidate(world.get(), {}, "scene.h5", large, {}); };
  EXPECT_THAT(failure_of<core::InputError>(write), HasSubstr("70000 bytes"));
}

TEST_F(Failures, SegmentsThatDoNotFitTogetherAreRefusedByAllRanks) {
  const std::filesystem::path folder = test::fresh_folder("segments", world.get());
  write_segment(world.get(), folder / "a.h5", header, mine());
  Header other = header;
  other.scene += "# changed\n";
  write_segment(world.get(), folder / "b.h5", other, {});
  Records section;
  if (world.is_root()) section.sections.assign(1, {"0001", 77, 0.5, {0, 0}});
  write_segment(world.get(), folder / "c.h5", header, section);
  const auto refusal = [&](const std::vector<std::filesystem::path>& segments, const Records& tables) {
    return failure_of<core::InputError>(
        [&] { consolidate(world.get(), segments, folder / "atlas.h5", header, tables); });
  };
  const Records tables = test::tables_of(records);
  EXPECT_THAT(refusal({folder / "a.h5", folder / "a.h5"}, tables), HasSubstr("stands twice"));
  EXPECT_THAT(refusal({folder / "a.h5", folder / "b.h5"}, tables), HasSubstr("another scene"));
  EXPECT_THAT(refusal({folder / "a.h5", folder / "c.h5"}, tables), HasSubstr("orbit 77 of family '0001'"));
  EXPECT_THAT(refusal({folder / "a.h5", folder / "d.h5"}, tables), HasSubstr("does not exist"));
  EXPECT_THAT(refusal({folder / "a.h5"}, {}), HasSubstr("not among the families"));
  EXPECT_FALSE(std::filesystem::exists(folder / "atlas.h5"));
}

}  // namespace
}  // namespace failures_test
