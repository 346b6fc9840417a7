#include <gmock/gmock.h>

#include <sstream>

#include "orbweaver/core/error.hpp"
#include "orbweaver/survey/work.hpp"
#include "orbweaver/systems/system.hpp"
#include "payload.hpp"

namespace {

using namespace orbweaver;
using namespace orbweaver::survey;
using ::testing::AllOf;
using ::testing::HasSubstr;

const systems::Description& pendulum() { return systems::describe_system("double_pendulum"); }

FoundMode sample_mode() {
  FoundMode mode;
  mode.period = 3.25;
  mode.direction = {0.5, -0.25, 1e-300, 7.0};
  mode.cutoff = 13;
  mode.isotropy = {"S", "R"};
  mode.reversing = {0, 1};
  mode.shift_numerators = {1, 0};
  mode.shift_denominators = {2, 1};
  mode.one_direction = false;
  return mode;
}

SweepWork sample_sweep_work() { return {3, {0.0, 3.141592653589793}}; }
SweepOutcome sample_sweep_outcome() { return {2, {1.5}, {sample_mode(), {}}, {"T = 6.8: twice around", ""}}; }
BranchWork sample_branch_work() { return {"0001.0002-", "Naïve", {1.0, 2.0}, sample_mode(), -1}; }
BranchOutcome sample_branch_outcome() {
  return {"0001.0000", 35, 3.4, 30.0, -2.9, 2.9, 30.0, 2.5, 562, "period limit (T = 30)"};
}

void expect_equal(const FoundMode& a, const FoundMode& b) {
  EXPECT_EQ(a.period, b.period);
  EXPECT_EQ(a.direction, b.direction);
  EXPECT_EQ(a.cutoff, b.cutoff);
  EXPECT_EQ(a.isotropy, b.isotropy);
  EXPECT_EQ(a.reversing, b.reversing);
  EXPECT_EQ(a.shift_numerators, b.shift_numerators);
  EXPECT_EQ(a.shift_denominators, b.shift_denominators);
  EXPECT_EQ(a.one_direction, b.one_direction);
}

template <class Body>
std::string environment_error_of(const Body& body) {
  try {
    body();
  } catch (const core::EnvironmentError& error) {
    return error.what();
  }
  return "no EnvironmentError";
}

TEST(Payload, SweepWorkTravels) {
  const SweepWork back = unpack_sweep_work(pack(sample_sweep_work()));
  EXPECT_EQ(back.index, 3);
  EXPECT_EQ(back.point, sample_sweep_work().point);
}

TEST(Payload, SweepOutcomeTravels) {
  const SweepOutcome sent = sample_sweep_outcome();
  const SweepOutcome back = unpack_sweep_outcome(pack(sent));
  EXPECT_EQ(back.index, sent.index);
  EXPECT_EQ(back.point, sent.point);
  EXPECT_EQ(back.rejected, sent.rejected);
  ASSERT_EQ(back.modes.size(), 2U);
  expect_equal(back.modes[0], sent.modes[0]);
  expect_equal(back.modes[1], sent.modes[1]);
}

TEST(Payload, BranchWorkTravels) {
  const BranchWork sent = sample_branch_work();
  const BranchWork back = unpack_branch_work(pack(sent));
  EXPECT_EQ(back.key, sent.key);
  EXPECT_EQ(back.name, sent.name);
  EXPECT_EQ(back.point, sent.point);
  EXPECT_EQ(back.sign, sent.sign);
  expect_equal(back.start, sent.start);
}

TEST(Payload, BranchOutcomeTravels) {
  const BranchOutcome sent = sample_branch_outcome();
  const BranchOutcome back = unpack_branch_outcome(pack(sent));
  EXPECT_EQ(back.key, sent.key);
  EXPECT_EQ(back.orbits, sent.orbits);
  EXPECT_EQ(back.period_from, sent.period_from);
  EXPECT_EQ(back.period_to, sent.period_to);
  EXPECT_EQ(back.energy_from, sent.energy_from);
  EXPECT_EQ(back.energy_to, sent.energy_to);
  EXPECT_EQ(back.last_period, sent.last_period);
  EXPECT_EQ(back.last_energy, sent.last_energy);
  EXPECT_EQ(back.last_cutoff, sent.last_cutoff);
  EXPECT_EQ(back.end_reason, sent.end_reason);
}

TEST(Payload, EqualWorkHasEqualBytes) { EXPECT_EQ(pack(sample_branch_work()), pack(sample_branch_work())); }

TEST(Payload, AnotherKindIsRefusedByName) {
  const std::string text = environment_error_of([] { (void)unpack_branch_work(pack(sample_sweep_outcome())); });
  EXPECT_THAT(text, AllOf(HasSubstr("expected a branch work of version 1"),
                          HasSubstr("got a sweep outcome of version 1"), HasSubstr("same build")));
}

TEST(Payload, AnotherVersionIsRefused) {
  std::ostringstream stream;
  {
    boost::archive::binary_oarchive archive(stream);
    const std::string name = SweepWork::payload_name;
    const int version = payload_version + 1;
    archive << name << version;
  }
  const std::string text = environment_error_of([&] { (void)unpack_sweep_work(stream.str()); });
  EXPECT_THAT(text, HasSubstr("got a sweep work of version 2"));
}

TEST(Payload, TornAtAnyByteIsRefused) {
  const std::string whole = pack(sample_branch_work());
  for (std::size_t length = 0; length < whole.size(); ++length) {
    const std::string torn = whole.substr(0, length);
    EXPECT_THAT(environment_error_of([&] { (void)unpack_branch_work(torn); }),
                HasSubstr("branch work of " + std::to_string(length) + " bytes cannot be read"));
  }
}

TEST(Payload, MoreBytesThanItsOwnAreRefused) {
  EXPECT_THAT(environment_error_of([] { (void)unpack_branch_outcome(pack(sample_branch_outcome()) + "x"); }),
              HasSubstr("branch outcome"));
}

TEST(Payload, ForeignBytesAreRefused) {
  for (const std::string& bytes :
       {std::string("not a payload at all, but a sentence of some length"), std::string(64, '\0'),
        std::string(64, '\xff'), std::string("\x16\0\0\0\0\0\0\0serialization::archives", 31)})
    EXPECT_THAT(environment_error_of([&] { (void)unpack_sweep_outcome(bytes); }), HasSubstr("sweep outcome of"));
}

TEST(WorkIsotropy, TravelsWithItsMatrices) {
  const loop::Isotropy isotropy{{"S", false, pendulum().equivariances[0].matrix, 1, 2},
                                {"RS", true, pendulum().reversors[1].matrix, 3, 4}};
  FoundMode mode;
  set_isotropy(mode, isotropy);
  const loop::Isotropy back = isotropy_of(mode, pendulum());
  ASSERT_EQ(back.size(), 2U);
  EXPECT_EQ(loop::to_text(back), loop::to_text(isotropy));
  for (std::size_t n = 0; n < 2; ++n) {
    EXPECT_EQ(back[n].reversing, isotropy[n].reversing);
    EXPECT_EQ(back[n].matrix, isotropy[n].matrix);
  }
}

TEST(WorkIsotropy, AnUnknownSymmetryIsRefused) {
  FoundMode mode = sample_mode();
  mode.isotropy[1] = "Q";
  EXPECT_THAT(environment_error_of([&] { (void)isotropy_of(mode, pendulum()); }),
              AllOf(HasSubstr("`Q`"), HasSubstr("double_pendulum")));
  mode.isotropy[1] = "S";  // declared, but as an equivariance
  EXPECT_THAT(environment_error_of([&] { (void)isotropy_of(mode, pendulum()); }), HasSubstr("`S`"));
}

TEST(WorkStart, PointsAlongOrAgainstTheFoundDirection) {
  BranchWork work;
  work.point = {0.0, 3.0, 0.0, 0.0};
  work.start.period = 5.0;
  work.start.cutoff = 1;
  for (int n = 0; n < 12; ++n) work.start.direction.push_back(n);
  work.sign = -1;
  const continuation::Start start = start_of(work, pendulum());
  EXPECT_EQ(start.base.period, 5.0);
  EXPECT_EQ(start.base.cosine(0, 1), 3.0);
  ASSERT_EQ(start.direction.size(), 12U);
  for (int n = 0; n < 12; ++n) EXPECT_EQ(start.direction[static_cast<std::size_t>(n)], -n);
}

TEST(WorkTasks, SweepsComeFirstAndKeysSortByNumber) {
  const queue::Task second = task_of(SweepWork{2, {}});
  const queue::Task tenth = task_of(SweepWork{10, {}});
  const queue::Task branch = task_of(sample_branch_work());
  EXPECT_LT(second.key, tenth.key);
  EXPECT_LT(tenth.priority, branch.priority);
  EXPECT_EQ(branch.key, "0001.0002-");
  EXPECT_EQ(branch.kind, branch_kind);
  EXPECT_EQ(second.kind, sweep_kind);
}

}  // namespace
