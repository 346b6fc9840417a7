#include <cmath>
#include <vector>

#include <gmock/gmock.h>

#include "orbweaver/core/error.hpp"
#include "orbweaver/cost/ladders.hpp"
#include "spring_scene.hpp"

namespace ladders_test {
namespace {

using namespace orbweaver;
using cost::Table;

std::vector<Table> climbed(const std::vector<std::string>& only, const std::string& family) {
  const core::Communicator comm;
  std::vector<Table> tables;
  cost::measure(comm, test::spring_scene(), {family, only, true}, [&](const Table& table) { tables.push_back(table); });
  return tables;
}

std::size_t column(const Table& table, const std::string& name) {
  for (std::size_t c = 0; c < table.columns.size(); ++c)
    if (table.columns[c].name == name) return c;
  throw core::MisuseError("no column " + name);
}

TEST(Ladders, EveryRowHasEveryColumn) {
  for (const Table& table : climbed({}, ""))
    for (const auto& row : table.rows) EXPECT_EQ(row.size(), table.columns.size()) << table.name;
}

TEST(Ladders, ALinearOscillationHasNoErrorAtAnyCutoff) {
  const std::vector<Table> tables = climbed({"resolution"}, "Bounce");
  ASSERT_EQ(tables.size(), 2U);
  const Table& table = tables.front();
  ASSERT_GT(table.rows.size(), 10U);
  for (const auto& row : table.rows) {
    EXPECT_GT(row[column(table, "time")].number, 0.0);
    if (row[column(table, "time map")].words == "no") {
      EXPECT_LT(row[column(table, "error")].number, 1e-12);
    }
  }
}

TEST(Ladders, ErrorsFallAsHarmonicsGrow) {
  const Table table = climbed({"resolution"}, "Cup").front();
  const std::size_t error = column(table, "error");
  double first = 0.0;
  double least = 1.0;
  for (const auto& row : table.rows)
    if (row[0].words == "end" && row[2].words == "subspace" && row[3].words == "no") {
      if (first == 0.0) first = row[error].number;
      least = std::fmin(least, row[error].number);
    }
  EXPECT_GT(first, 1e-7);
  EXPECT_LT(least, 1e-12);
}

TEST(Ladders, ATighterToleranceGivesSmallerErrors) {
  const Table table = climbed({"tolerance"}, "Cup").front();
  const std::size_t error = column(table, "worst error");
  ASSERT_GE(table.rows.size(), 3U);
  EXPECT_LT(table.rows.back()[error].number, 1e-3 * table.rows.front()[error].number);
  EXPECT_LT(table.rows.back()[error].number, 1e-11);
}

TEST(Ladders, MoreDigitsTakeLonger) {
  const Table table = climbed({"digits"}, "Cup").front();
  const std::size_t known = column(table, "digits known");
  for (const auto& row : table.rows) EXPECT_GE(row[known].number, row[column(table, "digits asked for")].number - 1.0);
  EXPECT_LT(table.rows[0][column(table, "time")].number, table.rows[1][column(table, "time")].number);
}

TEST(Ladders, AWrongNameNamesThemAll) {
  try {
    static_cast<void>(climbed({"resolutions"}, ""));
    FAIL();
  } catch (const core::InputError& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("resolution, tolerance, solvers"));
  }
}

}  // namespace
}  // namespace ladders_test
