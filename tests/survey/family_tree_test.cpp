#include "tree/family_tree.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include <fmt/format.h>

#include "orbweaver/systems/system.hpp"
#include "support/stated_system.hpp"
#include "survey/scenes.hpp"
#include "survey/tree_outcomes.hpp"

namespace family_tree_test {
namespace {

using namespace orbweaver;
using namespace orbweaver::survey;
using continuation::EndReason;
using namespace orbweaver::test;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;

constexpr int first = std::numeric_limits<int>::min();
constexpr int last = std::numeric_limits<int>::max();

const systems::Structure& pendulum() { return test::structure_of("double_pendulum"); }

const Place p{"0000.0000/000.q4.j1", 8.0, 1.0};
const Place q{"0000.0000/001.q4.j1", 9.0, 2.0};
const Place r{"0000.0000/002.q4.j1", 9.5, 2.5};

class Families : public ::testing::Test {
 protected:
  FamilyTree::Result resolve(const std::vector<Ended>& events) {
    FamilyTree tree(scene, pendulum());
    for (const Ended& event : events) tree.add(event.task, event.outcome);
    return tree.resolve();
  }
  static std::vector<std::string> names(const FamilyTree::Result& result) {
    std::vector<std::string> out;
    for (const archive::FamilyRecord& family : result.tables.families) out.push_back(family.name);
    return out;
  }
  static const archive::FamilyRecord& family(const FamilyTree::Result& result, const std::string& name) {
    for (const archive::FamilyRecord& f : result.tables.families)
      if (f.name == name) return f;
    throw std::runtime_error("no family " + name);
  }
  scene::Scene scene = quick_scene({});
};

std::string text(const FamilyTree::Result& result) {
  std::string out;
  for (const archive::FamilyRecord& f : result.tables.families)
    out += fmt::format("{} {} of {} at {} x{} {} ends {} at {} of {}, steps {}..{}\n", f.key, f.name, f.parent_key,
                       f.crossing, f.multiplicity, f.isotropy, f.end_reason, f.end_crossing, f.end_family_key,
                       f.first_step, f.last_step);
  for (const archive::CrossingRecord& c : result.tables.crossings)
    out += fmt::format("{} on {} at {} {}\n", name_of(c.kind), c.family_key, c.arclength, c.period);
  for (const FamilySummary& s : result.families)
    out += fmt::format("{} {} depth {} orbits {} T {}..{} failed {}\n", s.key, s.name, s.depth, s.orbits, s.period_from,
                       s.period_to, s.failed);
  for (const std::string& failure : result.failures) out += failure + "\n";
  return out;
}

TEST_F(Families, AreNamedByParentKindPlaceAndDirection) {
  const Place branch_point{"0000.0000/003.q2.j1", 10.0, 3.0, 1};
  const Place tripling{"0000.0000/004.q3.j1", 11.0, 4.0, 3};
  const Place second{"0000.0000/002.q4.j1/0/000.q2.j1", 19.0, 5.0, 1, r.leaving(0), 1};
  const Place of_other{"0003.0000/000.q2.j1", 7.0, 1.5, 1, "0003.0000"};
  std::vector<Ended> events{ended(base_work(), EndReason::period_limit, 5, 12),
                            ended(base_work("0003.0000", "Up-Down"), EndReason::period_limit, 5, 12)};
  for (const Place& place : {p, r}) {
    events.push_back(located(place));
    for (const int number : {0, 1}) events.push_back(ended(work_from(place, number), EndReason::period_limit, 16, 30));
  }
  for (const Place& place : {branch_point, second, of_other}) {
    events.push_back(located(place, 1));
    events.push_back(ended(work_from(place, 0), EndReason::period_limit, 10, 30));
  }
  events.push_back(located(tripling, 1));
  events.push_back(ended(work_from(tripling, 0, 1), EndReason::period_limit, 33, 40));
  const FamilyTree::Result result = resolve(events);
  EXPECT_THAT(names(result),
              ElementsAre("In-Phase", "Up-Down", "ID1a", "ID1b", "ID2a", "ID2b", "IB", "IT3", "Up-Down B", "ID2aB"));
  EXPECT_EQ(family(result, "ID2b").parent_key, "0000.0000");
  EXPECT_EQ(family(result, "ID2aB").parent_key, r.leaving(0));
  EXPECT_EQ(result.families.back().depth, 2);
  EXPECT_EQ(family(result, "ID1a").isotropy, "R@0");
  EXPECT_EQ(family(result, "ID1b").isotropy, "RS@0");
  EXPECT_EQ(family(result, "IT3").multiplicity, 3);
  // Crossings by index: each family's is the one that it was born at.
  for (const archive::FamilyRecord& f : result.tables.families) {
    if (f.parent_key.empty()) {
      EXPECT_EQ(f.crossing, -1);
      continue;
    }
    const archive::CrossingRecord& born = result.tables.crossings.at(static_cast<std::size_t>(f.crossing));
    EXPECT_EQ(born.family_key, f.parent_key) << f.name;
    EXPECT_EQ(born.multiplicity, f.multiplicity) << f.name;
  }
}

TEST_F(Families, AreNumberedByArclengthNotByKey) {
  Place early{"0000.0000/005.q3.j1", 11.0, 1.0, 3};
  Place late{"0000.0000/004.q3.j1", 12.0, 4.0, 3};
  const FamilyTree::Result result =
      resolve({ended(base_work(), EndReason::period_limit, 5, 12), located(late, 1), located(early, 1),
               ended(work_from(late, 0, 1), EndReason::closed_loop, 36, 40),
               ended(work_from(early, 0, 1), EndReason::closed_loop, 33, 40)});
  EXPECT_THAT(names(result), ElementsAre("In-Phase", "IT3-2", "IT3-1"));
}

// P's two families end at Q; Q's two families are these.
std::vector<Ended> loop_of_two() {
  return {ended(base_work(), EndReason::period_limit, 5, 12), located(p), located(q),
          arrived(work_from(p, 0), 16, q, 0), arrived(work_from(p, 1), 16, q, 1)};
}

TEST_F(Families, ThatArriveDropWhatStartsThere) {
  // On Q's family b another crossing, and a family born there: theirs is a second way to what P's family b has as well.
  const Place below{"0000.0000/001.q4.j1/1/000.q2.j1", 17.0, 6.0, 1, q.leaving(1), 1};
  std::vector<Ended> events = loop_of_two();
  events.push_back(ended(work_from(q, 0), EndReason::period_limit, 18, 20));
  events.push_back(arrived(work_from(q, 1), 18, p, 1));
  events.push_back(located(below, 1));
  events.push_back(ended(work_from(below, 0), EndReason::period_limit, 17, 30));
  const FamilyTree::Result result = resolve(events);
  EXPECT_THAT(names(result), ElementsAre("In-Phase", "IDa", "IDb"));
  EXPECT_THAT(result.tables.left_out_keys, ElementsAre(q.leaving(0), q.leaving(1), below.leaving(0)));
  ASSERT_EQ(result.tables.crossings.size(), 2U);
  for (const char* name : {"IDa", "IDb"}) {
    const archive::FamilyRecord& f = family(result, name);
    EXPECT_EQ(f.end_family_key, "0000.0000");
    EXPECT_EQ(result.tables.crossings.at(static_cast<std::size_t>(f.end_crossing)).period, q.period);
    EXPECT_EQ(f.end_reason, "joined In-Phase at T = 18 (crossing at T = 9, 2 times around)");
    EXPECT_EQ(f.first_step, 0);
    EXPECT_EQ(f.last_step, last);
  }
}

TEST_F(Families, ThatArriveElsewhereDropNothing) {
  Place elsewhere = q;
  elsewhere.arclength = 2.6;  // period and energy nearly as at Q, but another orbit
  std::vector<Ended> events{ended(base_work(), EndReason::period_limit, 5, 12), located(p), located(q)};
  BranchOutcome outcome = unpack_branch_outcome(arrived(work_from(p, 0), 16, elsewhere, 0).outcome.payload);
  outcome.arrival.front().level = q.energy();
  Ended stray = ended(work_from(p, 0), EndReason::closed_loop, 16, 18);
  stray.outcome.payload = pack(outcome);
  events.push_back(stray);
  events.push_back(ended(work_from(q, 0), EndReason::period_limit, 18, 20));
  const FamilyTree::Result result = resolve(events);
  EXPECT_THAT(names(result), ElementsAre("In-Phase", "ID1", "ID2"));
  EXPECT_THAT(family(result, "ID1").end_reason, StartsWith("met a family of more symmetry (T = "));
  EXPECT_EQ(family(result, "ID1").end_family_key, "");
}

TEST_F(Families, ThatArriveOutsideTheWindowDropNothing) {
  const auto with = [&](double period, double energy) {
    Ended stray = arrived(work_from(p, 0), 16, q, 0);
    BranchOutcome outcome = unpack_branch_outcome(stray.outcome.payload);
    outcome.arrival.front().period = period;
    outcome.arrival.front().level = energy;
    stray.outcome.payload = pack(outcome);
    return names(resolve({ended(base_work(), EndReason::period_limit, 5, 12), located(p), located(q), stray,
                          ended(work_from(q, 0), EndReason::period_limit, 18, 20)}));
  };
  const double period = 2.0 * q.period;
  EXPECT_THAT(with(period * 1.0009, q.energy() + 0.0015), ElementsAre("In-Phase", "ID"));
  EXPECT_THAT(with(period * 1.0015, q.energy()), ElementsAre("In-Phase", "ID1", "ID2"));
  EXPECT_THAT(with(period, q.energy() + 0.0025), ElementsAre("In-Phase", "ID1", "ID2"));
}

TEST_F(Families, ThatArriveBetweenTwoDirectionsComeAlongTheNearer) {
  Ended place = located(q);
  LocateOutcome crossing = unpack_locate_outcome(place.outcome.payload);
  const std::vector<double> own = crossing.leaving[0].direction.modes;
  crossing.leaving[1].isotropy = crossing.leaving[0].isotropy;
  for (const double nearby : {0.2, -0.2}) {
    const std::vector<double> turned = kernel_vector(q, nearby);
    for (const std::size_t along : {0U, 1U}) {
      crossing.leaving[along].direction.modes = own;
      crossing.leaving[1 - along].direction.modes = turned;
      place.outcome.payload = pack(crossing);
      const FamilyTree::Result result =
          resolve({ended(base_work(), EndReason::period_limit, 5, 12), located(p), place,
                   arrived(work_from(p, 0), 16, q, 0), ended(work_from(q, 0), EndReason::closed_loop, 18, 20),
                   ended(work_from(q, 1), EndReason::closed_loop, 18, 20)});
      EXPECT_THAT(result.tables.left_out_keys, ElementsAre(q.leaving(static_cast<int>(along))));
    }
  }
}

TEST_F(Families, OfAnotherDirectionStay) {
  std::vector<Ended> events{ended(base_work(), EndReason::period_limit, 5, 12),
                            located(p),
                            located(q),
                            arrived(work_from(p, 0), 16, q, 1),
                            ended(work_from(q, 0), EndReason::closed_loop, 18, 20),
                            ended(work_from(q, 1), EndReason::closed_loop, 18, 20)};
  EXPECT_THAT(names(resolve(events)), ElementsAre("In-Phase", "ID1", "ID2"));
  EXPECT_THAT(resolve(events).tables.left_out_keys, ElementsAre(q.leaving(1)));
}

TEST_F(Families, DoNotDependOnTheOrderOfOutcomes) {
  const Place below{"0000.0000/001.q4.j1/0/000.q2.j1", 17.0, 6.0, 1, q.leaving(0), 1};
  const std::vector<Ended> begin{ended(base_work(), EndReason::period_limit, 5, 12),
                                 ended(work_from(p, 1), EndReason::closed_loop, 16, 30)};
  const std::vector<Ended> kept{located(p), located(q), arrived(work_from(p, 0), 16, q, 0)};
  const std::vector<std::vector<Ended>> ways_of_q{
      {},  // never run
      {arrived(work_from(q, 0), 18, p, 0), located(below, 1),
       ended(work_from(below, 0), EndReason::closed_loop, 17, 30)},
      {ended(work_from(q, 0), EndReason::period_limit, 18, 20), not_located(below, "no root")},
      {gave_up(work_from(q, 0), "nan", 18, 19)},
      {start_failed(work_from(q, 0), "no orbit leaves")}};
  std::string expected;
  for (const std::vector<Ended>& more : ways_of_q) {
    std::vector<Ended> events = kept;
    events.insert(events.end(), more.begin(), more.end());
    std::vector<std::size_t> order(events.size());
    std::iota(order.begin(), order.end(), 0U);
    do {
      std::vector<Ended> all = begin;
      for (const std::size_t n : order) all.push_back(events[n]);
      const std::string found = text(resolve(all));
      if (expected.empty()) expected = found;
      ASSERT_EQ(found, expected) << "with " << more.size() << " outcomes of Q's family, order "
                                 << ::testing::PrintToString(order);
    } while (std::next_permutation(order.begin(), order.end()));
  }
  EXPECT_THAT(expected, AllOf(HasSubstr("IDa"), HasSubstr("joined In-Phase"), HasSubstr("IDb")));
}

TEST_F(Families, ThatFailAreCoveredByALaterOneThatArrives) {
  for (const Ended& lost :
       {gave_up(work_from(p, 0), "no convergence", 16, 17), start_failed(work_from(p, 0), "lost")}) {
    const FamilyTree::Result result = resolve({ended(base_work(), EndReason::period_limit, 5, 12), located(p),
                                               located(q), lost, arrived(work_from(q, 0), 18, p, 0)});
    EXPECT_THAT(names(result), ElementsAre("In-Phase", "ID"));
    EXPECT_EQ(result.tables.families[1].key, q.leaving(0));
    EXPECT_THAT(result.tables.families[1].end_reason, StartsWith("joined In-Phase at T = 16 "));
    EXPECT_THAT(result.failures, IsEmpty());
    EXPECT_THAT(result.tables.left_out_keys, ElementsAre(p.leaving(0)));
  }
}

TEST_F(Families, ThatFailAreRecorded) {
  const FamilyTree::Result result =
      resolve({ended(base_work(), EndReason::period_limit, 5, 12), located(p), not_located(q, "no sign change"),
               gave_up(work_from(p, 0), "no convergence", 16, 17), start_failed(work_from(p, 1), "no orbit leaves")});
  EXPECT_THAT(names(result), ElementsAre("In-Phase", "IDa", "IDb"));
  EXPECT_EQ(family(result, "IDa").end_reason, "failure (no convergence)");
  EXPECT_EQ(family(result, "IDb").end_reason, "failure (no orbit leaves)");
  EXPECT_EQ(result.tables.crossings.size(), 1U);
  EXPECT_TRUE(result.families[1].failed && result.families[2].failed);
  EXPECT_EQ(result.families[1].orbits, 10);
  EXPECT_EQ(result.families[2].orbits, 0);
  EXPECT_THAT(result.failures,
              ElementsAre("IDa: failure (no convergence)", "IDb: no orbit leaves", "In-Phase: event 2: no sign change"))
      << "by the names that the archive has, and no keys";
}

TEST_F(Families, OnALocationThatDidNotSucceedAreNotCrossings) {
  const FamilyTree::Result result =
      resolve({ended(base_work(), EndReason::period_limit, 5, 12), located(p), located(q),
               arrived(work_from(p, 0), 16, q, 0), ended(work_from(q, 0), EndReason::period_limit, 18, 20),
               not_located({q.leaving(0) + "/000.q2.j1", 17.0, 6.0}, "no root")});
  EXPECT_THAT(result.failures, IsEmpty()) << "of a branch that is left out";
}

Ended with_energies(Ended branch, double from, double to) {
  BranchOutcome outcome = unpack_branch_outcome(branch.outcome.payload);
  outcome.level_from = from;
  outcome.level_to = to;
  branch.outcome.payload = pack(outcome);
  return branch;
}

// Both sides of a direction are different orbits: three times around.
// The first orbits of the two sides may be as far from the birth as they like, and crossings lie between.
TEST_F(Families, SayWhereTheyWereBornAndCrossingsLieFromThere) {
  const Place at{"0000.0000/004.q3.j1", 8.0, 1.0, 3};
  const auto behind = [](Ended branch, double before_first) {
    BranchOutcome outcome = unpack_branch_outcome(branch.outcome.payload);
    outcome.before_first = before_first;
    branch.outcome.payload = pack(outcome);
    return branch;
  };
  const auto on_side = [&](int side, const char* key, double arclength) {
    Ended crossing = located({at.leaving(0) + (side > 0 ? "+" : "-") + key, 25.0, arclength, 1, at.leaving(0), 1}, 0);
    LocateOutcome outcome = unpack_locate_outcome(crossing.outcome.payload);
    outcome.lineage.side = side;
    crossing.outcome.payload = pack(outcome);
    return crossing;
  };
  const FamilyTree::Result result =
      resolve({ended(base_work(), EndReason::period_limit, 5, 12), located(at, 1),
               behind(ended(work_from(at, 0, 1), EndReason::period_limit, 24, 40), 0.5),
               behind(ended(work_from(at, 0, -1), EndReason::period_limit, 24, 40), 0.125),
               on_side(1, "/000.q2.j1", -0.375), on_side(-1, "/000.q2.j1", -0.0625), on_side(-1, "/001.q2.j1", -0.5)});
  EXPECT_TRUE(std::isnan(family(result, "In-Phase").birth_arclength));
  EXPECT_EQ(family(result, "IT3").birth_arclength, -0.5);
  std::vector<double> arclengths;
  for (const archive::CrossingRecord& c : result.tables.crossings) arclengths.push_back(c.arclength);
  EXPECT_THAT(arclengths, ElementsAre(1.0, -0.375, -0.5625, -1.0));
}

TEST_F(Families, WithTwoSidesAreOneAndOneSideMayBeLeftOut) {
  const Place at{"0000.0000/000.q3.j1", 8.0, 1.0, 3};
  const Place to{"0000.0000/001.q3.j1", 9.0, 2.0, 3};
  const std::vector<Ended> begin{ended(base_work(), EndReason::period_limit, 5, 12), located(at, 1), located(to, 1)};
  auto with = [&](std::vector<Ended> more) {
    more.insert(more.begin(), begin.begin(), begin.end());
    return resolve(more);
  };
  FamilyTree::Result result =
      with({with_energies(ended(work_from(at, 0, 1), EndReason::period_limit, 24, 40, 10), -2, 2),
            with_energies(ended(work_from(at, 0, -1), EndReason::energy_limit, 20, 24, 7), -3, -2)});
  ASSERT_THAT(names(result), ElementsAre("In-Phase", "IT3"));
  EXPECT_EQ(result.families[1].orbits, 17);
  EXPECT_EQ(result.families[1].period_from, 20.0);
  EXPECT_EQ(result.families[1].period_to, 40.0);
  EXPECT_EQ(result.families[1].level_from, -3.0);
  EXPECT_EQ(result.families[1].level_to, 2.0);
  EXPECT_EQ(result.families[1].end_reason, "forwards: period limit; backwards: energy limit");
  EXPECT_EQ(result.tables.families[1].first_step, first);
  EXPECT_EQ(result.tables.families[1].last_step, last);

  // The side + of `to` is the side - of `at` run backwards; its side - stays.
  const std::vector<Ended> meeting{
      ended(work_from(at, 0, 1), EndReason::period_limit, 24, 40), arrived(work_from(at, 0, -1), 24, to, 0, 1),
      arrived(work_from(to, 0, 1), 27, at, 0, -1), ended(work_from(to, 0, -1), EndReason::period_limit, 27, 40)};
  result = with(meeting);
  ASSERT_THAT(names(result), ElementsAre("In-Phase", "IT3-1", "IT3-2"));
  EXPECT_EQ(result.tables.families[1].first_step, first);
  EXPECT_EQ(result.tables.families[1].last_step, last);
  EXPECT_EQ(result.tables.families[2].first_step, first);
  EXPECT_EQ(result.tables.families[2].last_step, -1);
  EXPECT_EQ(result.families[2].orbits, 10);
  EXPECT_EQ(result.families[2].end_reason, "period limit");
  EXPECT_THAT(result.families[1].end_reason,
              AllOf(StartsWith("forwards: period limit; backwards: joined In-Phase at T = 27 "), HasSubstr("3 times")));
  EXPECT_THAT(result.tables.left_out_keys, IsEmpty()) << "rows of the side are cut by steps";

  // It is the side - of `to` that is left out.
  result =
      with({ended(work_from(at, 0, 1), EndReason::period_limit, 24, 40), arrived(work_from(at, 0, -1), 24, to, 0, -1),
            ended(work_from(to, 0, 1), EndReason::period_limit, 27, 40),
            ended(work_from(to, 0, -1), EndReason::closed_loop, 24, 27)});
  ASSERT_THAT(names(result), ElementsAre("In-Phase", "IT3-1", "IT3-2"));
  EXPECT_EQ(result.tables.families[2].first_step, 0);
  EXPECT_EQ(result.tables.families[2].last_step, last);
}

TEST_F(Families, OfAClosedCurveKeepOneSide) {
  // Both sides of one direction meet: each arrives at the crossing along the other.
  const Place at{"0000.0000/000.q3.j1", 8.0, 1.0, 3};
  const FamilyTree::Result result =
      resolve({ended(base_work(), EndReason::period_limit, 5, 12), located(at, 1),
               arrived(work_from(at, 0, 1), 24, at, 0, -1), arrived(work_from(at, 0, -1), 24, at, 0, 1)});
  ASSERT_THAT(names(result), ElementsAre("In-Phase", "IT3"));
  EXPECT_EQ(result.tables.families[1].first_step, 0);
  EXPECT_EQ(result.families[1].orbits, 10);
  EXPECT_THAT(result.tables.families[1].end_reason, StartsWith("joined In-Phase at T = 24 "));
}

TEST_F(Families, BeyondTheLimitAreLeftOut) {
  scene.limits.families = 3;
  std::vector<Ended> events{ended(base_work(), EndReason::period_limit, 5, 12), located(p), located(r)};
  for (const Place& place : {r, p})
    for (const int number : {1, 0}) events.push_back(ended(work_from(place, number), EndReason::period_limit, 16, 30));
  const FamilyTree::Result result = resolve(events);
  EXPECT_THAT(names(result), ElementsAre("In-Phase", "IDa", "IDb"));
  EXPECT_THAT(result.tables.left_out_keys, ElementsAre(r.leaving(0), r.leaving(1)));
}

TEST_F(Families, WithinTheLimitKeepBothSides) {
  const Place at{"0000.0000/000.q3.j1", 8.0, 1.0, 3};
  scene.limits.families = 2;
  const FamilyTree::Result result = resolve({ended(base_work(), EndReason::period_limit, 5, 12), located(at, 1),
                                             ended(work_from(at, 0, 1), EndReason::period_limit, 24, 40, 10),
                                             ended(work_from(at, 0, -1), EndReason::energy_limit, 20, 24, 7)});
  ASSERT_THAT(names(result), ElementsAre("In-Phase", "IT3"));
  EXPECT_EQ(result.families[1].orbits, 17);
  EXPECT_EQ(result.tables.families[1].first_step, first);
}

TEST_F(Families, CrossingsAreRowsAsTheyWereLocated) {
  Ended place = located(p, 0);
  LocateOutcome crossing = unpack_locate_outcome(place.outcome.payload);
  crossing.residual = 1e-11;
  crossing.kernel_singular_value = 2e-9;
  crossing.next_singular_value = 0.3;
  crossing.test_value = -4e-8;
  crossing.state = {0.1, 0.2, 0.3, 0.4};
  crossing.q = 4;
  crossing.j = 1;
  crossing.fundamental_order = 2;
  place.outcome.payload = pack(crossing);
  const FamilyTree::Result result = resolve({ended(base_work(), EndReason::period_limit, 5, 12), place});
  ASSERT_EQ(result.tables.crossings.size(), 1U);
  const archive::CrossingRecord& row = result.tables.crossings[0];
  EXPECT_EQ(row.family_key, "0000.0000");
  EXPECT_EQ(row.arclength, p.arclength);
  EXPECT_EQ(row.period, p.period);
  EXPECT_EQ(row.energy, p.energy());
  EXPECT_EQ(row.kind, archive::CrossingKind::period_doubling);
  EXPECT_EQ(row.multiplicity, 2);
  EXPECT_EQ(row.kernel_dimension, 2);
  EXPECT_EQ(row.residual, 1e-11);
  EXPECT_EQ(row.kernel_residual, 2e-9);
  EXPECT_EQ(row.test_value, -4e-8);
  EXPECT_EQ(row.state, crossing.state);
  EXPECT_EQ(row.sector_q, 4);
  EXPECT_EQ(row.sector_j, 1);
  EXPECT_EQ(row.fundamental_order, 2);
}

// Two readings of one fold have one value, and lie between the same orbits; folds of another value, farther off or of
// another kind are their own.
TEST_F(Families, FoldsThatAreReadTwiceAreOneRow) {
  const auto fold = [](int number, double arclength, archive::CrossingKind kind, double value = 1.0) {
    Ended place = located({fmt::format("0000.0000/{:03}.fold", number), 8.0, arclength, 1}, 0);
    LocateOutcome crossing = unpack_locate_outcome(place.outcome.payload);
    crossing.kind = kind;
    crossing.energy = value;
    crossing.within = 1e-3;
    place.outcome.payload = pack(crossing);
    return place;
  };
  using archive::CrossingKind;
  const FamilyTree::Result result =
      resolve({ended(base_work(), EndReason::period_limit, 5, 12), fold(0, 2.0, CrossingKind::fold_energy),
               fold(1, 2.0001, CrossingKind::fold_energy), fold(2, 1.9999, CrossingKind::fold_energy),
               fold(3, 2.0, CrossingKind::fold_period), fold(4, 2.01, CrossingKind::fold_energy),
               fold(7, 2.0001, CrossingKind::fold_energy, 1.0 + 1e-6), fold(5, 2.0, CrossingKind::branch_point),
               fold(6, 2.0, CrossingKind::branch_point)});
  std::vector<std::pair<CrossingKind, double>> rows;
  for (const archive::CrossingRecord& row : result.tables.crossings) rows.emplace_back(row.kind, row.arclength);
  EXPECT_THAT(rows,
              ElementsAre(std::pair(CrossingKind::fold_energy, 2.0), std::pair(CrossingKind::fold_period, 2.0),
                          std::pair(CrossingKind::fold_energy, 2.01), std::pair(CrossingKind::branch_point, 2.0),
                          std::pair(CrossingKind::branch_point, 2.0), std::pair(CrossingKind::fold_energy, 2.0001)));
}

TEST_F(Families, ThatWouldBeBeyondThePeriodLimitAreCounted) {
  scene.limits.period = 2.0 * p.period + 1.0;
  const FamilyTree::Result result =
      resolve({ended(base_work(), EndReason::period_limit, 5, 12), located(p, 0), located(q, 0), located(r, 0)});
  EXPECT_THAT(result.remarks, ElementsAre(StartsWith("2 crossings lead to orbits beyond limits.period")));
}

TEST_F(Families, AreNotWantedWhereAnArrivalHasBeen) {
  FamilyTree tree(scene, pendulum());
  const auto start = [](const BranchWork& work) { return task_of(StartWork{work}); };
  for (const Ended& event : {ended(base_work(), EndReason::period_limit, 5, 12), located(p), located(q)})
    tree.add(event.task, event.outcome);
  EXPECT_TRUE(tree.wanted(start(work_from(q, 0))));
  const Ended arrival = arrived(work_from(p, 0), 16, q, 0);
  tree.add(arrival.task, arrival.outcome);
  EXPECT_FALSE(tree.wanted(start(work_from(q, 0))));
  EXPECT_FALSE(tree.wanted(task_of(work_from(q, 0))));
  EXPECT_TRUE(tree.wanted(start(work_from(q, 1))));
  EXPECT_TRUE(tree.wanted(task_of(work_from(q, 1))));
  EXPECT_TRUE(tree.wanted(task_of(work_from(p, 0))));
  EXPECT_TRUE(tree.wanted(task_of(base_work())));
  EXPECT_TRUE(tree.wanted(located(q).task));
}

TEST_F(Families, BeyondTheLimitAreNotWanted) {
  scene.limits.families = 3;
  FamilyTree tree(scene, pendulum());
  for (const Ended& event :
       {ended(base_work(), EndReason::period_limit, 5, 12), located(p), located(q), located(r),
        arrived(work_from(p, 0), 16, q, 0), ended(work_from(q, 0), EndReason::period_limit, 18, 20)})
    tree.add(event.task, event.outcome);
  // Q's family a is P's from the other end, and counts no more than if it had never run.
  EXPECT_TRUE(tree.wanted(task_of(work_from(q, 1))));
  const Ended third = ended(work_from(q, 1), EndReason::period_limit, 18, 30);
  tree.add(third.task, third.outcome);
  EXPECT_FALSE(tree.wanted(task_of(work_from(r, 0))));
  EXPECT_TRUE(tree.wanted(task_of(work_from(p, 1)))) << "comes before Q's";
  EXPECT_TRUE(tree.wanted(task_of(work_from(q, 1, -1)))) << "the other side of a family that is kept";
}

TEST_F(Families, ThatAreCirclesHaveOneSide) {
  FamilyTree tree(scene, pendulum());
  for (const Ended& event : {ended(base_work(), EndReason::period_limit, 5, 12), located(p), located(q)})
    tree.add(event.task, event.outcome);
  EXPECT_TRUE(tree.wanted(task_of(work_from(q, 1, -1))));
  const Ended circle = ended(work_from(q, 1), EndReason::closed_loop, 18, 30);
  tree.add(circle.task, circle.outcome);
  EXPECT_FALSE(tree.wanted(task_of(work_from(q, 1, -1))));
  EXPECT_TRUE(tree.wanted(task_of(work_from(q, 1))));
  EXPECT_TRUE(tree.wanted(task_of(work_from(q, 0))));
}

}  // namespace
}  // namespace family_tree_test
