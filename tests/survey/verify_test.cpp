#include "orbweaver/survey/verify/verify.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <set>

#include <fmt/format.h>

#include "orbweaver/archive/read/loop_of.hpp"
#include "orbweaver/loop/curve/time_samples.hpp"
#include "survey/atlas.hpp"
#include "survey/atlas_records.hpp"

namespace verify_test {
namespace {

using namespace orbweaver;
using survey::Verification;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// What was promised: a change of this size is found.
constexpr double promised = 1e-9;

/// Rows named for a table, with the columns: "orbits 3 period".
std::set<std::string> named(const Verification& found) {
  std::set<std::string> names;
  for (const survey::Objection& objection : found.objections)
    names.insert(fmt::format("{} {}", objection.table, objection.row));
  return names;
}

std::string text_of(const Verification& found) {
  std::string text;
  for (const survey::Objection& o : found.objections)
    text += fmt::format("{} {} {}: {}\n", o.table, o.row, o.column, o.text);
  return text;
}

/// The survey of Henon-Heiles, and copies of it with changed numbers and checksums that match them.
class VerifyOf : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    world = std::make_unique<core::Communicator>();
    const scene::Scene scene =
        scene::load(ORBWEAVER_SOURCE_DIR "/drivers/scenes/henon_heiles.yaml", {"section={coordinate: y, value: 0.05}"});
    whole = test::run(*world, scene, "verify").atlas;
    const test::Atlas atlas(whole);
    header = atlas.header();
    records = test::complete_records_of(atlas);
  }
  static void TearDownTestSuite() { world.reset(); }

  /// Verifies `changed`, written with its own checksums.
  static Verification verified(const archive::Records& changed) {
    const auto folder = test::fresh_folder(fmt::format("verify_case{}", world->size()), world->get());
    if (world->is_root()) test::write_sample_atlas(folder, header, changed);
    MPI_Barrier(world->get());
    return survey::verify(*world, folder / "atlas.h5");
  }

  static void expect_found(const archive::Records& changed, const std::string& place, const std::string& what) {
    const Verification found = verified(changed);
    if (!world->is_root()) return;
    EXPECT_TRUE(named(found).contains(place)) << what << " was not found; found were:\n" << text_of(found);
  }

  /// The first row from there on whose index is known to a tenth of what was promised.
  static std::size_t with_known_index(std::size_t row) {
    const auto known = [](const archive::OrbitRecord& orbit) { return orbit.stability_error < 0.1 * promised; };
    const auto at =
        std::find_if(records.orbits.begin() + static_cast<std::ptrdiff_t>(row), records.orbits.end(), known);
    return static_cast<std::size_t>(
        (at == records.orbits.end() ? std::find_if(records.orbits.begin(), records.orbits.end(), known) : at) -
        records.orbits.begin());
  }
  /// A change within its bound leaves true what a row says of its index; of others the promise holds.
  static bool has_bound(const std::string& column) { return column.ends_with("stability"); }

  static inline std::unique_ptr<core::Communicator> world;
  static inline std::filesystem::path whole;
  static inline archive::Header header;
  static inline archive::Records records;
};

TEST_F(VerifyOf, TheSurveyItselfHolds) {
  for (const Verification& found : {survey::verify(*world, whole), verified(records)}) {
    if (!world->is_root()) continue;
    EXPECT_THAT(text_of(found), IsEmpty());
    EXPECT_TRUE(found.has_checksums);
    EXPECT_TRUE(found.is_computed);
    EXPECT_EQ(found.orbits, static_cast<std::int64_t>(records.orbits.size()));
    EXPECT_EQ(found.sections, static_cast<std::int64_t>(records.sections.size()));
    EXPECT_GT(found.sections, 2 * found.orbits);
    std::set<std::string> columns;
    for (const survey::Margin& margin : found.margins) columns.insert(margin.column);
    for (const char* column :
         {"orbits/loss_rms", "orbits/arclength", "orbits/energy", "orbits/action", "orbits/state", "orbits/stability",
          "orbits/fundamental_stability", "orbits/closure", "orbits/dW/dE", "crossings/period", "crossings/energy",
          "crossings/test_value", "crossings/state", "sections/time", "sections/state"})
      EXPECT_TRUE(columns.contains(column)) << column;
  }
}

