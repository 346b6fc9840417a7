#include <gmock/gmock.h>

#include <cmath>
#include <cstdint>
#include <cstring>

#include <sys/resource.h>

#include "orbweaver/core/error.hpp"
#include "state/branch_state.hpp"
#include "state/checkpoint.hpp"
#include "support/serialized.hpp"
#include "tasks/payload/payload.hpp"
#include "tasks/payload/work.hpp"
#include "witness/loop_question.hpp"

namespace orbweaver::test {

/// The matrix is looked up where the element is received.
template <>
inline constexpr int kept_members<loop::SymmetryElement> = 1;

}  // namespace orbweaver::test

namespace orbweaver::loop {

/// Loops are checked when they are read.
void fill(test::Filler& filler, Loop& loop) {
  loop.serialize(filler, 0);
  loop.dimension = 2;
  loop.cutoff = 1;
  loop.period = 5e-324;
  loop.modes = {-0.0, 5e-324, 1.7e308, -1.0 / 3.0, 0.0, 1e-17};
  loop.winding = {-0.0, 1e9};
  loop.time_map = {2.0 / 3.0, {-0.0, 1e-300}};
  loop.parameters = {-0.0};
}

}  // namespace orbweaver::loop

namespace orbweaver::survey {

/// So are the numbers of files.
void fill(test::Filler& filler, StoredWork& work) {
  work.serialize(filler, 0);
  work.file = StoredWork::most_files - 1;
}

}  // namespace orbweaver::survey

namespace serialization_test {
namespace {

using namespace orbweaver;
using namespace orbweaver::survey;
using ::testing::HasSubstr;

template <class T>
class Travellers : public ::testing::Test {};
using Payloads =
    ::testing::Types<SweepWork, SweepOutcome, BranchWork, BranchOutcome, LocateWork, LocateOutcome, GivenOrbits,
                     StartWork, StartOutcome, StoredWork, LoopQuestion, LoopReply, BranchState, Checkpoint>;
TYPED_TEST_SUITE(Travellers, Payloads);

TYPED_TEST(Travellers, ListEveryMember) { EXPECT_EQ(test::incomplete_types_in<TypeParam>(), ""); }

TYPED_TEST(Travellers, ComeBackWithAllBits) {
  const TypeParam sent = test::filled<TypeParam>();
  EXPECT_NE(test::text_of(sent), test::text_of(TypeParam{}));
  EXPECT_EQ(test::text_of(from_payload<TypeParam>(to_payload(sent))), test::text_of(sent));
  EXPECT_EQ(test::text_of(from_payload<TypeParam>(to_payload(TypeParam{}))), test::text_of(TypeParam{}));
}

double peak_mib() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

// A size of 2^28 at every place where one may stand.
TYPED_TEST(Travellers, TakeNoMoreMemoryThanThereAreBytes) {
  const std::string bytes = to_payload(test::filled<TypeParam>());
  const double before = peak_mib();
  const std::uint64_t forged = std::uint64_t{1} << 28;
  for (std::size_t at = 0; at + sizeof forged <= bytes.size(); ++at) {
    std::string changed = bytes;
    std::memcpy(changed.data() + at, &forged, sizeof forged);
    try {
      (void)from_payload<TypeParam>(changed);
    } catch (const core::EnvironmentError&) {
      // As it should be; where a number stood the value is another one.
    }
  }
  EXPECT_LT(peak_mib() - before, 100.0);
}

TYPED_TEST(Travellers, AreRefusedWithOtherMembers) {
  PayloadType other = payload_type<TypeParam>();
  ++other.layout;
  const std::string bytes = write_payload(other, [](auto&) {});
  try {
    (void)from_payload<TypeParam>(bytes);
    FAIL() << "accepted";
  } catch (const core::EnvironmentError& error) {
    EXPECT_THAT(error.what(), HasSubstr("other members than here"));
  }
}

TEST(Travellers, JournalEntriesListEveryMember) { EXPECT_EQ(test::incomplete_types_in<EndedTask>(), ""); }

template <class T>
void expect_refused(const T& value, const std::string& why) {
  try {
    (void)from_payload<T>(to_payload(value));
    ADD_FAILURE() << "accepted: " << why;
  } catch (const core::EnvironmentError& error) {
    EXPECT_THAT(error.what(), HasSubstr(why));
  }
}

TEST(Travellers, LoopsThatAreNoneAreRefused) {
  BranchWork work;
  work.base = loop::constant_loop(std::vector<double>{1.0, 2.0}, 3.0, 1);
  EXPECT_NO_THROW((void)unpack_branch_work(pack(work)));
  for (const auto& spoil :
       {+[](loop::Loop& loop) { loop.modes.pop_back(); }, +[](loop::Loop& loop) { loop.period = 0; },
        +[](loop::Loop& loop) { loop.modes[3] = std::nan(""); },
        +[](loop::Loop& loop) { loop.parameters = {std::nan("")}; },
        +[](loop::Loop& loop) { loop.time_map.kappa = -1.0; }}) {
    BranchWork spoilt = work;
    spoil(spoilt.base);
    expect_refused(spoilt, "branch work");
  }
}

TEST(Travellers, LimitsAndEnumsThatAreNoneAreRefused) {
  expect_refused(StartOutcome{128}, "limits 0x80");
  BranchOutcome outcome;
  outcome.limited_by = 128;
  expect_refused(outcome, "limits 0x80");
  LocateOutcome located;
  located.limited_by = -1;
  expect_refused(located, "limits -0x1");
  outcome.limited_by = 0;
  outcome.end.reason = static_cast<continuation::EndReason>(99);
  EXPECT_THROW((void)pack(outcome), core::EnvironmentError);
}

}  // namespace
}  // namespace serialization_test
