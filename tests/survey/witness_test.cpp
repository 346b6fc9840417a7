#include "survey/witness_of.hpp"

namespace orbweaver::survey::witness_test {
namespace {

TEST_F(WitnessOf, ATreeThatAddsUpSaysWhatTheLimitsCut) {
  EXPECT_EQ(summary.failures, 0U);
  const std::vector<Found> none = found();
  if (!world->is_root()) return;
  EXPECT_THAT(none, IsEmpty());
  ASSERT_FALSE(summary.findings.empty());
  for (const FindingSummary& line : summary.findings) EXPECT_EQ(line.severity, Severity::cut) << line.text;
  ASSERT_EQ(atlas->findings().rows(), summary.findings.size());
  EXPECT_EQ(atlas->findings().texts("text").front(), summary.findings.front().text);
}

TEST_F(WitnessOf, IndicesOfAnEquilibriumsFamiliesAddUp) {
  input.kernels = {{kernel_of_centre()}};
  const std::vector<Found> rows = found();
  if (!world->is_root()) return;
  EXPECT_THAT(rows, IsEmpty());
}

TEST_F(WitnessOf, AFamilyMissingAtAnEquilibrium) {
  std::vector<double> deviations;
  for (std::size_t missing = 0; missing < 3; ++missing) {
    KernelRecord kernel = kernel_of_centre();
    for (std::vector<int>* numbers : {&kernel.places, &kernel.images, &kernel.repetitions})
      if (atlas) numbers->erase(numbers->begin() + static_cast<std::ptrdiff_t>(missing));
    input = {};
    input.kernels = {{kernel}};
    const Testimony said = testimony();
    EXPECT_EQ(said.wrong, 1U);
    if (!world->is_root()) continue;
    ASSERT_THAT(said.records, ElementsAre(finding("contradiction", "equilibrium-families")));
    deviations.push_back(said.records[0].deviation);
  }
  // One of the kinds that come by threes is stable, the other not; the circles are.
  if (!world->is_root()) return;
  EXPECT_THAT(deviations, AnyOf(ElementsAre(3.0, -3.0, 2.0), ElementsAre(-3.0, 3.0, 2.0)));
}

TEST_F(WitnessOf, NothingIsSaidOfAnEquilibriumWithoutOneSign) {
  KernelRecord kernel = kernel_of_centre();
  kernel.images = {3, 3, 1};
  kernel.is_definite = false;
  input.kernels = {{kernel}};
  const std::vector<Found> rows = found();
  if (!world->is_root()) return;
  EXPECT_THAT(rows, IsEmpty());
}

TEST_F(WitnessOf, AnEquilibriumsFamilyWithoutOrbitsLeavesItsIndexOpen) {
  if (world->is_root()) remove_orbits(key_named("Loop"));
  KernelRecord kernel = kernel_of_centre();
  kernel.not_isolated = 4;
  input.kernels = {{kernel}};
  const std::vector<Found> rows = found();
  if (!world->is_root()) return;
  EXPECT_THAT(rows, IsSupersetOf({finding("undecided", "equilibrium-families"), finding("undecided", "continuum")}));
}

TEST_F(WitnessOf, BaseFamiliesLeadBackToTheirEquilibrium) {
  const auto said_of = [&](double period, const std::vector<double>& point) {
    input = {};
    input.equilibria = {point};
    input.oscillations.emplace_back();
    for (const char* name : {"Straight", "Curved", "Loop"})
      if (atlas) input.oscillations.back().push_back({row_named(name), period});
    return found();
  };
  const double period = 2.0 * std::numbers::pi;
  const std::vector<double> centre{0.0, 0.0, 0.0, 0.0};
  const std::vector<Found> right = said_of(period, centre);
  const std::vector<Found> another_oscillation = said_of(1.05 * period, centre);
  const std::vector<Found> another_equilibrium = said_of(period, {0.0, 1.0, 0.0, 0.0});
  if (!world->is_root()) return;
  EXPECT_THAT(right, IsEmpty());
  const auto wrong = finding("contradiction", "base-birth");
  EXPECT_THAT(another_oscillation, ElementsAre(wrong, wrong, wrong));
  EXPECT_THAT(another_equilibrium, ElementsAre(wrong, wrong, wrong));
  EXPECT_NEAR(another_oscillation[0].deviation, 0.05 / 1.05, 0.01);
}

TEST_F(WitnessOf, FamiliesThatShareAPeriodAreCountedInstead) {
  input.equilibria = {{0.0, 0.0, 0.0, 0.0}};
  input.oscillations.emplace_back();
  if (atlas) input.oscillations.back() = {{row_named("Straight"), 1.0}};
  input.kernels = {{kernel_of_centre()}};
  const std::vector<Found> rows = found();
  if (!world->is_root()) return;
  EXPECT_THAT(rows, IsEmpty());
}

TEST_F(WitnessOf, ACurveStoredTwice) {
  if (world->is_root()) {
    const auto orbits = orbits_of(key_named("Curved"));
    add_family_like("Curved", "0000.9000").name = "Again";
    remove_orbits(key_named("Curved"));
    add_every_second(orbits, 0, key_named("Curved"));
    add_every_second(orbits, 1, "0000.9000");
  }
  const Testimony said = testimony();
  EXPECT_EQ(said.wrong, 1U) << "on every rank";
  if (!world->is_root()) return;
  ASSERT_THAT(said.records, ElementsAre(finding("contradiction", "duplicate-curve")));
  EXPECT_EQ(said.records[0].family, row_named("Curved"));
  EXPECT_EQ(said.records[0].other_family, static_cast<int>(records.families.size()) - 1);
  EXPECT_THAT(said.records[0].text, HasSubstr("Curved: the same orbits are stored in Again"));
}

// Each is said to be the same as one other, not as all: what is the same as that needs no comparison.
TEST_F(WitnessOf, CopiesOfAFamilyStandForOneAnother) {
  constexpr std::size_t copies = 12;
  if (world->is_root()) {
    const auto orbits = orbits_of(key_named("Curved"));
    for (std::size_t n = 0; n < copies; ++n) {
      const std::string key = fmt::format("0000.{}", 9000 + n);
      add_family_like("Curved", key).name = fmt::format("Copy {}", n);
      for (archive::OrbitRecord orbit : orbits) {
        orbit.family_key = key;
        records.orbits.push_back(orbit);
      }
    }
  }
  const std::vector<Found> rows = found();
  if (!world->is_root()) return;
  std::set<std::int64_t> told;
  std::size_t findings = 0;
  for (const Found& row : rows) {
    if (row.kind != "duplicate-curve") continue;
    ++findings;
    told.insert(row.family);
    told.insert(row.other_family);
  }
  EXPECT_EQ(findings, copies);
  EXPECT_EQ(told.size(), copies + 1) << "all of them, and the family itself";
}

// Another family with the same numbers, whose loops are others but for one of them, so that the orbit after it lies on
// both; then with a crossing at that orbit.
TEST_F(WitnessOf, OneOrbitOfTwoFamilies) {
  for (const bool has_crossing : {false, true}) {
    input = {};
    if (world->is_root()) {
      records = records_of(*atlas);
      const auto orbits = orbits_of(key_named("Curved"));
      add_family_like("Curved", "0000.9000").name = "Again";
      remove_orbits(key_named("Curved"));
      add_every_second(orbits, 0, key_named("Curved"));
      add_every_second(orbits, 1, "0000.9000");
      int n = 0;
      for (archive::OrbitRecord& orbit : records.orbits)
        if (orbit.family_key == "0000.9000" && n++ != 2) orbit.modes[0] += 0.3;
      if (has_crossing) {
        archive::CrossingRecord& crossing = records.crossings.emplace_back(records.crossings.front());
        crossing.family_key = key_named("Curved");
        crossing.multiplicity = 1;
        crossing.period = orbits[6].period;
        crossing.energy = orbits[6].energy;
        crossing.arclength = orbits[6].arclength;
      }
    }
    const std::vector<Found> rows = found();
    if (!world->is_root()) continue;
    EXPECT_THAT(rows, Contains(AllOf(finding(has_crossing ? "undecided" : "contradiction", "duplicate-curve"),
                                     Field(&Found::text, HasSubstr("1 of 5 compared")))));
  }
}

// Both ends of one curve, followed until they have run past one another: more steps bring each to the other's start.
TEST_F(WitnessOf, ACurveStoredTwiceForWantOfStepsOrDigits) {
  const std::string out_of_steps = "step limit";
  const std::string out_of_digits = "undecided (an index is 2 to rounding)";
  const auto said_of = [&](const std::string& end, const std::string& other_end) {
    input = {};
    if (world->is_root()) {
      records = records_of(*atlas);
      const auto orbits = orbits_of(key_named("Curved"));
      archive::FamilyRecord& again = add_family_like("Curved", "0000.9000");
      again.name = "Again";
      if (!other_end.empty()) again.end_reason = other_end;
      if (!end.empty()) records.families[static_cast<std::size_t>(row_named("Curved"))].end_reason = end;
      remove_orbits(key_named("Curved"));
      add_every_second(orbits, 0, key_named("Curved"));
      add_every_second(orbits, 1, "0000.9000");
    }
    return testimony();
  };
  const Testimony both = said_of(out_of_steps, out_of_steps);
  const Testimony one = said_of(out_of_steps, "");
  const Testimony hidden = said_of(out_of_digits, out_of_digits);
  const Testimony one_hidden = said_of(out_of_digits, "");
  EXPECT_EQ(both.wrong, 0U) << "on every rank";
  EXPECT_EQ(hidden.wrong, 0U);
  EXPECT_EQ(one_hidden.wrong, 1U);
  EXPECT_EQ(one.wrong, 1U);
  if (!world->is_root()) return;
  EXPECT_THAT(both.records, ElementsAre(finding("cut", "duplicate-curve")));
  EXPECT_THAT(one.records, ElementsAre(finding("contradiction", "duplicate-curve")));
  EXPECT_THAT(hidden.records, testing::Contains(finding("undecided", "duplicate-curve")));
}

TEST_F(WitnessOf, ACurveThatTurnsBackOnItself) {
  if (world->is_root()) turn_back("Curved");
  const std::vector<Found> rows = found();
  if (!world->is_root()) return;
  ASSERT_THAT(rows, ElementsAre(finding("contradiction", "retraced-curve")));
  EXPECT_EQ(rows[0].family, row_named("Curved"));
}

// Where an index as steep as that passes 2 families cross to rounding, and a branch may go on along either.
TEST_F(WitnessOf, ACurveThatTurnsBackWhereRoundingHidesWhichWayItGoes) {
  const auto said_of = [&](double index) {
    if (world->is_root()) {
      records = records_of(*atlas);
      turn_back("Curved");
      const std::string key = key_named("Curved");
      const std::size_t count = orbits_of(key).size();
      std::size_t n = 0;
      for (archive::OrbitRecord& orbit : records.orbits)
        if (orbit.family_key == key) {
          orbit.stability = orbit.fundamental_stability = {2 * n++ < count ? index : -index};
          orbit.stability_error = 1e-9 * index;
        }
    }
    return found();
  };
  const std::vector<Found> told = said_of(1e12);
  const std::vector<Found> untold = said_of(1e15);
  if (!world->is_root()) return;
  EXPECT_THAT(told, testing::Contains(finding("contradiction", "retraced-curve")));
  EXPECT_THAT(untold, testing::Contains(finding("undecided", "retraced-curve")));
  EXPECT_THAT(untold, testing::Not(testing::Contains(finding("contradiction", "retraced-curve"))));
}

TEST_F(WitnessOf, AFamilyThatRunsThroughACrossingOfAnother) {
  if (world->is_root()) {
    // As if StD had not been born there, but came from the other side: from its images half a period later.
    archive::FamilyRecord& family = records.families[static_cast<std::size_t>(row_named("StD"))];
    family.parent_key.clear();
    family.crossing = -1;
    for (archive::OrbitRecord orbit : orbits_of(family.key)) {
      ASSERT_TRUE(orbit.time_map.empty());
      orbit.step = -1 - orbit.step;
      orbit.arclength = -0.01 - orbit.arclength;
      const std::size_t width = orbit.state.size();
      for (std::size_t row = 1; row * width < orbit.modes.size(); ++row)  // a1, b1, a2, ...
        if ((row + 1) / 2 % 2 != 0)
          for (std::size_t i = 0; i < width; ++i) orbit.modes[row * width + i] *= -1.0;
      records.orbits.push_back(orbit);
    }
  }
  const std::vector<Found> rows = found();
  if (!world->is_root()) return;
  // The images' own crossings are not listed either.
  ASSERT_THAT(rows,
              IsSupersetOf({finding("contradiction", "retraced-curve"), finding("contradiction", "shared-point")}));
  EXPECT_EQ(rows[1].family, row_named("StD"));
  EXPECT_EQ(rows[1].other_family, row_named("Straight"));
}

TEST_F(WitnessOf, AnIndexThatPassesWithoutACrossing) {
  if (world->is_root()) {
    const archive::FamilyRecord gone = records.families[static_cast<std::size_t>(row_named("StD"))];
    remove_family(gone.key);
    remove_crossing(gone.crossing);
  }
  const std::vector<Found> rows = found();
  if (!world->is_root()) return;
  ASSERT_THAT(rows, ElementsAre(finding("contradiction", "index-change")));
  EXPECT_EQ(rows[0].family, row_named("Straight"));
  EXPECT_THAT(rows[0].text, HasSubstr("2 pi i 1/2"));
}

TEST_F(WitnessOf, PlacesThatAreKnownWorseThanTheScenesTolerance) {
  if (world->is_root()) {
    records.crossings[0].place_error = 3e-3;
    records.crossings[0].place_error_energy = 2e-6;
    records.crossings[1].place_error_energy = 1e-12;
  }
  const std::vector<Found> rows = found();
  if (!world->is_root()) return;
  ASSERT_THAT(rows, ElementsAre(finding("undecided", "open-place")));
  EXPECT_EQ(rows[0].crossing, 0);
  EXPECT_EQ(rows[0].deviation, 3e-3);
  EXPECT_THAT(rows[0].text, HasSubstr("known to 3.0e-03 in arclength only"));
  EXPECT_THAT(rows[0].text, HasSubstr("2.0e-06 in E"));
}

// A bound that is wider than all values on the unit circle is no number to tell.
TEST_F(WitnessOf, ABoundThatSaysNothingIsSaidInWords) {
  for (const auto& [error, text] : {std::pair{6.2e172, "a stability index is not known:"},
                                    std::pair{0.5, "a stability index is known to 0.5 only:"}}) {
    if (world->is_root()) {
      const auto elliptic = std::find_if(records.orbits.begin(), records.orbits.end(), [](const auto& orbit) {
        return std::abs(orbit.fundamental_stability.front()) < 1.0;
      });
      ASSERT_NE(elliptic, records.orbits.end());
      elliptic->stability_error = error;
    }
    const std::vector<Found> rows = found();
    if (!world->is_root()) continue;
    const auto row =
        std::find_if(rows.begin(), rows.end(), [](const Found& f) { return f.kind == "undecided-indices"; });
    ASSERT_NE(row, rows.end());
    EXPECT_THAT(row->text, HasSubstr(text));
  }
}

// All orbits of a family lie behind the values that an index of 2 passes.
TEST_F(WitnessOf, AnIndexThatIsNotTheBirths) {
  const std::string key = world->is_root() ? key_named("StD") : "";
  for (archive::OrbitRecord& orbit : records.orbits)
    if (orbit.family_key == key) orbit.stability = orbit.fundamental_stability = {-3.0};
  const std::vector<Found> rows = found();
  if (!world->is_root()) return;
  const auto passed = AllOf(finding("contradiction", "index-change"), Field(&Found::family, row_named("StD")));
  EXPECT_THAT(rows, ElementsAre(passed, passed, passed, passed));  // 1/2, 1/3, 1/4 and 1/6 of its half map
}

TEST_F(WitnessOf, AnIndexThatIsNotTheOneAtTheEnd) {
  if (world->is_root()) {
    archive::FamilyRecord& family = records.families[static_cast<std::size_t>(row_named("LoD"))];
    family.end_reason = "joined Loop at T = 12.0895";
    family.end_family_key = key_named("Loop");
    family.end_crossing = family.crossing;
    for (archive::OrbitRecord& orbit : records.orbits)
      if (orbit.family_key == family.key) orbit.stability = orbit.fundamental_stability = {2.5};
    auto last = std::find_if(records.orbits.rbegin(), records.orbits.rend(),
                             [&](const archive::OrbitRecord& orbit) { return orbit.family_key == family.key; });
    last->stability = last->fundamental_stability = {-1.5};
  }
  const std::vector<Found> rows = found();
  if (!world->is_root()) return;
  EXPECT_THAT(rows, IsSupersetOf({finding("contradiction", "index-change"), finding("undecided", "index-change")}));
}

// Whose events were lost with a failed task.
TEST_F(WitnessOf, AnIndexThatPassesWhereATaskFailed) {
  if (world->is_root()) {
    for (const archive::FamilyRecord& family : std::vector(records.families))
      if (family.crossing >= 0) remove_family(family.key);
    records.crossings.clear();
    for (const archive::FamilyRecord& family : records.families)
      input.tree.failures.push_back({family.key, "no memory"});
  }
  const Testimony said = testimony();
  EXPECT_EQ(said.wrong, 3U);
  if (!world->is_root()) return;
  EXPECT_THAT(said.records, Contains(finding("undecided", "index-change")));
}

}  // namespace
}  // namespace orbweaver::survey::witness_test
