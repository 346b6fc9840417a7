#include "tree/family_names.hpp"

#include <gmock/gmock.h>

#include <set>

#include <fmt/format.h>

namespace family_names_test {
namespace {

using namespace orbweaver::survey;
using ::testing::ElementsAre;

TEST(TwinLetters, GoOnBeyondZ) {
  EXPECT_EQ(twin_letters(0), "a");
  EXPECT_EQ(twin_letters(25), "z");
  EXPECT_EQ(twin_letters(26), "aa");
  EXPECT_EQ(twin_letters(27), "ab");
  EXPECT_EQ(twin_letters(26 + 26 * 26 - 1), "zz");
  EXPECT_EQ(twin_letters(26 + 26 * 26), "aaa");
}

class FamilyNames : public ::testing::Test {
 protected:
  void base(const std::string& key, const std::string& name) {
    families.push_back({key, {key, "", 0, 1, 1}, {}, name});
  }
  void place(const std::string& key, const std::string& parent, double arclength) {
    LocateOutcome crossing;
    crossing.key = key;
    crossing.lineage.family = parent;
    crossing.arclength = arclength;
    crossings.emplace(key, crossing);
  }
  void born(const std::string& crossing, int number, int depth, int multiplicity) {
    const std::string key = fmt::format("{}/{:03}", crossing, number);
    families.push_back({key, {key, crossing, depth, multiplicity, 1}, {}, ""});
  }
  std::vector<std::string> names() {
    name_families(families, crossings, {{"In-Phase", "I"}, {"Odd", "ID"}});
    std::vector<std::string> out;
    for (const Family& family : families) out.push_back(family.name);
    return out;
  }
  std::vector<Family> families;
  Crossings crossings;
};

TEST_F(FamilyNames, OfManyTwinsDiffer) {
  base("0", "In-Phase");
  place("0/0", "0", 1.0);
  for (int n = 0; n < 60; ++n) born("0/0", n, 1, 2);
  for (int n = 0; n < 60; ++n) {
    const std::string parent = fmt::format("0/0/{:03}", n);
    place(parent + "/0", parent, 1.0);
    for (int m = 0; m < 30; ++m) born(parent + "/0", m, 2, 2);
  }
  const std::vector<std::string> all = names();
  EXPECT_EQ(all[1], "IDa");
  EXPECT_EQ(all[27], "IDaa");
  EXPECT_EQ(all[61], "IDaDa");
  EXPECT_EQ(all[61 + 26 * 30], "IDaaDa");
  EXPECT_EQ(std::set<std::string>(all.begin(), all.end()).size(), all.size());
  for (const std::string& name : all) EXPECT_EQ(name.find(' '), std::string::npos) << name;
}

TEST_F(FamilyNames, OfTwinsGoByKeyWhateverTheirOrder) {
  base("0", "In-Phase");
  place("0/0", "0", 1.0);
  for (const int n : {2, 0, 1}) born("0/0", n, 1, 2);
  EXPECT_THAT(names(), ElementsAre("In-Phase", "IDc", "IDa", "IDb"));
}

TEST_F(FamilyNames, ThatABaseFamilyHasAddTheKey) {
  base("0", "In-Phase");
  base("1", "ID");
  place("0/0", "0", 1.0);
  born("0/0", 0, 1, 2);
  EXPECT_THAT(names(), ElementsAre("In-Phase", "ID", "ID (0/0/000)"));
}

TEST_F(FamilyNames, ThatAreTakenAddTheKey) {
  base("0", "In-Phase");
  base("1", "Odd");
  place("0/0", "0", 1.0);
  place("1/0", "1", 1.0);
  place("0/0/000/0", "0/0/000", 1.0);
  born("0/0", 0, 1, 2);
  born("1/0", 0, 1, 1);
  born("0/0/000/0", 0, 2, 1);
  EXPECT_THAT(names(), ElementsAre("In-Phase", "Odd", "ID", "IDB", "IDB (0/0/000/0/000)"));
}

}  // namespace
}  // namespace family_names_test