double size_of(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value * value;
  return std::sqrt(sum);
}

/// One orbit of each family's middle, each with another number changed: all are named.
TEST_F(VerifyOf, NumbersOfOrbitsChangedByAPartInABillionAreFound) {
  using Change = std::function<void(archive::OrbitRecord&)>;
  const std::vector<std::pair<std::string, Change>> changes{
      {"period", [](auto& o) { o.period *= 1.0 + 2.0 * promised; }},
      {"energy", [](auto& o) { o.energy *= 1.0 + 2.0 * promised; }},
      {"action", [](auto& o) { o.action *= 1.0 + 2.0 * promised; }},
      {"a mode", [](auto& o) { o.modes[o.modes.size() / 3] += 2.0 * promised * size_of(o.modes); }},
      {"the mean", [](auto& o) { o.modes[1] += 2.0 * promised * size_of(o.modes); }},
      {"the last mode", [](auto& o) { o.modes.back() += 2.0 * promised * size_of(o.modes); }},
      {"state", [](auto& o) { o.state[0] += 2.0 * promised * size_of(o.state); }},
      {"stability", [](auto& o) { o.stability[0] += 2.0 * promised * (1.0 + std::abs(o.stability[0])); }},
      {"fundamental_stability",
       [](auto& o) { o.fundamental_stability[0] += 2.0 * promised * (1.0 + std::abs(o.fundamental_stability[0])); }},
      {"loss_rms", [](auto& o) { o.loss_rms += 1e-9; }},
      {"stability_error", [](auto& o) { o.stability_error *= 1e4; }},
      {"closure", [](auto& o) { o.closure += 1e-10; }},
      {"energy_drift", [](auto& o) { o.energy_drift += 1e-10; }},
      {"tail", [](auto& o) { o.tail += 1e-10; }},
      {"parameter", [](auto& o) { o.parameter = 1.0; }},
      {"verdict", [](auto& o) { o.verdict = 1; }},
      {"no verdict", [](auto& o) { o.verdict = -1; }},
      {"recurrence", [](auto& o) { o.recurrence *= 1.0 + 1e-8; }},
      {"arclength", [](auto& o) { o.arclength *= 1.0 + 1e-6; }},
  };
  archive::Records changed = records;
  std::vector<std::pair<std::string, std::string>> places;
  std::set<std::size_t> rows;
  for (std::size_t n = 0; n < changes.size(); ++n) {
    ASSERT_LT(n, changed.orbits.size());
    std::size_t row = 0;
    std::size_t place = 3 + 4 * n;
    do {
      place = (place + 1) % (changed.orbits.size() - 1);
      row = has_bound(changes[n].first) ? with_known_index(place) : place;
      ASSERT_LT(row, changed.orbits.size());
    } while (!rows.insert(row).second);
    changes[n].second(changed.orbits[row]);
    places.emplace_back(changes[n].first, fmt::format("orbits {}", row));
  }
  const Verification found = verified(changed);
  if (!world->is_root()) return;
  for (const auto& [what, place] : places)
    EXPECT_TRUE(named(found).contains(place)) << what << " in " << place << "; found were:\n" << text_of(found);
}

/// Beyond its bound, and that of the value computed again, in all rows at once; their other columns are left alone.
TEST_F(VerifyOf, IndicesOutsideTheirBoundsAreFound) {
  archive::Records changed = records;
  for (archive::OrbitRecord& orbit : changed.orbits)
    orbit.stability[0] += 3.0 * orbit.stability_error + promised * (1.0 + std::abs(orbit.stability[0]));
  const Verification found = verified(changed);
  if (!world->is_root()) return;
  std::set<std::int64_t> rows;
  for (const survey::Objection& objection : found.objections)
    if (objection.table == "orbits" && objection.column == "stability") rows.insert(objection.row);
  EXPECT_EQ(rows.size(), records.orbits.size()) << text_of(found);
}

