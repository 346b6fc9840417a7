#include "orbweaver/core/mpi/collective.hpp"

#include <algorithm>
#include <cstdint>
#include <functional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>

#include "orbweaver/core/error.hpp"
#include "orbweaver/core/mpi/communicator.hpp"

namespace orbweaver::core::collective_test {
namespace {

/// Type and text of what `body` throws on this rank.
template <class Body>
std::pair<FailureKind, std::string> thrown(Body&& body) {
  const Failure failure = attempt(body);
  return {failure.kind, failure.text};
}

struct Case {
  FailureKind kind;
  std::function<void(const std::string&)> fail;
};

const std::vector<Case>& cases() {
  static const std::vector<Case> all{
      {FailureKind::input, [](const std::string& text) { throw InputError(text); }},
      {FailureKind::newer_version, [](const std::string& text) { throw NewerVersionError(text); }},
      {FailureKind::environment, [](const std::string& text) { throw EnvironmentError(text); }},
      {FailureKind::numerical, [](const std::string& text) { throw NumericalError(text); }},
      {FailureKind::not_finite, [](const std::string& text) { throw NotFiniteError(text); }},
  };
  return all;
}

TEST(Collective, EveryTypeOfErrorCrossesRanksWithItsText) {
  const Communicator comm;
  for (const Case& c : cases()) {
    const auto work = [&] {
      if (comm.rank() == comm.size() - 1) c.fail("of the last rank");
    };
    EXPECT_EQ(thrown([&] { collectively(comm.get(), work); }), std::pair(c.kind, std::string("of the last rank")));
  }
}

TEST(Collective, AMisuseKeepsThePlaceInItsText) {
  const Communicator comm;
  const auto [kind, text] = thrown([&] {
    collectively(comm.get(), [&] {
      if (comm.rank() == comm.size() - 1) throw MisuseError("wrong call");
    });
  });
  EXPECT_EQ(kind, FailureKind::misuse);
  EXPECT_THAT(text, ::testing::StartsWith("wrong call (in "));
  EXPECT_EQ(text.find("(in "), text.rfind("(in "));
  EXPECT_EQ(agreed(comm.get(), text), text);
}

TEST(Collective, WhatIsNoErrorOfOursIsTheEnvironmentsElsewhere) {
  const Communicator comm;
  const bool fails = comm.rank() == comm.size() - 1;
  for (const std::function<void()>& work :
       std::vector<std::function<void()>>{[] { throw std::runtime_error("of the library"); }, [] { throw 7; }}) {
    const FailureKind kind = thrown([&] {
                               collectively(comm.get(), [&] {
                                 if (fails) work();
                               });
                             }).first;
    EXPECT_EQ(kind, fails ? FailureKind::other : FailureKind::environment);
  }
}

TEST(Collective, TheLowestRankSpeaks) {
  const Communicator comm;
  const auto work = [&] { throw InputError("rank " + std::to_string(comm.rank())); };
  EXPECT_EQ(thrown([&] { collectively(comm.get(), work); }).second, "rank 0");
  const auto all_but_root = [&] {
    if (comm.rank() > 0) work();
  };
  const std::string expected = comm.size() > 1 ? "rank 1" : "";
  EXPECT_EQ(thrown([&] { collectively(comm.get(), all_but_root); }).second, expected);
  const auto shared = share(comm.get(), attempt(all_but_root));
  EXPECT_EQ(shared.has_value(), comm.size() > 1);
  if (!shared) return;
  EXPECT_EQ(shared->rank, 1);
  EXPECT_EQ(static_cast<bool>(shared->failure.error), comm.rank() == 1);
}

TEST(Collective, NobodyFailsWhereNothingWasThrown) {
  const Communicator comm;
  int runs = 0;
  EXPECT_NO_THROW(collectively(comm.get(), [&] { ++runs; }));
  EXPECT_EQ(runs, 1);
  EXPECT_THROW(raise({}), MisuseError);
}

TEST(Collective, TheRootWorksAlone) {
  const Communicator comm;
  int runs = 0;
  on_root(comm.get(), [&] { ++runs; });
  EXPECT_EQ(runs, comm.is_root() ? 1 : 0);
  EXPECT_EQ(thrown([&] { on_root(comm.get(), [] { throw InputError("bad folder"); }); }),
            std::pair(FailureKind::input, std::string("bad folder")));
}

TEST(Collective, AllHaveTheRootsAnswer) {
  const Communicator comm;
  enum class Choice { left, right };
  EXPECT_EQ(agreed(comm.get(), comm.is_root()), true);
  EXPECT_EQ(agreed(comm.get(), comm.rank() + 5UL), 5UL);
  EXPECT_EQ(agreed(comm.get(), comm.is_root() ? Choice::right : Choice::left), Choice::right);
  EXPECT_EQ(agreed(comm.get(), std::string(comm.is_root() ? 3 : 0, 'x')), "xxx");
  std::vector<std::string> texts;
  if (comm.is_root()) texts = {"a", "", "bcd"};
  EXPECT_THAT(agreed(comm.get(), texts), ::testing::ElementsAre("a", "", "bcd"));
}

TEST(Collective, RanksAddUp) {
  const Communicator comm;
  const auto rank = static_cast<std::uint64_t>(comm.rank());
  const auto size = static_cast<std::uint64_t>(comm.size());
  const Share share = share_of(comm.get(), 2);
  EXPECT_EQ(share.first, 2 * rank);
  EXPECT_EQ(share.total, 2 * size);
  EXPECT_EQ(greatest(comm.get(), rank), size - 1);
  const std::vector<int> rows = gather_rows(comm.get(), std::vector<int>(rank, comm.rank()));
  EXPECT_EQ(rows.size(), size * (size - 1) / 2);
  EXPECT_TRUE(std::is_sorted(rows.begin(), rows.end()));
}

TEST(Collective, NobodyWaitsForARankWithoutMemory) {
  const Communicator comm;
  const int row = comm.rank();
  std::vector<int> all;
  const bool last = comm.rank() == comm.size() - 1;
  const auto allocate = [&](std::size_t rows) -> void* {
    if (last) throw std::bad_alloc();
    all.resize(rows);
    return all.data();
  };
  if (last)
    EXPECT_THROW(detail::gather_bytes(comm.get(), &row, 1, sizeof row, allocate), std::bad_alloc);
  else
    EXPECT_THROW(detail::gather_bytes(comm.get(), &row, 1, sizeof row, allocate), EnvironmentError);
}

}  // namespace
}  // namespace orbweaver::core::collective_test
