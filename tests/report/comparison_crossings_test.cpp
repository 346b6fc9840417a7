// Two atlases: crossings by place, and the ends of families.
#include <gmock/gmock.h>

#include "report/small_trees.hpp"

namespace comparison_crossings_test {
namespace {

using namespace orbweaver;
using namespace orbweaver::test;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

TEST(Comparison, CrossingsHaveAPlace) {
  const auto moved_by = [](double part) {
    return changed([part](Records& records) { records.crossings[1].period *= 1.0 + part; });
  };
  EXPECT_TRUE(compared(tree(), moved_by(5e-10)).same());
  const Comparison comparison = compared(tree(), moved_by(1e-7));
  EXPECT_THAT(kinds(comparison), ElementsAre(DifferenceKind::crossing_place));
  EXPECT_NEAR(comparison.differences[0].by, 1e-7, 1e-9);
  EXPECT_EQ(comparison.differences[0].family_a, "Root");
  report::CompareOptions loose;
  loose.tolerance = 1e-6;
  EXPECT_TRUE(compared(tree(), moved_by(1e-7), loose).same());
  EXPECT_THAT(kinds(compared(tree(), changed([](Records& r) { r.crossings[1].energy += 1e-6; }))),
              ElementsAre(DifferenceKind::crossing_place));
  for (const Records& far : {moved_by(0.05), changed([](Records& r) { r.crossings[1].energy += 0.5; })})
    EXPECT_THAT(kinds(compared(tree(), far)),
                ElementsAre(DifferenceKind::crossing_only_in_a, DifferenceKind::crossing_only_in_b));
}

// What an index leaves open of a place is no difference, and no more than that.
TEST(Comparison, PlacesOfCrossingsMayDifferByTheirErrors) {
  const auto open_by = [](double error, double moved) {
    return changed([&](Records& records) {
      archive::CrossingRecord& crossing = records.crossings[1];
      crossing.place_error = crossing.place_error_period = crossing.place_error_energy = error;
      crossing.period += moved;
      crossing.energy += moved;
    });
  };
  EXPECT_TRUE(compared(open_by(1e-3, 0.0), open_by(1e-3, 1.9e-3)).same());
  EXPECT_TRUE(compared(open_by(1e-3, 0.0), open_by(archive::not_computed, 0.9e-3)).same());
  EXPECT_THAT(kinds(compared(open_by(1e-3, 0.0), open_by(1e-3, 2.1e-3))),
              ElementsAre(DifferenceKind::crossing_place, DifferenceKind::crossing_place));
  EXPECT_TRUE(compared(open_by(0.5, 0.0), open_by(0.5, 0.3)).same()) << "farther than other crossings are near";
}

TEST(Comparison, CrossingsBesideOneAnotherGoToTheNearest) {
  const auto with = [](const std::vector<double>& places) {
    return changed([&](Records& records) {
      records.crossings.pop_back();
      for (const double s : places)
        records.crossings.push_back(crossing_of(other_root, archive::CrossingKind::period_doubling, 2, s));
    });
  };
  EXPECT_THAT(kinds(compared(with({0.3505}), with({0.35, 0.3505}))), ElementsAre(DifferenceKind::crossing_only_in_b));
  EXPECT_THAT(kinds(compared(with({0.35, 0.3505}), with({0.3505}))), ElementsAre(DifferenceKind::crossing_only_in_a));
}

TEST(Comparison, CrossingsOfAFamilyThatTurnsAreNotInTheOrderOfPeriods) {
  const Records turned = changed([](Records& records) {
    records.crossings.push_back(crossing_of(root, archive::CrossingKind::branch_point, 1, 1.5));
    records.crossings.back().period = 6.2;
  });
  const Comparison comparison = compared(turned, turned);
  EXPECT_TRUE(comparison.same());
  EXPECT_EQ(comparison.crossings, 4);
}

TEST(Comparison, CrossingsAreOfAKindAndASector) {
  for (const auto& change : std::vector<std::function<void(Records&)>>{
           [](Records& r) { r.crossings[1].kind = archive::CrossingKind::torus; },
           [](Records& r) { r.crossings[1].multiplicity = 3; }, [](Records& r) { r.crossings[1].sector_q = 3; },
           [](Records& r) { r.crossings[2].sector_j = 0; }})
    EXPECT_THAT(kinds(compared(tree(), changed(change))),
                ElementsAre(DifferenceKind::crossing_only_in_a, DifferenceKind::crossing_only_in_b));
  for (const auto& change :
       std::vector<std::function<void(Records&)>>{[](Records& r) { r.crossings[1].kernel_dimension = 2; },
                                                  [](Records& r) { r.crossings[1].fundamental_order = 2; }})
    EXPECT_THAT(kinds(compared(tree(), changed(change))), ElementsAre(DifferenceKind::crossing_kernel));
}

TEST(Comparison, EndsAreOfAKind) {
  const auto ended = [](const std::string& reason) {
    return changed([reason](Records& records) { records.families[1].end_reason = reason; });
  };
  EXPECT_TRUE(compared(tree(), ended("step limit (7 steps)")).same());
  const Comparison comparison = compared(tree(), ended("cutoff limit (K = 4096)"));
  EXPECT_THAT(kinds(comparison), ElementsAre(DifferenceKind::end_reason));
  EXPECT_THAT(comparison.differences[0].text, HasSubstr("'step limit' in A, by 'cutoff limit' in B"));
}

TEST(Comparison, EndsAtALimitHaveAPlace) {
  const auto limited_at = [](double period) {
    return changed([period](Records& records) {
      records.families[1].end_reason = "period limit (T = 7.5)";
      for (archive::OrbitRecord& orbit : records.orbits)
        if (orbit.family_key == other_root.key && orbit.arclength == limit)
          orbit = orbit_of(other_root, orbit.step, period - other_root.period);
    });
  };
  EXPECT_TRUE(compared(limited_at(7.5), limited_at(7.5)).same());
  EXPECT_THAT(kinds(compared(limited_at(7.5), limited_at(7.49))), ElementsAre(DifferenceKind::end_place));
}

TEST(Comparison, AFamilyThatRunsBackwardsEndsAtItsFirstOrbit) {
  const auto backwards_to = [](double energy) {
    return changed([&](Records& records) {
      records.families[1].end_reason = "energy limit (E = 1.5)";
      for (archive::OrbitRecord& orbit : records.orbits) {
        if (orbit.family_key != other_root.key) continue;
        if (orbit.arclength == limit) orbit.energy += energy;
        orbit.step = -1 - orbit.step;
        orbit.arclength = -orbit.arclength;
      }
    });
  };
  EXPECT_TRUE(compared(backwards_to(0.0), backwards_to(0.0)).same());
  EXPECT_THAT(kinds(compared(backwards_to(0.0), backwards_to(1e-5))), ::testing::Contains(DifferenceKind::end_place));
}

TEST(Comparison, AFamilyWithTwoEndsMayRunTheOtherWay) {
  const auto two_ends = [](double first, const std::string& reason, bool reversed) {
    return changed([&](Records& records) {
      records.families[1].end_reason = reason;
      std::erase_if(records.crossings, [](const auto& crossing) { return crossing.family_key == other_root.key; });
      for (archive::OrbitRecord& orbit : records.orbits) {
        if (orbit.family_key != other_root.key) continue;
        if (orbit.arclength == 0.0) orbit = orbit_of(other_root, orbit.step, first);
        if (orbit.arclength == first) orbit.arclength = 0.0;
        if (!reversed) continue;
        orbit.step = 100 - orbit.step;
        orbit.arclength = limit - orbit.arclength;
      }
    });
  };
  const std::string ends = "forwards: period limit (T = 7.5); backwards: energy limit (E = 0.5)";
  const std::string swapped = "forwards: energy limit (E = 0.5); backwards: period limit (T = 7.5)";
  const Records own = two_ends(0.0, ends, false);
  EXPECT_TRUE(compared(own, own).same());
  EXPECT_TRUE(compared(own, two_ends(0.0, swapped, true)).same());
  const Comparison moved = compared(own, two_ends(0.01, ends, false));
  EXPECT_THAT(kinds(moved), ElementsAre(DifferenceKind::end_place));
  EXPECT_THAT(moved.differences.at(0).text, HasSubstr("ends with energy = 0.5 in A"));
  EXPECT_THAT(kinds(compared(own, two_ends(0.0, swapped, false))),
              ElementsAre(DifferenceKind::end_reason, DifferenceKind::end_reason));
  EXPECT_THAT(kinds(compared(own, two_ends(0.0, "period limit (T = 7.5)", false))),
              ElementsAre(DifferenceKind::end_reason));
  // Shorter at its beginning, which is the other's end.
  Records shorter = two_ends(0.0, swapped, true);
  std::erase_if(shorter.orbits,
                [](const auto& orbit) { return orbit.family_key == other_root.key && orbit.arclength < 0.5; });
  const Comparison further = compared(own, shorter);
  EXPECT_THAT(kinds(further), ElementsAre(DifferenceKind::range, DifferenceKind::end_place));
  EXPECT_THAT(further.differences.at(0).text, HasSubstr("further in A, to T = 7.5"));
  EXPECT_THAT(further.differences.at(0).text, HasSubstr("than in B, which ends at T = 6.9,"));
}

TEST(Comparison, EndsAreAtACrossing) {
  const auto joined = [](int crossing) {
    return changed([crossing](Records& records) {
      records.families[2].end_reason = "joined Root at T = 7 (crossing at T = 7, 1 times around)";
      records.families[2].end_family_key = root.key;
      records.families[2].end_crossing = crossing;
    });
  };
  EXPECT_TRUE(compared(joined(1), joined(1)).same());
  const Comparison comparison = compared(joined(1), joined(0));
  EXPECT_THAT(kinds(comparison), ElementsAre(DifferenceKind::end_target));
  EXPECT_THAT(comparison.differences.at(0).text, HasSubstr("joined Root at branch-point T 7.25 in A"));
  // What only one has is not the same as nothing.
  const Records nowhere = changed([](Records& records) {
    records.crossings.erase(records.crossings.begin() + 1);
    records.families[2].end_reason = "joined Root at T = 7 (crossing at T = 7, 1 times around)";
    records.families[2].end_family_key = root.key;
  });
  EXPECT_THAT(kinds(compared(joined(1), nowhere)),
              ElementsAre(DifferenceKind::crossing_only_in_a, DifferenceKind::end_target));
}

}  // namespace
}  // namespace comparison_crossings_test
