#include <numeric>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include <gmock/gmock.h>

#include "orbweaver/core/mpi/team.hpp"

namespace team_test {
namespace {

namespace core = orbweaver::core;
using testing::HasSubstr;

/// What a call threw: "" for nothing, else the type's letter (N not finite, M numerical, T team) and the text.
template <class Call>
std::string thrown_by(const Call& call) {
  try {
    call();
    return "";
  } catch (const core::NotFiniteError& error) {
    return std::string("N ") + error.what();
  } catch (const core::NumericalError& error) {
    return std::string("M ") + error.what();
  } catch (const core::TeamError& error) {
    return std::string("T ") + error.what();
  }
}

class Team : public testing::Test {
 protected:
  core::Team team{MPI_COMM_WORLD};
  int last = team.size() - 1;

  std::vector<double> divided() {
    std::vector<double> values(7 * 3, -1.0);
    team.divide("squares", 7, 3, values.data(), [&](int begin, int end) {
      for (int n = 3 * begin; n < 3 * end; ++n) values[static_cast<std::size_t>(n)] = n * n;
    });
    return values;
  }
  void expect_whole() {
    const std::vector<double> values = divided();
    for (std::size_t n = 0; n < values.size(); ++n) EXPECT_EQ(values[n], static_cast<double>(n * n));
  }
};

TEST_F(Team, PartsCoverEverythingOnceAndInOrder) {
  for (const int count : {0, 1, 2, 5, 96}) {
    int next = 0;
    for (int m = 0; m < team.size(); ++m) {
      EXPECT_EQ(team.part_of(m, count).begin, next);
      next = team.part_of(m, count).end;
    }
    EXPECT_EQ(next, count);
  }
}

TEST_F(Team, DividedWorkIsWholeOnEveryMember) { expect_whole(); }

TEST_F(Team, MembersDoOnlyTheirPart) {
  int mine = 0;
  double none = 0.0;
  team.divide("count", 12, 0, &none, [&](int begin, int end) { mine = end - begin; });
  EXPECT_EQ(mine, 12 / team.size());
}

TEST_F(Team, ANumericalErrorInOnePartIsThrownByAllWhoGoOnTogether) {
  const std::string numerical = thrown_by([&] {
    team.together("pivot", [&] {
      if (team.rank() == last) throw core::NumericalError("a pivot is zero");
    });
  });
  EXPECT_EQ(numerical, "M a pivot is zero");
  const std::string not_finite = thrown_by([&] {
    double none = 0.0;
    team.divide("field", team.size(), 0, &none, [&](int, int end) {
      if (end == team.size()) throw core::NotFiniteError("the field is not finite");
    });
  });
  EXPECT_EQ(not_finite, "N the field is not finite");
  EXPECT_FALSE(team.fallen_apart());
  expect_whole();
}

TEST_F(Team, AnyOtherErrorEndsTheTaskForAll) {
  const auto fail = [&] {
    team.together("memory", [&] {
      if (team.rank() == last) throw std::runtime_error("no memory");
    });
  };
  const std::string text = thrown_by(fail);
  EXPECT_THAT(text, HasSubstr("T member " + std::to_string(last)));
  EXPECT_THAT(text, HasSubstr("no memory"));
  EXPECT_EQ(thrown_by([&] { divided(); }), text);  // nothing goes on, and nobody waits
  team.end("whatever was made of it", 0);
  team.begin();
  expect_whole();
}

TEST_F(Team, AMemberThatLeavesAloneIsMetWhereverTheOthersAre) {
  if (team.size() == 1) return;
  const std::string text = thrown_by([&] {
    if (team.rank() == last)
      team.end("thrown outside of any exchange", 0);
    else
      divided();
  });
  EXPECT_THAT(text, HasSubstr("T member " + std::to_string(last)));
  EXPECT_THAT(text, HasSubstr("thrown outside of any exchange"));
  EXPECT_TRUE(team.fallen_apart());
}

TEST_F(Team, AMemberThatLeavesIsMetByThoseWhoWaitForTheLeader) {
  if (team.size() == 1) return;
  for (const int leaver : {0, last}) {
    team.begin();
    const std::string text = thrown_by([&] {
      std::string bytes = "go on";
      if (team.rank() == leaver)
        team.end("thrown before the answer", 0);
      else
        team.broadcast(bytes);
    });
    EXPECT_THAT(text, HasSubstr("T member " + std::to_string(leaver)));
    EXPECT_THAT(text, HasSubstr("thrown before the answer"));
  }
  team.begin();
  expect_whole();
}

TEST_F(Team, ANumericalErrorOfAMemberThatIsElsewhereIsNoneOfAll) {
  if (team.size() == 1) return;
  const std::string text = thrown_by([&] {
    if (team.rank() == last)
      team.together("pivot", [] { throw core::NumericalError("a pivot is zero"); });
    else
      divided();
  });
  EXPECT_THAT(text, HasSubstr("T member " + std::to_string(last)));
  EXPECT_THAT(text, HasSubstr("a pivot is zero"));
}

TEST_F(Team, AMemberThatHasBegunAnotherTaskIsMet) {
  divided();
  if (team.rank() == last) team.begin();
  const std::string text = thrown_by([&] { team.compare("here", 1); });
  EXPECT_THAT(text, team.size() == 1 ? testing::IsEmpty() : testing::Matcher<std::string>(HasSubstr("different")));
}

TEST_F(Team, MembersAtDifferentPlacesAreToldSo) {
  if (team.size() == 1) return;
  EXPECT_THAT(thrown_by([&] { team.compare(team.rank() == last ? "here" : "there", 1); }), HasSubstr("different"));
  team.begin();
  EXPECT_THAT(thrown_by([&] { team.compare("here", team.rank() == last ? 1 : 2); }), HasSubstr("different"));
  team.begin();
  EXPECT_EQ(thrown_by([&] { team.compare("here", 1); }), "");
}

TEST_F(Team, AnErrorThatAllHaveIsNoneOfTheTeam) {
  EXPECT_EQ(thrown_by([&] { team.end("the same on all", 0); }), "");
  EXPECT_FALSE(team.fallen_apart());
  if (team.size() == 1) return;
  EXPECT_THAT(thrown_by([&] { team.end("mine is " + std::to_string(team.rank()), 0); }), HasSubstr("T member 0"));
}

TEST_F(Team, OutcomesThatDifferAreTold) {
  if (team.size() == 1) return;
  EXPECT_THAT(thrown_by([&] { team.end(std::nullopt, core::digest_of(team.leads() ? "a" : "b")); }),
              HasSubstr("different"));
}

TEST_F(Team, TheLeadersBytesComeToAll) {
  std::string bytes = team.leads() ? std::string("task\0payload", 12) : "something else";
  team.broadcast(bytes);
  EXPECT_EQ(bytes, std::string("task\0payload", 12));
  bytes = team.leads() ? "" : "no";
  team.broadcast(bytes);
  EXPECT_EQ(bytes, "");
}

TEST(SeveralMembers, DivideNothingWhereItDoesNotPay) {
  core::Team team(MPI_COMM_WORLD);
  EXPECT_EQ(core::several(nullptr), nullptr);
  EXPECT_EQ(core::several(&team), team.size() > 1 ? &team : nullptr);
  EXPECT_EQ(core::worth_dividing(&team, 4), nullptr);
}

}  // namespace
}  // namespace team_test