/// It closes and solves the equations, but its period is two of its own.
TEST_F(VerifyOf, AnOrbitGoneAroundTwiceIsNotOne) {
  const test::Atlas atlas(whole);
  const std::size_t straight = atlas.row_of("Straight");
  ASSERT_EQ(records.families[straight].isotropy, "S@0 R@0");  // no symmetry that two rounds would lose
  const auto row = static_cast<std::size_t>(atlas.families().integers("first_orbit")[straight]) + 4;
  archive::Records changed = records;
  archive::OrbitRecord& orbit = changed.orbits[row];
  const loop::Loop twice = loop::repeated(loop::evenly_in_time(archive::loop_of(atlas, row, {})), 2);
  orbit.period = twice.period;
  orbit.action *= 2.0;
  orbit.cutoff = twice.cutoff;
  orbit.modes = twice.modes;
  orbit.time_map = loop::to_numbers(twice.time_map);
  const double index = orbit.stability[0];
  orbit.stability[0] = index * index - 2.0;
  orbit.stability_error *= 2.0 * (1.0 + std::abs(index));
  const Verification found = verified(changed);
  if (!world->is_root()) return;
  const std::string text = text_of(found);
  EXPECT_THAT(text, HasSubstr(fmt::format("orbits {} : its certificate contradicts it: not minimal", row)));
  for (const char* column : {"loss_rms", "energy", "action", "state", "closure"})
    EXPECT_THAT(text, ::testing::Not(HasSubstr(fmt::format("orbits {} {}:", row, column))));
}

TEST_F(VerifyOf, NumbersOfCrossingsChangedByAPartInABillionAreFound) {
  using Change = std::function<void(archive::CrossingRecord&)>;
  const std::vector<std::pair<std::string, Change>> changes{
      {"period", [](auto& c) { c.period *= 1.0 + 2.0 * promised; }},
      {"energy", [](auto& c) { c.energy *= 1.0 + 2.0 * promised; }},
      {"state",
       [](auto& c) {
         for (double& z : c.state) z *= 1.0 + 1e-8;
       }},
      {"test_value", [](auto& c) { c.test_value += 2.0 * promised; }},
      {"residual", [](auto& c) { c.residual += 2.0 * promised; }},
      {"arclength", [](auto& c) { c.arclength *= 1.0 + 1e-2; }},
      {"multiplicity", [](auto& c) { c.multiplicity += 1; }},
      {"sector_q", [](auto& c) { c.sector_q += 1; }},
  };
  ASSERT_GE(records.crossings.size(), changes.size());
  archive::Records changed = records;
  for (std::size_t row = 0; row < changes.size(); ++row) changes[row].second(changed.crossings[row]);
  const Verification found = verified(changed);
  if (!world->is_root()) return;
  for (std::size_t row = 0; row < changes.size(); ++row)
    EXPECT_TRUE(named(found).contains(fmt::format("crossings {}", row))) << changes[row].first << "; found were:\n"
                                                                         << text_of(found);
}

TEST_F(VerifyOf, PointsOfTheSectionThatWereMovedOrLeftOutAreFound) {
  ASSERT_GE(records.sections.size(), 30U);
  archive::Records changed = records;
  changed.sections[5].time *= 1.0 + promised;
  changed.sections[11].state[2] += 2.0 * promised;
  // Of the orbit that the rows from 20 on belong to, one is gone.
  const std::string family = changed.sections[20].family_key;
  const int step = changed.sections[20].step;
  changed.sections.erase(changed.sections.begin() + 20);
  const Verification found = verified(changed);
  if (!world->is_root()) return;
  EXPECT_TRUE(named(found).contains("sections 5")) << text_of(found);
  EXPECT_TRUE(named(found).contains("sections 11")) << text_of(found);
  const auto orbit = std::find_if(records.orbits.begin(), records.orbits.end(), [&](const archive::OrbitRecord& row) {
    return row.family_key == family && row.step == step;
  });
  EXPECT_TRUE(named(found).contains(fmt::format("orbits {}", orbit - records.orbits.begin()))) << text_of(found);
}

