#include <gmock/gmock.h>

#include <sstream>
#include <tuple>

#include "orbweaver/core/error.hpp"
#include "orbweaver/survey/tasks/work.hpp"
#include "orbweaver/systems/system.hpp"
#include "tasks/payload.hpp"

namespace {

using namespace orbweaver;
using namespace orbweaver::survey;
using ::testing::AllOf;
using ::testing::HasSubstr;

const systems::Description& pendulum() { return systems::describe_system("double_pendulum"); }

IsotropyRecord sample_isotropy() { return {{"S", "R"}, {0, 1}, {1, 0}, {2, 1}}; }
Lineage sample_lineage() { return {"0001.0002/003.q4.j1/0", "0001.0002/003.q4.j1", 1, 2, -1}; }
LoopRecord sample_loop() { return {2, 1, 3.5, {1.0, 2.0, 3.0, 4.0, 5.0, 6.0}, {0.0, 1.0}, {2.5}}; }

FoundMode sample_mode() {
  FoundMode mode;
  mode.period = 3.25;
  mode.direction = {{0.5, -0.25, 1e-300, 7.0}, {-1e300, 0.125}};
  mode.cutoff = 13;
  mode.isotropy = sample_isotropy();
  mode.one_direction = false;
  return mode;
}

SweepWork sample_sweep_work() { return {3, {0.0, 3.141592653589793}}; }
SweepOutcome sample_sweep_outcome() { return {2, {1.5}, {sample_mode(), {}}, {"T = 6.8: twice around", ""}}; }
BranchWork sample_branch_work() {
  return {"0001.0002/003.q4.j1/0-", "Naïve", sample_lineage(), sample_loop(), {{0.25, -0.5}, {1e-300}},
          sample_isotropy(),        0.125};
}
BranchOutcome sample_branch_outcome() {
  return {"0001.0000",
          35,
          3.4,
          30.0,
          -2.9,
          2.9,
          30.0,
          2.5,
          562,
          {continuation::EndReason::period_limit, "T = 30"},
          {{8.5, -1.5, sample_loop()}},
          {"a remark"},
          period_limited,
          "a state"};
}
LocateWork sample_locate_work() {
  LocateWork work{"0001.0002/003.q4.j1", "Naïve", sample_lineage(), sample_isotropy(), {{0.5, sample_loop()}}, 0.25};
  set_event(work, {bifurcation::Event::Kind::test_function, {bifurcation::TestFunction::Kind::sector, {8, 3}}, true});
  work.from = 1.25;
  work.to = 1.5;
  return work;
}
LocateOutcome sample_locate_outcome() {
  return {"0001.0002/003.q4.j1",
          sample_lineage(),
          1.0,
          2.0,
          3.0,
          archive::CrossingKind::subharmonic,
          4,
          2,
          1e-12,
          1e-11,
          0.5,
          -1e-13,
          {1.0, 2.0},
          8,
          3,
          2,
          {{"0001.0002/003.q4.j1/0", sample_isotropy(), true, sample_loop(), {{0.5}, {3.0, -0.75}}}},
          "a remark"};
}

void expect_equal(const IsotropyRecord& a, const IsotropyRecord& b) {
  EXPECT_EQ(a.names, b.names);
  EXPECT_EQ(a.reversing, b.reversing);
  EXPECT_EQ(a.shift_numerators, b.shift_numerators);
  EXPECT_EQ(a.shift_denominators, b.shift_denominators);
}

void expect_equal(const LoopRecord& a, const LoopRecord& b) {
  EXPECT_EQ(a.dimension, b.dimension);
  EXPECT_EQ(a.cutoff, b.cutoff);
  EXPECT_EQ(a.period, b.period);
  EXPECT_EQ(a.modes, b.modes);
  EXPECT_EQ(a.winding, b.winding);
  EXPECT_EQ(a.time_map, b.time_map);
}

void expect_equal(const Lineage& a, const Lineage& b) {
  EXPECT_EQ(a.family, b.family);
  EXPECT_EQ(a.crossing, b.crossing);
  EXPECT_EQ(a.depth, b.depth);
  EXPECT_EQ(a.multiplicity, b.multiplicity);
  EXPECT_EQ(a.side, b.side);
}

void expect_equal(const FoundMode& a, const FoundMode& b) {
  EXPECT_EQ(a.period, b.period);
  EXPECT_EQ(a.direction, b.direction);
  EXPECT_EQ(a.cutoff, b.cutoff);
  expect_equal(a.isotropy, b.isotropy);
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
  expect_equal(back.lineage, sent.lineage);
  expect_equal(back.base, sent.base);
  EXPECT_EQ(back.direction, sent.direction);
  expect_equal(back.isotropy, sent.isotropy);
  EXPECT_EQ(back.amplitude, sent.amplitude);
  expect_equal(unpack_start_work(pack(StartWork{sent})).branch.base, sent.base);
}

TEST(Payload, LocateWorkTravels) {
  const LocateWork sent = sample_locate_work();
  const LocateWork back = unpack_locate_work(pack(sent));
  EXPECT_EQ(back.key, sent.key);
  EXPECT_EQ(back.name, sent.name);
  expect_equal(back.lineage, sent.lineage);
  expect_equal(back.isotropy, sent.isotropy);
  ASSERT_EQ(back.known.size(), 1U);
  EXPECT_EQ(back.known[0].position, 0.5);
  expect_equal(back.known[0].loop, sent.known[0].loop);
  EXPECT_EQ(back.before_first, 0.25);
  const bifurcation::Event event = event_of(back);
  EXPECT_EQ(event.kind, bifurcation::Event::Kind::test_function);
  EXPECT_EQ(event.function, (bifurcation::TestFunction{bifurcation::TestFunction::Kind::sector, {8, 3}}));
  EXPECT_TRUE(event.tangency);
  EXPECT_EQ(back.from, 1.25);
  EXPECT_EQ(back.to, 1.5);
}

TEST(Payload, LocateOutcomeTravels) {
  const LocateOutcome sent = sample_locate_outcome();
  const LocateOutcome back = unpack_locate_outcome(pack(sent));
  EXPECT_EQ(back.key, sent.key);
  expect_equal(back.lineage, sent.lineage);
  EXPECT_EQ(std::tie(back.arclength, back.period, back.energy, back.kind, back.multiplicity, back.kernel_dimension),
            std::tie(sent.arclength, sent.period, sent.energy, sent.kind, sent.multiplicity, sent.kernel_dimension));
  EXPECT_EQ(std::tie(back.residual, back.kernel_singular_value, back.next_singular_value, back.test_value, back.state),
            std::tie(sent.residual, sent.kernel_singular_value, sent.next_singular_value, sent.test_value, sent.state));
  EXPECT_EQ(back.limited_by, sent.limited_by);
  EXPECT_EQ(std::tie(back.q, back.j, back.fundamental_order, back.remark),
            std::tie(sent.q, sent.j, sent.fundamental_order, sent.remark));
  ASSERT_EQ(back.leaving.size(), 1U);
  EXPECT_EQ(back.leaving[0].key, sent.leaving[0].key);
  expect_equal(back.leaving[0].isotropy, sent.leaving[0].isotropy);
  EXPECT_TRUE(back.leaving[0].both_sides);
  expect_equal(back.leaving[0].base, sent.leaving[0].base);
  EXPECT_EQ(back.leaving[0].direction, sent.leaving[0].direction);
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
  EXPECT_EQ(back.end.text(), sent.end.text());
  ASSERT_EQ(back.arrival.size(), 1U);
  EXPECT_EQ(back.arrival[0].period, 8.5);
  EXPECT_EQ(back.arrival[0].energy, -1.5);
  expect_equal(back.arrival[0].near, sent.arrival[0].near);
  EXPECT_EQ(back.remarks, sent.remarks);
  EXPECT_EQ(std::tie(back.limited_by, back.before_limit), std::tie(sent.limited_by, sent.before_limit));
}

TEST(Payload, EqualWorkHasEqualBytes) { EXPECT_EQ(pack(sample_branch_work()), pack(sample_branch_work())); }

TEST(Payload, AnotherKindIsRefusedByName) {
  const std::string text = environment_error_of([] { (void)unpack_branch_work(pack(sample_sweep_outcome())); });
  EXPECT_THAT(text, AllOf(HasSubstr("expected a branch work of version 2"),
                          HasSubstr("got a sweep outcome of version 2"), HasSubstr("same build")));
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
  EXPECT_THAT(text, HasSubstr("got a sweep work of version " + std::to_string(payload_version + 1)));
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
  const loop::Isotropy back = isotropy_of(record_of(isotropy), pendulum());
  ASSERT_EQ(back.size(), 2U);
  EXPECT_EQ(loop::to_text(back), loop::to_text(isotropy));
  for (std::size_t n = 0; n < 2; ++n) {
    EXPECT_EQ(back[n].reversing, isotropy[n].reversing);
    EXPECT_EQ(back[n].matrix, isotropy[n].matrix);
  }
}

TEST(WorkIsotropy, AnUnknownSymmetryIsRefused) {
  IsotropyRecord record = sample_isotropy();
  record.names[1] = "Q";
  EXPECT_THAT(environment_error_of([&] { (void)isotropy_of(record, pendulum()); }),
              AllOf(HasSubstr("`Q`"), HasSubstr("double_pendulum")));
  record.names[1] = "S";  // declared, but as an equivariance
  EXPECT_THAT(environment_error_of([&] { (void)isotropy_of(record, pendulum()); }), HasSubstr("`S`"));
}

TEST(WorkStart, PointsAlongOrAgainstTheFoundDirection) {
  BranchWork work;
  const std::vector<double> point{0.0, 3.0, 0.0, 0.0};
  work.base = record_of(loop::constant_loop(point, 5.0, 1));
  for (int n = 0; n < 12; ++n) work.direction.modes.push_back(n);
  work.lineage.side = -1;
  const continuation::Start start = start_of(work, pendulum());
  EXPECT_EQ(start.base.period, 5.0);
  EXPECT_EQ(start.base.cosine(0, 1), 3.0);
  ASSERT_EQ(start.direction.modes.size(), 12U);
  for (int n = 0; n < 12; ++n) EXPECT_EQ(start.direction.modes[static_cast<std::size_t>(n)], -n);
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

TEST(WorkTasks, TheOtherSideCountsBackwardsFromTheFirstOrbit) {
  EXPECT_EQ(signed_arclength({"", "", 1, 3, 1}, 0.25, 2.0), 2.0);
  EXPECT_EQ(signed_arclength({"", "", 1, 3, -1}, 0.25, 2.0), -2.5);
}

}  // namespace
