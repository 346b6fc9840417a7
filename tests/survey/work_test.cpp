#include <gmock/gmock.h>

#include <sstream>

#include "orbweaver/archive/schema/crossing_kind.hpp"
#include "orbweaver/bifurcation/test_functions.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/systems/system.hpp"
#include "support/stated_system.hpp"
#include "tasks/payload/payload.hpp"
#include "tasks/payload/work.hpp"

namespace work_test {
namespace {

using namespace orbweaver;
using namespace orbweaver::survey;
using ::testing::AllOf;
using ::testing::HasSubstr;

const systems::Structure& pendulum() { return test::structure_of("double_pendulum"); }

loop::Isotropy sample_isotropy() { return {{"S", false, {}, 1, 2}, {"R", true, {}, 0, 1}}; }
Lineage sample_lineage() { return {"0001.0002/003.q4.j1/0", "0001.0002/003.q4.j1", 1, 2, -1}; }
loop::Loop sample_loop() { return {2, 1, 3.5, {1.0, 2.0, 3.0, 4.0, 5.0, 6.0}, {0.0, 1.0}, {2.5, {}}, {0.75}}; }

FoundMode sample_mode() {
  FoundMode mode;
  mode.period = 3.25;
  mode.place = 3;
  mode.direction = {{0.5, -0.25, 1e-300, 7.0}, {-1e300, 0.125}};
  mode.cutoff = 13;
  mode.isotropy = sample_isotropy();
  mode.one_direction = false;
  mode.amplitude = 0.0625;
  mode.base = sample_loop();
  mode.base_is_orbit = true;
  mode.distance = 0.375;
  return mode;
}

SweepOutcome sample_sweep_outcome() {
  return {2,
          {1.5},
          {sample_mode(), {}},
          {"T = 6.8: twice around", ""},
          {"T = 7: no family"},
          {{0.5, 2, 3}},
          {{6.25, 2, true, 1, {0, 1}, {3, 2}, {1, 2}}},
          5,
          1.0,
          12.0,
          {{-3,
            -0.25,
            starts::EquilibriumKind::hopf,
            2.0,
            {1.5},
            0.5,
            starts::LinearStability::neutral,
            {0.0, 1.0},
            {6.5},
            {1},
            "an end"}}};
}
BranchWork sample_branch_work() {
  return {"0001.0002/003.q4.j1/0-",
          "Naïve",
          sample_lineage(),
          sample_loop(),
          {{0.25, -0.5}, {1e-300}},
          sample_isotropy(),
          0.125,
          true};
}
BranchOutcome sample_branch_outcome() {
  return {"0001.0000",
          35,
          0.0625,
          3.4,
          30.0,
          -2.9,
          2.9,
          30.0,
          2.5,
          562,
          {continuation::EndReason::period_limit, "T = 30"},
          {{8.5, -1.5, sample_loop()}},
          2,
          {"a remark"},
          {"what was not found"},
          5e-13,
          0.75,
          period_limited,
          "a state"};
}
LocateWork sample_locate_work() {
  LocateWork work{"0001.0002/003.q4.j1", "Naïve", sample_lineage(), sample_isotropy(), {{0.5, sample_loop()}}, 0.25};
  work.event = {bifurcation::Event::Kind::test_function, {bifurcation::TestFunction::Kind::sector, {8, 3}}, true, true};
  work.from = 1.25;
  work.to = 1.5;
  return work;
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

TEST(Payload, EqualWorkHasEqualBytes) { EXPECT_EQ(pack(sample_branch_work()), pack(sample_branch_work())); }

TEST(Payload, AnotherKindIsRefusedByName) {
  const std::string text = environment_error_of([] { (void)unpack_branch_work(pack(sample_sweep_outcome())); });
  EXPECT_THAT(text, AllOf(HasSubstr("expected a branch work of version 2"),
                          HasSubstr("got a sweep outcome of version 5"), HasSubstr("same build")));
}

TEST(Payload, AnotherVersionIsRefused) {
  const PayloadType other{SweepWork::payload_name, SweepWork::wire_version + 1, 0};
  const std::string bytes = write_payload(other, [](auto&) {});
  const std::string text = environment_error_of([&] { (void)unpack_sweep_work(bytes); });
  EXPECT_THAT(text, HasSubstr("got a sweep work of version 4"));
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

TEST(WorkIsotropy, IsSentByNameAndGetsItsMatricesBack) {
  BranchWork work;
  work.isotropy = {{"S", false, pendulum().equivariances[0].map, 1, 2},
                   {"RS", true, pendulum().reversors[1].map, 3, 4}};
  const loop::Isotropy received = unpack_branch_work(pack(work)).isotropy;
  EXPECT_EQ(received.at(0).map.dimension(), 0);
  const loop::Isotropy back = loop::with_declared_matrices(received, pendulum());
  ASSERT_EQ(back.size(), 2U);
  EXPECT_EQ(loop::to_text(back), loop::to_text(work.isotropy));
  for (std::size_t n = 0; n < 2; ++n) {
    EXPECT_EQ(back[n].reversing, work.isotropy[n].reversing);
    EXPECT_EQ(back[n].map.matrix, work.isotropy[n].map.matrix);
  }
}

TEST(WorkIsotropy, AnUnknownSymmetryIsRefused) {
  loop::Isotropy isotropy = sample_isotropy();
  isotropy[1].name = "Q";
  EXPECT_THAT(environment_error_of([&] { (void)loop::with_declared_matrices(isotropy, pendulum()); }),
              AllOf(HasSubstr("`Q`"), HasSubstr("the system does not declare")));
  isotropy[1].name = "S";  // declared, but as an equivariance
  EXPECT_THAT(environment_error_of([&] { (void)loop::with_declared_matrices(isotropy, pendulum()); }),
              HasSubstr("`S`"));
  isotropy = sample_isotropy();
  isotropy[0].shift_denominator = 0;
  EXPECT_THAT(environment_error_of([&] { (void)loop::with_declared_matrices(isotropy, pendulum()); }),
              HasSubstr("shift 1/0"));
}

TEST(WorkStart, PointsAlongTheBranchsOwnWay) {
  BranchWork work;
  const std::vector<double> point{0.0, 3.0, 0.0, 0.0};
  work.base = loop::constant_loop(point, 5.0, 1);
  for (int n = 0; n < 12; ++n) work.direction.modes.push_back(n);
  work.lineage.side = -1;
  const continuation::Start start = start_of(work, pendulum());
  EXPECT_EQ(start.base.period, 5.0);
  EXPECT_EQ(start.base.cosine(0, 1), 3.0);
  ASSERT_EQ(start.direction.modes.size(), 12U);
  for (int n = 0; n < 12; ++n) EXPECT_EQ(start.direction.modes[static_cast<std::size_t>(n)], n);
}

TEST(WorkStart, TheOtherSideHasAWayOfItsOwnWhereOneIsKnown) {
  LeavingRecord leaving;
  leaving.direction.modes = {1.0, 2.0};
  EXPECT_EQ(leaving.way(1).modes, (std::vector<double>{1.0, 2.0}));
  EXPECT_EQ(leaving.way(-1).modes, (std::vector<double>{-1.0, -2.0}));
  leaving.opposite.modes = {-1.0, 2.5};
  EXPECT_EQ(leaving.way(1).modes, (std::vector<double>{1.0, 2.0}));
  EXPECT_EQ(leaving.way(-1).modes, (std::vector<double>{-1.0, 2.5}));
}

TEST(WorkTasks, SweepsComeFirstAndKeysSortByNumber) {
  const queue::Task second = task_of(SweepWork{2, {}});
  const queue::Task tenth = task_of(SweepWork{10, {}});
  const queue::Task branch = task_of(sample_branch_work());
  EXPECT_LT(second.key, tenth.key);
  EXPECT_LT(tenth.priority, branch.priority);
  EXPECT_EQ(branch.key, "0001.0002/003.q4.j1/0-");
  EXPECT_EQ(kind_of(branch), TaskKind::branch);
  EXPECT_EQ(kind_of(second), TaskKind::sweep);
}

TEST(WorkTasks, BranchesThenCrossingsThenStartsThenDeeperBranches) {
  BranchWork base = sample_branch_work();
  base.lineage.depth = 0;
  LocateWork locate = sample_locate_work();
  locate.lineage.depth = 0;
  const queue::Task deeper = task_of(sample_branch_work());
  EXPECT_LT(task_of(base).priority, task_of(locate).priority);
  EXPECT_LT(task_of(locate).priority, task_of(StartWork{sample_branch_work()}).priority);
  EXPECT_LT(task_of(StartWork{sample_branch_work()}).priority, deeper.priority);
}

TEST(WorkTasks, TheOtherSideCountsBackwardsFromTheBirth) {
  EXPECT_EQ(signed_arclength({"", "", 1, 3, 1}, 0.25, 2.0), 2.0);
  EXPECT_EQ(signed_arclength({"", "", 1, 3, -1}, 0.25, 2.0), -2.25);
}

TEST(Work, WhatCrossesWithoutASectorHasAKindInTheArchive) {
  using Kind = bifurcation::TestFunction::Kind;
  for (int n = 0; n <= static_cast<int>(last_of(Kind{})); ++n) {
    const auto kind = static_cast<Kind>(n);
    if (bifurcation::has_sector(kind)) continue;
    EXPECT_NE(archive::crossing_kind_of(bifurcation::name_of(kind)), archive::CrossingKind::unknown)
        << bifurcation::name_of(kind);
  }
}

}  // namespace
}  // namespace work_test
