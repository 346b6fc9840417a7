#include <gmock/gmock.h>

#include <cmath>
#include <functional>

#include "archive/sample.hpp"
#include "system/tree_problems.hpp"

namespace check_tree_test {
namespace {

using namespace orbweaver;
using archive::CrossingRecord;
using archive::FamilyRecord;
using archive::OrbitRecord;
using archive::Records;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr int base_key = 0, child_key = 1, grandchild_key = 2;  // rows of the families

OrbitRecord orbit(const std::string& key, int step, double period, double energy, double index) {
  OrbitRecord row = test::sample_records(test::sample_header()).orbits.front();
  row.family_key = key;
  row.step = step;
  row.arclength = 0.5 * step;
  row.period = period;
  row.energy = energy;
  row.stability = {index * index - 2};
  row.fundamental_stability = {index};
  row.stability_error = 1e-11;
  return row;
}

FamilyRecord family(const std::string& key, const std::string& name, const std::string& parent, int crossing, int m) {
  FamilyRecord record;
  record.key = key;
  record.name = name;
  record.parent_key = parent;
  record.crossing = crossing;
  record.multiplicity = m;
  record.end_reason = "period limit (T = 60)";
  return record;
}

CrossingRecord crossing(const std::string& key, double arclength, double period, double energy,
                        archive::CrossingKind kind, int m, int j, int q) {
  CrossingRecord record;
  record.family_key = key;
  record.arclength = arclength;
  record.period = period;
  record.energy = energy;
  record.kind = kind;
  record.multiplicity = m;
  record.sector_j = j;
  record.sector_q = q;
  record.kernel_dimension = 1;
  record.test_value = 2 * std::cos(2 * std::acos(-1.0) * j / q);
  record.residual = 1e-12;
  record.state = {0, 0};
  return record;
}

// A base family with two crossings, a child on both sides of its birth that joins the base at the second, a grandchild.
Records sound_tree() {
  Records tree;
  tree.families = {family("0", "Base", "", -1, 1), family("0.1", "Child", "0", 0, 2),
                   family("0.1.1", "Grandchild", "0.1", 2, 3)};
  tree.families[child_key].end_family_key = "0";
  tree.families[child_key].end_crossing = 1;
  tree.crossings = {crossing("0", 1.25, 5, -1, archive::CrossingKind::subharmonic, 2, 1, 4),
                    crossing("0", 3.75, 6, 0, archive::CrossingKind::branch_point, 1, 0, 1),
                    crossing("0.1", -0.75, 9.7, -0.9, archive::CrossingKind::subharmonic, 3, 1, 3),
                    crossing("0", 4.25, 6.5, 0.5, archive::CrossingKind::fold_energy, 1, 0, 1)};
  tree.crossings.back().residual = tree.crossings.back().test_value = archive::not_computed;
  for (int step = 0; step <= 9; ++step) tree.orbits.push_back(orbit("0", step, 4 + 0.3 * step, -2 + step / 3.0, -1.5));
  for (int step = -3; step <= 3; ++step)
    tree.orbits.push_back(orbit("0.1", step, 10 + 0.2 * step, -1 - 0.01 * step, 0.3));
  for (int step = 1; step <= 3; ++step) tree.orbits.push_back(orbit("0.1.1", step, 29 + 0.1 * step, -0.9, 0.1));
  return tree;
}

// The problems of the sound tree after this change.
std::vector<std::string> problems_of(const std::function<void(Records&)>& change,
                                     const test::TreeOptions& options = {}) {
  Records tree = sound_tree();
  change(tree);
  const auto folder = test::fresh_folder("tree");
  return test::tree_problems(archive::Archive(test::write_sample_atlas(folder, test::sample_header(), tree)), options);
}

std::vector<OrbitRecord>::iterator orbit_of(Records& tree, const std::string& key, int step) {
  return std::find_if(tree.orbits.begin(), tree.orbits.end(),
                      [&](const OrbitRecord& o) { return o.family_key == key && o.step == step; });
}

TEST(CheckTree, FindsNothingInASoundTree) {
  EXPECT_THAT(problems_of([](Records&) {}, {0, 1}), IsEmpty());
  EXPECT_THAT(problems_of([](Records& t) { t = {}; }, {0, 0}), IsEmpty());
}

TEST(CheckTree, ReferencesThatDoNotFit) {
  EXPECT_THAT(problems_of([](Records& t) { t.families[grandchild_key].crossing = 0; }),
              Contains(HasSubstr("family 2 (Grandchild) was born at crossing 0 (subharmonic at T = 5), which belongs "
                                 "to family 0 and not to its parent 1")));
  EXPECT_THAT(problems_of([](Records& t) { t.families[child_key].crossing = -1; }),
              ElementsAre("family 1 (Child) has parent 0 and crossing -1: one of them is missing"));
  EXPECT_THAT(problems_of([](Records& t) { t.families[child_key].parent_key.clear(); }),
              ElementsAre(HasSubstr("has parent -1 and crossing 0: one of them is missing")));
  EXPECT_THAT(problems_of([](Records& t) {
                t.families[base_key].parent_key = "0.1.1";
                t.families[base_key].crossing = 2;
              }),
              Contains("family 0 (Base) is its own ancestor"));
  EXPECT_THAT(problems_of([](Records& t) { t.families[child_key].end_family_key = "0.1.1"; }),
              ElementsAre(HasSubstr("belongs to family 0 and not to family 2, which it joined")));
  EXPECT_THAT(problems_of([](Records& t) { t.families[child_key].end_family_key.clear(); }),
              ElementsAre(HasSubstr("belongs to family 0 and not to family -1, which it joined")));
  EXPECT_THAT(problems_of([](Records&) {}, {0, 4}), ElementsAre("1 families have no parent, where 4 were expected"));
}

TEST(CheckTree, NamesAndEndReasons) {
  EXPECT_THAT(problems_of([](Records& t) { t.families[child_key].name = "Base"; }),
              ElementsAre("two families have the name Base"));
  EXPECT_THAT(problems_of([](Records& t) { t.families[child_key].name.clear(); }), ElementsAre("a family has no name"));
  const auto fail = [](Records& t) { t.families[child_key].end_reason = "failure (no step converged)"; };
  EXPECT_THAT(problems_of(fail), ElementsAre("family 1 (Child): failure (no step converged)"));
  EXPECT_THAT(problems_of(fail, {1, -1}), IsEmpty());
}

TEST(CheckTree, WhereAFamilyBegins) {
  EXPECT_THAT(problems_of([](Records& t) { t.families[child_key].multiplicity = 1; }),
              Contains(HasSubstr("family 1 (Child) has multiplicity 1, and crossing 0 (subharmonic at T = 5) has 2")));
  EXPECT_THAT(problems_of([](Records& t) { orbit_of(t, "0.1", 0)->period = 10.6; }),
              ElementsAre(HasSubstr("begins with T = 10.6, where 2 times around crossing 0 (subharmonic at T = 5) is "
                                    "10")));
  EXPECT_THAT(problems_of([](Records& t) { orbit_of(t, "0.1", 0)->energy = -0.8; }),
              ElementsAre(HasSubstr("family 1 (Child) begins 0.2 in energy away from crossing 0")));
  EXPECT_THAT(problems_of([](Records& t) { orbit_of(t, "0.1", 3)->period = 20; }), IsEmpty()) << "far from its birth";
}

TEST(CheckTree, StepsWithAHole) {
  EXPECT_THAT(problems_of([](Records& t) {
                t.orbits.erase(orbit_of(t, "0.1", -1));
                std::erase_if(t.sections, [](const auto&) { return true; });
              }),
              ElementsAre("family 1 (Child) goes from step -2 to step 0"));
}

TEST(CheckTree, CrossingsOutsideTheirFamily) {
  EXPECT_THAT(problems_of([](Records& t) { t.crossings[3].arclength = 4.8; }),
              ElementsAre(HasSubstr("lies at arclength 4.8, outside family 0 (Base) (0 .. 4.5)")));
  EXPECT_THAT(problems_of([](Records& t) { t.crossings[3].arclength = -0.3; }),
              ElementsAre(HasSubstr("lies at arclength -0.3, outside")));
  EXPECT_THAT(problems_of([](Records& t) { t.crossings[3].arclength = 4.7; }), IsEmpty()) << "half a step beyond";
  EXPECT_THAT(problems_of([](Records& t) {
                std::erase_if(t.orbits, [](const OrbitRecord& o) { return o.family_key == "0.1"; });
              }),
              ElementsAre(HasSubstr("lies on family 1 (Child), which has no orbits")));
}

TEST(CheckTree, CrossingsThatAreNotLocated) {
  EXPECT_THAT(problems_of([](Records& t) { t.crossings[0].test_value += 2e-9; }),
              ElementsAre(HasSubstr("was located with an index 2e-09 from 2 cos(2 pi 1/4), where 1e-09 is allowed")));
  EXPECT_THAT(problems_of([](Records& t) { t.crossings[0].test_value += 0.9e-9; }), IsEmpty());
  EXPECT_THAT(problems_of([](Records& t) { t.crossings[2].test_value = archive::not_computed; }),
              ElementsAre(HasSubstr("with an index nan from")));
  EXPECT_THAT(problems_of([](Records& t) { t.crossings[2].residual = -3e-9; }),
              ElementsAre(HasSubstr("has a residual of 3e-09")));
  EXPECT_THAT(problems_of([](Records& t) { t.crossings[3].test_value = 7; }), IsEmpty()) << "a fold has no sector";
  const auto blurred = [](Records& t) {
    t.crossings[0].test_value += 2e-9;
    orbit_of(t, "0", 2)->stability_error = 3e-9;  // one of the two around arclength 1.25
  };
  EXPECT_THAT(problems_of(blurred), IsEmpty());
  const auto steep = [](Records& t) {
    t.crossings[0].test_value += 2e-9;
    orbit_of(t, "0", 3)->fundamental_stability = {20};  // dk/ds = 43
  };
  EXPECT_THAT(problems_of(steep), IsEmpty());
}

}  // namespace
}  // namespace check_tree_test
