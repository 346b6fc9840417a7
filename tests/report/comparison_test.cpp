#include "orbweaver/report/compare/comparison.hpp"

#include <cmath>
#include <filesystem>
#include <functional>
#include <numbers>
#include <sstream>

#include <gmock/gmock.h>

#include "orbweaver/report/compare/comparison_text.hpp"
#include "report/small_trees.hpp"

namespace comparison_test {
namespace {

using namespace orbweaver;
using namespace orbweaver::test;
using ::testing::Contains;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

TEST(Comparison, OtherStepsAreNoDifference) {
  const Comparison same = compared(tree(0.1), tree(0.1));
  EXPECT_THAT(same.differences, IsEmpty());
  const Comparison finer = compared(tree(0.1), tree(0.013));
  EXPECT_THAT(finer.differences, IsEmpty());
  EXPECT_EQ(finer.families, 4);
  EXPECT_EQ(finer.crossings, 3);
  EXPECT_EQ(finer.orbits, finer.a.orbits + finer.b.orbits);
  EXPECT_THAT(finer.largest, Not(IsEmpty()));
}

TEST(Comparison, ExchangedLettersOfTwinsAreARenaming) {
  const Records exchanged = changed([](Records& records) {
    for (archive::OrbitRecord& orbit : records.orbits) {
      if (orbit.family_key == first_twin.key)
        orbit.family_key = second_twin.key;
      else if (orbit.family_key == second_twin.key)
        orbit.family_key = first_twin.key;
    }
  });
  const Comparison loose = compared(tree(), exchanged);
  EXPECT_TRUE(loose.same());
  ASSERT_THAT(loose.renamed, SizeIs(2));
  EXPECT_EQ(loose.renamed[0].a, "RDa");
  EXPECT_EQ(loose.renamed[0].b, "RDb");
  report::CompareOptions strict;
  strict.strict_names = true;
  EXPECT_THAT(kinds(compared(tree(), exchanged, strict)), ElementsAre(DifferenceKind::name, DifferenceKind::name));
}

TEST(Comparison, RootsAreMatchedByTheirOrbits) {
  const Records exchanged = changed([](Records& records) {
    records.families[0].name = "Other";
    records.families[1].name = "Root";
  });
  const Comparison comparison = compared(tree(), exchanged);
  EXPECT_TRUE(comparison.same());
  EXPECT_THAT(comparison.renamed, SizeIs(2));
}

// By their orbits two mirror images are one family; which is which their names say.
TEST(Comparison, MirrorImagesGoByTheirNames) {
  const auto with_image = [](double spacing, bool is_first) {
    Records records = tree(spacing);
    Curve image = other_root;
    image.key = is_first ? "00000" : "0002";
    records.families.push_back(test::family_of(image.key, "Image", "", -1, 1));
    test::add_orbits(records, image, 0.9 * spacing);
    return records;
  };
  for (const bool is_first : {true, false}) {
    const Comparison comparison = compared(with_image(0.1, false), with_image(0.09, is_first));
    EXPECT_THAT(comparison.differences, IsEmpty());
    EXPECT_THAT(comparison.renamed, IsEmpty());
  }
}

/// The tree with other energies on one family, from s = `from` on.
Records bent(
    const std::string& key, double from, const std::function<void(Records&)>& change = [](Records&) {}) {
  return changed([&](Records& records) {
    for (archive::OrbitRecord& orbit : records.orbits)
      if (orbit.family_key == key && orbit.arclength > from + 1e-9) orbit.energy += 0.3 * (orbit.arclength - from);
    change(records);
  });
}

TEST(Comparison, FamiliesThatShareAFewOrbitsAreTwo) {
  const Comparison comparison =
      compared(tree(), bent(other_root.key, 0.35, [](Records& r) { r.families[1].name = "X"; }));
  EXPECT_THAT(kinds(comparison), ElementsAre(DifferenceKind::only_in_a, DifferenceKind::only_in_b));
}

TEST(Comparison, FamiliesOfANameOrAPlaceAreComparedWhateverTheirOrbits) {
  for (const std::string& key : {other_root.key, first_twin.key})
    for (const DifferenceKind kind : kinds(compared(tree(), bent(key, -0.5)))) EXPECT_EQ(kind, DifferenceKind::orbits);
  const Comparison renamed =
      compared(tree(), bent(first_twin.key, -0.5, [](Records& r) { r.families[2].name = "RDc"; }));
  EXPECT_THAT(renamed.renamed, SizeIs(1));
  for (const DifferenceKind kind : kinds(renamed)) EXPECT_EQ(kind, DifferenceKind::orbits);
  EXPECT_THAT(kinds(compared(tree(), bent(first_twin.key, -0.5, [](Records& r) { r.families[2].isotropy = "RS@0"; }))),
              ElementsAre(DifferenceKind::only_in_a, DifferenceKind::only_in_b));
  // Of two, those of one name.
  const Records both = bent(first_twin.key, -0.5, [](Records& records) {
    for (archive::OrbitRecord& orbit : records.orbits)
      if (orbit.family_key == second_twin.key) orbit.energy -= 0.7;
    std::swap(records.families[2].name, records.families[3].name);
  });
  EXPECT_THAT(compared(tree(), both).renamed, IsEmpty());
}

void keep(Records& records, const std::string& key, double from, double to) {
  std::erase_if(records.orbits, [&](const archive::OrbitRecord& orbit) {
    return orbit.family_key == key && (orbit.arclength < from - 1e-9 || orbit.arclength > to + 1e-9);
  });
}

TEST(Comparison, OrbitsThatOnlyOneHasSayNothingOfIdentity) {
  const auto with = [](double from, double to) {
    return changed([&](Records& records) { keep(records, other_root.key, from, to); });
  };
  Records late = with(1.0, 2.0);
  late.families[1].name = "X";
  const Comparison comparison = compared(with(0.0, 1.2), late);
  EXPECT_EQ(comparison.families, 4);
  EXPECT_THAT(comparison.renamed, SizeIs(1));
  EXPECT_THAT(kinds(comparison), ElementsAre(DifferenceKind::range));
}

TEST(Comparison, FamiliesMayBeginALittleApart) {
  const auto from = [](double s) {
    return changed([&](Records& records) { keep(records, other_root.key, s, limit); });
  };
  EXPECT_TRUE(compared(tree(), from(0.8)).same());
  EXPECT_THAT(kinds(compared(tree(), from(1.3))), ElementsAre(DifferenceKind::range));
}

TEST(Comparison, FamiliesMayPart) {
  const Comparison comparison = compared(tree(), bent(other_root.key, 1.2));
  EXPECT_THAT(kinds(comparison), ElementsAre(DifferenceKind::orbits));
  EXPECT_THAT(comparison.differences.at(0).text, HasSubstr("A and B part at"));
}

TEST(Comparison, FewOrbitsAreHeldAgainstAChordOrAPoint) {
  const auto without = [](double from, double to, double energy) {
    return changed([&](Records& records) {
      std::erase_if(records.orbits, [&](const archive::OrbitRecord& orbit) {
        return orbit.family_key == other_root.key && orbit.arclength > from && orbit.arclength < to;
      });
      for (archive::OrbitRecord& orbit : records.orbits)
        if (orbit.family_key == other_root.key) orbit.energy += energy;
    });
  };
  EXPECT_TRUE(compared(tree(), without(0.05, 1.95, 0.0)).same());
  EXPECT_TRUE(compared(without(0.05, 3.0, 0.0), without(0.05, 3.0, 0.0)).same());
  EXPECT_THAT(kinds(compared(without(0.05, 3.0, 0.0), without(0.05, 3.0, 1e-6))),
              ElementsAre(DifferenceKind::orbits, DifferenceKind::orbits));
  EXPECT_THAT(kinds(compared(tree(), without(-1.0, 3.0, 0.0))), ::testing::Contains(DifferenceKind::range));
}

TEST(Comparison, SaysWhatIsInOneOnly) {
  const Records without = changed([](Records& records) {
    records.families.pop_back();
    std::erase_if(records.orbits, [](const auto& orbit) { return orbit.family_key == second_twin.key; });
  });
  const Comparison more = compared(tree(), without);
  EXPECT_THAT(kinds(more), ElementsAre(DifferenceKind::only_in_a));
  EXPECT_EQ(more.differences[0].family_a, "RDb");
  EXPECT_THAT(more.differences[0].text, HasSubstr("born on Root at period-doubling T 6.55, 21 orbits"));
  EXPECT_THAT(kinds(compared(without, tree())), ElementsAre(DifferenceKind::only_in_b));
}

TEST(Comparison, SaysWhereAFamilyWasBornElsewhere) {
  const Records moved = changed([](Records& records) {
    records.families[3].crossing = 2;
    records.families[3].parent_key = "0001";
    records.families[3].end_reason = "period limit (T = 15.1)";  // at the other end
  });
  const Comparison comparison = compared(tree(), moved);
  EXPECT_THAT(kinds(comparison), ElementsAre(DifferenceKind::birth));
  EXPECT_THAT(comparison.differences[0].text, HasSubstr("born on Root at period-doubling T 6.55 in A, on Other at"));
}

TEST(Comparison, OneMayGoFurther) {
  const Records shorter = changed([](Records& records) {
    std::erase_if(records.orbits, [](const archive::OrbitRecord& orbit) {
      return orbit.family_key == other_root.key && orbit.arclength > 1.45;
    });
  });
  const Comparison comparison = compared(tree(), shorter);
  EXPECT_THAT(kinds(comparison), ElementsAre(DifferenceKind::range));
  EXPECT_THAT(comparison.differences[0].text, HasSubstr("goes 6 orbits further in A, to T = 7.5"));
  // One step more or less is a matter of the steps.
  EXPECT_TRUE(compared(tree(), changed([](Records& records) {
                         std::erase_if(records.orbits, [](const archive::OrbitRecord& orbit) {
                           return orbit.family_key == other_root.key && orbit.arclength > 1.95;
                         });
                       }))
                  .same());
}

// Nothing but the steps says how near to a collision, or how far, a family is followed.
TEST(Comparison, OpenEndsHaveNoPlace) {
  const auto ended = [](const std::string& reason, double last) {
    return changed([&](Records& records) {
      records.families[1].end_reason = reason;
      std::erase_if(records.orbits, [last](const archive::OrbitRecord& orbit) {
        return orbit.family_key == other_root.key && orbit.arclength > last;
      });
    });
  };
  for (const std::string reason : {"collision with the Moon (r2 = 1e-5)", "period divergence (T = 70)"}) {
    const Comparison comparison = compared(ended(reason, 3.0), ended(reason, 1.45));
    EXPECT_TRUE(comparison.same()) << reason;
    EXPECT_THAT(comparison.notes, Contains(HasSubstr("goes 6 orbits further in A")));
  }
  EXPECT_THAT(kinds(compared(ended("guard limit (r2 = 0.01)", 3.0), ended("guard limit (r2 = 0.01)", 1.45))),
              ElementsAre(DifferenceKind::range));
}

TEST(Comparison, OrbitsLieOnACurve) {
  const auto off_by = [](double part, auto value) {
    return changed([part, value](Records& records) {
      for (archive::OrbitRecord& orbit : records.orbits)
        if (orbit.family_key == other_root.key && orbit.step == 7) value(orbit) += part;
    });
  };
  const auto energy = [](archive::OrbitRecord& orbit) -> double& { return orbit.energy; };
  const auto action = [](archive::OrbitRecord& orbit) -> double& { return orbit.action; };
  const auto stability = [](archive::OrbitRecord& orbit) -> double& { return orbit.stability[0]; };
  EXPECT_TRUE(compared(tree(), off_by(1e-11, energy)).same());
  EXPECT_FALSE(compared(tree(), off_by(1e-8, energy)).same());
  for (const Comparison& comparison : {compared(tree(), off_by(1e-6, energy)), compared(tree(), off_by(1e-6, action)),
                                       compared(tree(), off_by(1e-5, stability))}) {
    ASSERT_FALSE(comparison.same());
    for (const DifferenceKind kind : kinds(comparison)) EXPECT_EQ(kind, DifferenceKind::orbits);
    EXPECT_EQ(comparison.differences[0].family_a, "Other");
  }
}

TEST(Comparison, NumbersAreKnownInBoth) {
  const auto unknown = [](int steps, auto value) {
    return changed([steps, value](Records& records) {
      for (archive::OrbitRecord& orbit : records.orbits)
        if (orbit.family_key == other_root.key && orbit.step < steps) value(orbit) = archive::not_computed;
    });
  };
  const auto energy = [](archive::OrbitRecord& orbit) -> double& { return orbit.energy; };
  const auto action = [](archive::OrbitRecord& orbit) -> double& { return orbit.action; };
  const auto stability = [](archive::OrbitRecord& orbit) -> double& { return orbit.stability[0]; };
  for (const Records& less : {unknown(100, energy), unknown(1, energy), unknown(3, action), unknown(100, stability)}) {
    EXPECT_TRUE(compared(less, less).same());
    for (const Comparison& comparison : {compared(tree(), less), compared(less, tree())}) {
      ASSERT_FALSE(comparison.same());
      EXPECT_THAT(kinds(comparison), Each(DifferenceKind::orbits));
      EXPECT_THAT(comparison.differences[0].text, HasSubstr(" is known in "));
    }
  }
  EXPECT_TRUE(compared(tree(), unknown(3, stability)).same());
  const Records nowhere = changed([](Records& r) { r.crossings[1].energy = archive::not_computed; });
  EXPECT_TRUE(compared(nowhere, nowhere).same());
  EXPECT_THAT(kinds(compared(tree(), nowhere)), ElementsAre(DifferenceKind::crossing_place));
}

TEST(Comparison, StabilityCountsAsFarAsItIsCertain) {
  const auto off_by = [](double part, double error) {
    return changed([&](Records& records) {
      for (archive::OrbitRecord& orbit : records.orbits) {
        orbit.stability_error = error;
        if (orbit.family_key == other_root.key && orbit.step == 7) orbit.stability[0] += part;
      }
    });
  };
  EXPECT_FALSE(compared(off_by(0.0, 1e-12), off_by(1e-5, 1e-12)).same());
  EXPECT_TRUE(compared(off_by(0.0, 1e-4), off_by(1e-5, 1e-4)).same());
  EXPECT_TRUE(compared(off_by(0.0, 1e-2), off_by(1.0, 1e-2)).same());
}

TEST(Comparison, TheWorstOrbitIsNamed) {
  const Comparison comparison = compared(tree(), changed([](Records& records) {
                                           for (archive::OrbitRecord& orbit : records.orbits) {
                                             if (orbit.family_key != other_root.key) continue;
                                             if (orbit.step == 3) orbit.energy += 1e-6;
                                             if (orbit.step == 14) orbit.energy += 1e-4;
                                           }
                                         }));
  std::string all;
  for (const report::Difference& difference : comparison.differences) all += difference.text + "\n";
  EXPECT_THAT(all, HasSubstr("orbits of B lie off the curve of the other: action at T = 6.9,"));
}

TEST(Comparison, FamiliesHaveAnIsotropy) {
  EXPECT_THAT(kinds(compared(tree(), changed([](Records& r) { r.families[2].isotropy = "RS@0"; }))),
              ElementsAre(DifferenceKind::isotropy));
}

TEST(Comparison, OtherCoordinatesAreTheOnlyDifference) {
  archive::Header header = test::sample_header();
  header.state_names = {"q", "p"};
  const Comparison comparison = report::compare(written("a", tree()), written("b", tree(0.3), header));
  EXPECT_THAT(kinds(comparison), ElementsAre(DifferenceKind::system));
  EXPECT_THAT(comparison.differences[0].text, HasSubstr("q, p in B"));
}

TEST(Comparison, AFamilyGoesAroundItsParentAsOften) {
  EXPECT_THAT(kinds(compared(tree(), changed([](Records& r) { r.families[2].multiplicity = 4; }))),
              ElementsAre(DifferenceKind::birth));
}

TEST(Comparison, OtherParametersAreAnotherSystem) {
  const auto with_mass = [](const std::string& name, int mass) {
    archive::Header header = test::sample_header();
    header.scene = "system: {name: double_pendulum, parameters: {m1: " + std::to_string(mass) +
                   "}}\nstarts: {fixed_points: {grid: [[0], [0]]}}\n";
    return written(name, {}, header);
  };
  EXPECT_TRUE(report::compare(with_mass("a", 2), with_mass("b", 2)).same());
  const Comparison comparison = report::compare(with_mass("a", 2), with_mass("b", 3));
  EXPECT_THAT(kinds(comparison), ElementsAre(DifferenceKind::system));
  EXPECT_THAT(comparison.differences[0].text, HasSubstr("m1 = 3"));
}

TEST(Comparison, AnotherSceneIsANote) {
  archive::Header header = test::sample_header();
  header.scene += "limits: {period: 10}\n";
  header.orbweaver_version = "0.2.0";
  const Comparison comparison = report::compare(written("a", tree()), written("b", tree(), header));
  EXPECT_TRUE(comparison.same());
  EXPECT_THAT(comparison.notes, ElementsAre(HasSubstr("loops are compared where both have an orbit at one place"),
                                            HasSubstr("scenes differ"), HasSubstr("0.2.0")));
}

TEST(Comparison, IsPrinted) {
  Comparison comparison = compared(tree(), changed([](Records& r) { r.crossings[1].period += 1e-6; }));
  std::ostringstream text;
  report::print_comparison(text, comparison);
  EXPECT_THAT(text.str(), HasSubstr("\nRoot\n    branch-point T 7.25: period is 7.25 in A, 7.250001 in B"));
  EXPECT_THAT(text.str(), HasSubstr("period of crossings"));
  EXPECT_THAT(text.str(), HasSubstr("\n1 difference\n"));
  std::ostringstream json;
  comparison.differences[0].text = "say \"why\"";
  report::print_comparison_json(json, comparison);
  EXPECT_THAT(json.str(), HasSubstr("\"same\": false"));
  EXPECT_THAT(json.str(), HasSubstr(R"({"kind": "crossing-place", "family_a": "Root", "family_b": "Root", )"));
  EXPECT_THAT(json.str(), HasSubstr(R"("text": "say \"why\"", "by": 1.37)"));
}

}  // namespace
}  // namespace comparison_test