/// Where a family's crossings are not found from orbits beside them. An archive that does not say where the birth is
/// has it up to three steps before the first orbit.
TEST_F(VerifyOf, CrossingsBetweenABirthAndItsFirstOrbitAreTakenAsTheyAre) {
  std::size_t row = 0;
  const test::Atlas atlas(whole);
  const auto& families = atlas.crossings().integers("family");
  while (records.families[static_cast<std::size_t>(families[row])].crossing < 0) ++row;
  std::vector<double> arclengths;
  for (const archive::OrbitRecord& orbit : records.orbits)
    if (orbit.family_key == records.crossings[row].family_key) arclengths.push_back(orbit.arclength);
  const auto expect_objection = [&](double birth, double arclength, bool expected) {
    archive::Records changed = records;
    changed.families[static_cast<std::size_t>(families[row])].birth_arclength = birth;
    changed.crossings[row].arclength = arclength;
    const Verification found = verified(changed);
    if (world->is_root()) {
      EXPECT_EQ(named(found).contains(fmt::format("crossings {}", row)), expected)
          << birth << " " << arclength << "\n"
          << text_of(found);
    }
  };
  const double birth = records.families[static_cast<std::size_t>(families[row])].birth_arclength;
  ASSERT_LT(birth, arclengths[0]);
  for (const double part : {0.5, 0.99, 1.01})
    expect_objection(birth, arclengths[0] - part * (arclengths[0] - birth), part > 1.0);
  for (const double steps : {2.0, 4.0})
    expect_objection(archive::not_computed, arclengths[0] - steps * (arclengths[1] - arclengths[0]), steps > 3.0);
}

TEST_F(VerifyOf, ABirthThatIsSaidToLieElsewhereIsFound) {
  std::size_t born = 0;
  while (records.families[born].crossing < 0) ++born;
  archive::Records changed = records;
  changed.families[born].birth_arclength *= 1.005;
  expect_found(changed, fmt::format("families {}", born), "birth_arclength");
}

TEST_F(VerifyOf, IndicesOfFamiliesThatPointElsewhereAreFound) {
  std::size_t born = 0;
  while (records.families[born].crossing < 0) ++born;
  archive::Records changed = records;
  archive::FamilyRecord& family = changed.families[born];
  family.crossing = family.crossing == 0 ? 1 : 0;
  expect_found(changed, fmt::format("families {}", born), "crossing");
  changed = records;
  changed.families[born].multiplicity += 1;
  expect_found(changed, fmt::format("families {}", born), "multiplicity");
  changed = records;
  changed.families[born].parent_key.clear();
  expect_found(changed, fmt::format("families {}", born), "parent");
}

/// A relative change of one number.
struct Changed {
  const char* column;
  std::function<void(archive::OrbitRecord&, double)> orbit;
  std::function<void(archive::CrossingRecord&, double)> crossing;
};

