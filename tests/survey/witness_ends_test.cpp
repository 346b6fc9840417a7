#include "survey/witness_of.hpp"

namespace orbweaver::survey::witness_ends_test {
namespace {

TEST_F(WitnessOf, DirectionsThatAKernelHasAndNobodyFound) {
  if (world->is_root()) {
    const int on_loop = static_cast<int>(atlas->families().integers("crossing")[atlas->row_of("LoT3")]);
    CrossingEvidence& none = add_crossing(on_loop);
    none.q = 3;
    none.kernel_dimension = 2;
    const int on_straight = static_cast<int>(atlas->families().integers("crossing")[atlas->row_of("StT3a")]);
    CrossingEvidence& one = add_crossing(on_straight);  // where a reflection keeps the whole orbit: two of them
    one.q = 3;
    one.kernel_dimension = 2;
    one.directions = 1;
    one.sides = {DirectionFate::followed};
  }
  const std::vector<Found> rows = found();
  if (!world->is_root()) return;
  ASSERT_THAT(rows, ElementsAre(finding("contradiction", "missing-directions"),
                                finding("contradiction", "missing-directions")));
  EXPECT_EQ(rows[0].deviation, 1.0);
  EXPECT_THAT(rows[0].text, HasSubstr("Loop: subharmonic T 6.07264: the kernel has 1 directions, 0 were found"));
  EXPECT_THAT(rows[1].text, HasSubstr("the kernel has 2 directions, 1 were found"));
}

// What decides the directions at a double multiplier -1 has as many maxima as minima on the kernel's circle.
TEST_F(WitnessOf, OneDirectionWhereTwoDoublingsLieSideBySide) {
  if (world->is_root()) {
    CrossingEvidence& one = add_crossing(0);
    one.q = 2;
    one.kernel_dimension = 2;
    one.directions = 1;
    one.sides = {DirectionFate::followed};
    CrossingEvidence& both = add_crossing(1);
    both.q = 2;
    both.kernel_dimension = 2;
    both.directions = 2;
    both.sides = {DirectionFate::followed, DirectionFate::followed};
  }
  const std::vector<Found> rows = found();
  if (!world->is_root()) return;
  ASSERT_THAT(rows, ElementsAre(finding("undecided", "missing-directions")));
  EXPECT_THAT(rows[0].text, HasSubstr("the kernel has 2 directions, 1 were found"));
}

TEST_F(WitnessOf, DirectionsThatNobodyFollowed) {
  if (world->is_root()) {
    CrossingEvidence& crossing = add_crossing(0);
    crossing.q = 2;
    crossing.kernel_dimension = 1;
    crossing.directions = 1;
    crossing.sides = {DirectionFate::followed,      DirectionFate::arrived, DirectionFate::failed,
                      DirectionFate::beyond_limits, DirectionFate::unknown, DirectionFate::beyond_families};
    add_crossing(1).limited_by = period_limited;
    CrossingEvidence& deep = add_crossing(2);
    deep.kernel_dimension = 1;
    deep.limited_by = depth_limited;
    add_crossing(3).failed = true;
  }
  const std::vector<Found> rows = found();
  if (!world->is_root()) return;
  EXPECT_THAT(rows, ElementsAre(finding("contradiction", "unfollowed-direction"), finding("cut", "beyond-limits"),
                                finding("cut", "beyond-families"), finding("cut", "beyond-period"),
                                finding("cut", "beyond-depth")));
}

TEST_F(WitnessOf, EndsAtCrossingsThatDoNotExplainThem) {
  if (world->is_root()) {
    add_end("StD").joined = true;
    add_end("LoD").nearby = {0};
    add_end("StT3a").nearby = {1};
    add_crossing(1).limited_by = depth_limited;
    EndEvidence& known = add_end("StT3b");
    known.joined = true;
    known.crossing = 0;
  }
  const std::vector<Found> rows = found();
  if (!world->is_root()) return;
  EXPECT_THAT(rows, ElementsAre(finding("contradiction", "unlisted-target"),
                                finding("contradiction", "unknown-direction"), finding("cut", "beyond-depth")));
}

// As many families at a crossing as it has sides: one may come back along the side that no other has.
TEST_F(WitnessOf, AFamilyThatComesBackToItsBirth) {
  if (world->is_root()) {
    const auto births = atlas->families().integers("crossing");
    const int born = static_cast<int>(births[atlas->row_of("StD")]);
    add_crossing(born).sides = {DirectionFate::followed, DirectionFate::arrived};
    EndEvidence& back = add_end("StD");
    back.joined = true;
    back.crossing = born;
  }
  if (const std::vector<Found> rows = found(); world->is_root()) {
    EXPECT_THAT(rows, IsEmpty());
  }
}

TEST_F(WitnessOf, AFamilyThatComesBackToItsBirthAsAnother) {
  if (world->is_root()) {
    const auto births = atlas->families().integers("crossing");
    const int born = static_cast<int>(births[atlas->row_of("StD")]);
    add_crossing(born).sides = {DirectionFate::followed, DirectionFate::arrived};
    for (const char* name : {"StD", "LoD"}) {
      EndEvidence& end = add_end(name);
      end.joined = true;
      end.crossing = born;
    }
  }
  const std::vector<Found> rows = found();
  if (!world->is_root()) return;
  ASSERT_THAT(rows, ElementsAre(finding("contradiction", "taken-direction")));
  EXPECT_EQ(rows[0].family, row_named("StD"));
  EXPECT_THAT(rows[0].text, HasSubstr("3 families leave and arrive there, along 2 directions"));
}

TEST_F(WitnessOf, EndsWhereNoCrossingIsKnown) {
  if (world->is_root()) {
    // A family that comes to Straight gone around four times, one that comes to it twice, and one that comes nowhere.
    const std::vector<archive::OrbitRecord> straight = orbits_of(key_named("Straight"));
    for (const int times : {4, 2, 0}) {
      const std::string key = fmt::format("0000.900{}", times);
      archive::FamilyRecord& family = add_family_like("Straight", key);
      family.name = "Comes";
      family.isotropy = "R@0";
      for (std::size_t n = 5; n < 8; ++n) {
        archive::OrbitRecord orbit = straight[n];
        orbit.family_key = key;
        orbit.step = static_cast<int>(n) - 5;
        orbit.period *= std::max(1, times);
        orbit.action *= std::max(1, times);
        if (times == 0) orbit.energy += 0.01;
        orbit.stability = orbit.fundamental_stability = {0.5};
        records.orbits.push_back(orbit);
      }
      EndEvidence& end = add_end("Straight");
      end.family = key;
      end.period = std::max(1, times) * straight[8].period;
      end.level = straight[8].energy + (times == 0 ? 0.01 : 0.0);
    }
  }
  const std::vector<Found> rows = found();
  if (!world->is_root()) return;
  ASSERT_THAT(rows, ElementsAre(finding("undecided", "unlisted-crossing"), finding("undecided", "unknown-family"),
                                finding("cut", "higher-order")));
  EXPECT_EQ(rows[0].other_family, row_named("Straight"));
  EXPECT_THAT(rows[2].text, HasSubstr("Comes: ends on Straight gone around 4 times"));
}

// What is met beyond the scene's energies has been cut before it.
TEST_F(WitnessOf, EndsOnFamiliesBeyondTheLimits) {
  const scene::Limits limits = scene.limits;
  for (const double energy_to : {limits.energy_to, 0.5}) {
    input = {};
    scene.limits.energy_to = energy_to;
    if (world->is_root()) {
      EndEvidence& end = add_end("Straight");
      end.period = 99.0;
      end.level = 0.6;
    }
    const std::vector<Found> rows = found();
    scene.limits = limits;
    if (!world->is_root()) continue;
    const bool is_beyond = energy_to < 0.6;
    ASSERT_THAT(rows, ElementsAre(finding(is_beyond ? "cut" : "undecided", "unknown-family")));
    EXPECT_THAT(rows[0].text, HasSubstr(is_beyond ? "beyond the scene's limits" : "that this survey does not have"));
  }
}

TEST_F(WitnessOf, EndsByLimits) {
  if (world->is_root()) {
    add_end("StD").end->reason = continuation::EndReason::step_limit;
    add_end("LoD").end->reason = continuation::EndReason::closed_loop;
    for (EndEvidence& end : input.tree.ends) end.met = false;
  }
  const std::vector<Found> rows = found();
  if (!world->is_root()) return;
  ASSERT_THAT(rows, ElementsAre(finding("cut", "limited-end")));
  EXPECT_EQ(rows[0].family, row_named("StD"));
}

TEST_F(WitnessOf, EndsAndEventsThatRoundingHides) {
  if (world->is_root()) {
    EndEvidence& end = add_end("StD");
    end.met = false;
    end.end->reason = continuation::EndReason::undecided;
    end.end->detail = "an index is 2 to rounding";
    input.tree.undecided.push_back({key_named("LoD"), "locate: no zero"});
  }
  const std::vector<Found> rows = found();
  if (!world->is_root()) return;
  ASSERT_THAT(rows, ElementsAre(finding("undecided", "undecided-event"), finding("undecided", "undecided-end")));
  EXPECT_EQ(rows[0].family, row_named("LoD"));
  EXPECT_EQ(rows[1].family, row_named("StD"));
  EXPECT_THAT(rows[1].text, HasSubstr("an index is 2 to rounding"));
}

TEST_F(WitnessOf, EndsAtEquilibria) {
  if (world->is_root()) {
    input.equilibria = {{0.0, 0.0, 0.0, 0.0}};
    // Straight's first orbit lies beside the equilibrium at the origin, its last one, around another place, does not.
    for (const int side : {1, -1}) {
      EndEvidence& end = add_end("Straight");
      end.met = false;
      end.side = side;
      end.end->reason = continuation::EndReason::fixed_point;
    }
    for (archive::OrbitRecord& orbit : records.orbits)
      if (orbit.family_key == key_named("Straight") && orbit.period > 8.4) orbit.modes[1] += 5.0;
  }
  const std::vector<Found> rows = found();
  if (!world->is_root()) return;
  ASSERT_THAT(rows, ElementsAre(finding("undecided", "unknown-equilibrium")));
  EXPECT_NEAR(rows[0].period, 8.4172, 1e-3);
}

// A Hopf point of a curve of equilibria is known, where the parameter is the family's there.
TEST_F(WitnessOf, EndsAtHopfPoints) {
  for (const double away : {0.0, 0.1}) {
    SCOPED_TRACE(away);
    input = {};
    if (world->is_root()) {
      records = records_of(*atlas);
      EndEvidence& end = add_end("Straight");
      end.met = false;
      end.side = 1;
      end.end->reason = continuation::EndReason::fixed_point;
      double level = 0.0;
      for (archive::OrbitRecord& orbit : records.orbits) {
        if (orbit.family_key != key_named("Straight") || orbit.period <= 8.4) continue;
        orbit.modes[1] += 5.0;
        level = orbit.energy;
      }
      input.beginnings["a Hopf point"] = {0.0, 5.0, 0.0, 0.0, level + away};
    }
    const std::vector<Found> rows = found();
    if (!world->is_root()) continue;
    EXPECT_EQ(rows.size(), away == 0.0 ? 0U : 1U);
    EXPECT_THAT(rows, ::testing::Each(finding("undecided", "unknown-equilibrium")));
  }
}

TEST_F(WitnessOf, MirrorImagesThatAgree) {
  if (world->is_root()) add_image_of_straight();
  const std::vector<Found> rows = found();
  if (world->is_root()) {
    EXPECT_THAT(rows, IsEmpty());
  }
}

TEST_F(WitnessOf, MirrorImagesWithOtherCrossings) {
  if (world->is_root()) {
    add_image_of_straight();
    records.crossings.pop_back();
  }
  const std::vector<Found> rows = found();
  if (!world->is_root()) return;
  ASSERT_THAT(rows,
              ElementsAre(finding("contradiction", "mirror-crossings"), finding("contradiction", "index-change")));
  EXPECT_EQ(rows[0].deviation, 1.0);
  EXPECT_EQ(rows[1].family, rows[0].other_family);
}

TEST_F(WitnessOf, MirrorImagesWithCrossingsElsewhere) {
  if (world->is_root()) {
    add_image_of_straight();
    records.crossings.back().period *= 1.0 + 1e-5;
  }
  const std::vector<Found> rows = found();
  if (!world->is_root()) return;
  ASSERT_THAT(rows, ElementsAre(finding("contradiction", "mirror-place")));
  EXPECT_NEAR(rows[0].deviation, 1e-5, 1e-8);
}

TEST_F(WitnessOf, MirrorImagesThatEndElsewhere) {
  if (world->is_root()) {
    add_image_of_straight();
    for (int n = 0; n < 3; ++n) records.orbits.pop_back();  // the image's last
    std::erase_if(records.crossings, [&](const archive::CrossingRecord& crossing) {
      return crossing.family_key.starts_with("0001") && crossing.arclength > records.orbits.back().arclength;
    });
  }
  const std::vector<Found> rows = found();
  if (!world->is_root()) return;
  ASSERT_FALSE(rows.empty());
  EXPECT_THAT(rows[0], finding("contradiction", "mirror-end"));
}

// What are images at equilibria that are images is one curve stored twice where they are not.
TEST_F(WitnessOf, TheSameFamilyAtEquilibriaThatAreNoImages) {
  if (world->is_root()) {
    add_image_of_straight();
    input.equilibria[1][0] += 0.1;
  }
  const std::vector<Found> rows = found();
  if (world->is_root()) {
    EXPECT_THAT(rows, ElementsAre(finding("contradiction", "duplicate-curve")));
  }
}

TEST_F(WitnessOf, FailuresAndInterruptions) {
  if (world->is_root()) {
    input.failures = {"sweep 0003: a NaN"};
    input.tree.failures = {{key_named("StD"), "failure (the corrector fails)"}};
    input.tree.disputed = {key_named("LoD")};
    input.interrupted = {"0000.0007"};
  }
  const Testimony said = testimony();
  EXPECT_EQ(said.wrong, 3U);
  if (!world->is_root()) return;
  ASSERT_THAT(said.records, ElementsAre(finding("contradiction", "disputed-arrival"), finding("failure", "failed-task"),
                                        finding("failure", "failed-task"), finding("cut", "interrupted")));
  EXPECT_EQ(said.records[2].text, "StD: failure (the corrector fails)");
}

TEST(Findings, HaveNamesOfTheirOwn) {
  std::set<std::string_view> names;
  for (int n = 0; n <= static_cast<int>(last_of(FindingKind{})); ++n) {
    Finding some;
    some.kind = static_cast<FindingKind>(n);
    some.detail = "why";
    names.insert(name_of(some.kind));
    EXPECT_FALSE(text_of(some, {}).empty()) << name_of(some.kind);
  }
  EXPECT_EQ(names.size(), static_cast<std::size_t>(last_of(FindingKind{})) + 1);
  EXPECT_FALSE(names.contains("unknown"));
}

}  // namespace
}  // namespace orbweaver::survey::witness_ends_test
