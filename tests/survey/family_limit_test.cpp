#include "tree/family_limit.hpp"

#include <gtest/gtest.h>

#include <map>
#include <random>
#include <set>
#include <string>

#include <fmt/format.h>

namespace family_limit_test {
namespace {

using orbweaver::survey::FamilyLimit;

TEST(FamilyLimit, HasRoomForTheFirstFamiliesWhateverComesAndGoes) {
  std::mt19937 random(3);
  for (const int most : {1, 3, 10}) {
    FamilyLimit limit(most);
    std::map<FamilyLimit::Place, std::string> counted;
    for (int n = 0; n < 2000; ++n) {
      const FamilyLimit::Place place(static_cast<int>(random() % 3), fmt::format("{:02}", random() % 20));
      const std::string family = fmt::format("family {} {}", place.first, std::stoi(place.second) / 2);
      const bool counts = random() % 2 == 0;
      limit.count(place, family, counts);
      if (counts)
        counted[place] = family;
      else
        counted.erase(place);
      const FamilyLimit::Place asked(static_cast<int>(random() % 3), fmt::format("{:02}", random() % 20));
      const std::string its = fmt::format("family {} {}", asked.first, std::stoi(asked.second) / 2);
      std::set<std::string> earlier;
      for (const auto& [other, name] : counted)
        if (other < asked) earlier.insert(name);
      ASSERT_EQ(limit.has_room(asked, its), earlier.contains(its) || static_cast<int>(earlier.size()) < most)
          << "most " << most << ", after " << n;
    }
  }
}

}  // namespace
}  // namespace family_limit_test