const std::vector<Changed>& changed_columns() {
  static const std::vector<Changed> columns{
      {"period", [](auto& o, double by) { o.period *= 1.0 + by; }, {}},
      {"energy", [](auto& o, double by) { o.energy *= 1.0 + by; }, {}},
      {"action", [](auto& o, double by) { o.action *= 1.0 + by; }, {}},
      {"modes, the first harmonic", [](auto& o, double by) { o.modes[5] += by * size_of(o.modes); }, {}},
      {"modes, the mean", [](auto& o, double by) { o.modes[1] += by * size_of(o.modes); }, {}},
      {"modes, the last harmonic", [](auto& o, double by) { o.modes.back() += by * size_of(o.modes); }, {}},
      {"state", [](auto& o, double by) { o.state[0] += by * size_of(o.state); }, {}},
      {"stability", [](auto& o, double by) { o.stability[0] += by * (1.0 + std::abs(o.stability[0])); }, {}},
      {"fundamental_stability",
       [](auto& o, double by) { o.fundamental_stability[0] += by * (1.0 + std::abs(o.fundamental_stability[0])); },
       {}},
      {"arclength", [](auto& o, double by) { o.arclength += by * (1.0 + std::abs(o.arclength)); }, {}},
      {"crossings/period", {}, [](auto& c, double by) { c.period *= 1.0 + by; }},
      {"crossings/energy", {}, [](auto& c, double by) { c.energy *= 1.0 + by; }},
      {"crossings/state",
       {},
       [](auto& c, double by) {
         for (double& z : c.state) z *= 1.0 + by;
       }},
      {"crossings/test_value", {}, [](auto& c, double by) { c.test_value += by; }},
      {"crossings/arclength", {}, [](auto& c, double by) { c.arclength += by * (1.0 + std::abs(c.arclength)); }},
  };
  return columns;
}

/// The smallest power of ten by which each column can be changed in any of a few rows, and is found: docs/accuracy.md.
TEST_F(VerifyOf, TheSmallestChangesThatAreFound) {
  constexpr int draws = 4;
  std::vector<int> least(changed_columns().size(), 0);
  for (int power = -15; power <= -2; ++power) {
    std::vector<int> found(changed_columns().size(), 0);
    for (int draw = 0; draw < draws; ++draw) {
      archive::Records changed = records;
      std::vector<std::string> places;
      for (std::size_t n = 0; n < changed_columns().size(); ++n) {
        const Changed& column = changed_columns()[n];
        // Rows two apart, so that none is beside another that was changed.
        const std::size_t place = column.orbit
                                      ? (2 * (n + 11 * static_cast<std::size_t>(draw)) + 1) % records.orbits.size()
                                      : (n + static_cast<std::size_t>(draw)) % records.crossings.size();
        const std::size_t row = has_bound(column.column) ? with_known_index(place) : place;
        if (column.orbit)
          column.orbit(changed.orbits[row], std::pow(10.0, power));
        else
          column.crossing(changed.crossings[row], std::pow(10.0, power));
        places.push_back(fmt::format("{} {}", column.orbit ? "orbits" : "crossings", row));
      }
      const std::set<std::string> names = named(verified(changed));
      for (std::size_t n = 0; n < places.size(); ++n) found[n] += names.contains(places[n]) ? 1 : 0;
    }
    for (std::size_t n = 0; n < found.size(); ++n)
      if (found[n] == draws && least[n] == 0)
        least[n] = power;
      else if (found[n] < draws)
        least[n] = 0;
  }
  if (!world->is_root()) return;
  for (std::size_t n = 0; n < least.size(); ++n) {
    fmt::print("{:<28} 1e{}\n", changed_columns()[n].column, least[n]);
    EXPECT_LT(least[n], 0) << changed_columns()[n].column << ": not found at any size";
    EXPECT_LE(std::pow(10.0, least[n]), 1.5 * promised) << changed_columns()[n].column;
  }
}

/// An orbit that is one, of another place on its family, and one of another family.
TEST_F(VerifyOf, OrbitsThatStandElsewhereAreFound) {
  archive::Records changed = records;
  archive::OrbitRecord& orbit = changed.orbits[4];
  const archive::OrbitRecord other = records.orbits[6];
  orbit.period = other.period;
  orbit.energy = other.energy;
  orbit.action = other.action;
  orbit.modes = other.modes;
  orbit.time_map = other.time_map;
  orbit.cutoff = other.cutoff;
  orbit.state = other.state;
  orbit.stability = other.stability;
  orbit.fundamental_stability = other.fundamental_stability;
  expect_found(changed, "orbits 4", "another orbit");
}

}  // namespace
}  // namespace verify_test
