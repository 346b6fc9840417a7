#include "witness/witness.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <set>

#include <fmt/format.h>

#include "orbweaver/archive/schema/schema.hpp"
#include "survey/atlas.hpp"
#include "survey/atlas_records.hpp"
#include "tasks/payload/task_kind.hpp"

namespace orbweaver::archive {

/// For gtest's messages.
void PrintTo(const FindingRecord& finding, std::ostream* out) {
  *out << finding.severity << " " << finding.kind << ": " << finding.text;
}

}  // namespace orbweaver::archive

namespace {

using namespace orbweaver;
using namespace orbweaver::survey;
using test::Atlas;
using test::key_of;
using test::records_of;
using ::testing::AllOf;
using ::testing::AnyOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::Field;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::IsSupersetOf;

using Found = archive::FindingRecord;

auto finding(const std::string& severity, const std::string& kind) {
  return AllOf(Field(&Found::severity, severity), Field(&Found::kind, kind));
}

/// Faults planted in the survey of Henon-Heiles, whose tree adds up.
class WitnessOf : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    world = std::make_unique<core::Communicator>();
    scene = scene::load(ORBWEAVER_SOURCE_DIR "/drivers/scenes/henon_heiles.yaml", {});
    summary = test::run(*world, scene, "witness");
    if (world->is_root()) atlas = std::make_unique<Atlas>(summary.atlas);
  }
  static void TearDownTestSuite() {
    atlas.reset();
    world.reset();
  }

  void SetUp() override {
    if (atlas) records = records_of(*atlas);
  }

  /// What the witness says of `records`, on every rank.
  Testimony testimony() {
    const auto folder = test::fresh_folder(fmt::format("witness_case{}", world->size()), world->get());
    if (world->is_root()) {
      test::write_sample_atlas(folder, atlas->header(), records);
      for (const archive::FamilyRecord& family : records.families) input.family_keys.push_back(family.key);
      std::sort(input.family_keys.begin(), input.family_keys.end());
      for (std::size_t n = 0; n < records.crossings.size(); ++n) input.crossing_rows.push_back(static_cast<int>(n));
    }
    const auto system = systems::make_system(scene.system.name, scene.system.parameters, scene.system.effects);
    return testify(*world, folder / "atlas.h5", scene, system, std::move(input)).value();
  }
  std::vector<Found> found() { return testimony().records; }

  static int row_named(const std::string& name) { return static_cast<int>(atlas->row_of(name)); }
  std::string key_named(const std::string& name) const { return key_of(row_named(name)); }

  std::vector<archive::OrbitRecord> orbits_of(const std::string& key) const {
    std::vector<archive::OrbitRecord> orbits;
    for (const archive::OrbitRecord& orbit : records.orbits)
      if (orbit.family_key == key) orbits.push_back(orbit);
    return orbits;
  }
  void remove_orbits(const std::string& key) {
    std::erase_if(records.orbits, [&](const archive::OrbitRecord& orbit) { return orbit.family_key == key; });
  }
  void remove_crossing(int row) {
    records.crossings.erase(records.crossings.begin() + row);
    for (archive::FamilyRecord& family : records.families)
      if (family.crossing > row) --family.crossing;
  }
  void remove_family(const std::string& key) {
    remove_orbits(key);
    std::erase_if(records.families, [&](const auto& family) { return family.key == key; });
    for (std::size_t n = records.crossings.size(); n-- > 0;)
      if (records.crossings[n].family_key == key) remove_crossing(static_cast<int>(n));
  }
  /// Another family with orbits of this one: every second, from the given one on.
  void add_every_second(const std::vector<archive::OrbitRecord>& orbits, std::size_t from, const std::string& key) {
    int step = 0;
    for (std::size_t n = from; n < orbits.size(); n += 2) {
      archive::OrbitRecord orbit = orbits[n];
      orbit.family_key = key;
      orbit.step = step++;
      records.orbits.push_back(orbit);
    }
  }
  archive::FamilyRecord& add_family_like(const std::string& name, const std::string& key) {
    archive::FamilyRecord family = records.families[static_cast<std::size_t>(row_named(name))];
    family.key = key;
    return records.families.emplace_back(std::move(family));
  }
  /// The family with its orbits and crossings once more at the second equilibrium, an image of the first.
  void add_image_of_straight() {
    input.equilibria = {{0.0, 1.0, 0.0, 0.0}, {std::sqrt(0.75), -0.5, 0.0, 0.0}};
    const std::string key = key_named("Straight");
    const std::string image = key_of(row_named("Straight"), 1);
    add_family_like("Straight", image).name = "Image";
    for (archive::OrbitRecord orbit : orbits_of(key)) {
      orbit.family_key = image;
      records.orbits.push_back(orbit);
    }
    for (const archive::CrossingRecord& crossing : std::vector(records.crossings)) {
      if (crossing.family_key != key) continue;
      records.crossings.push_back(crossing);
      records.crossings.back().family_key = image;
    }
  }
  CrossingEvidence& add_crossing(int row) {
    CrossingEvidence& crossing = input.tree.crossings.emplace_back();
    crossing.crossing = row;
    return crossing;
  }
  EndEvidence& add_end(const std::string& name) {
    EndEvidence& end = input.tree.ends.emplace_back();
    end.family = key_named(name);
    end.end = continuation::Ending{continuation::EndReason::stopped, ""};
    end.met = true;
    return end;
  }

  /// The kernel at the centre, with as many images of each family as the triangle makes. Keys of families are rows.
  static KernelRecord kernel_of_centre() {
    if (!atlas) return {};
    return {2.0 * std::numbers::pi,
            2,
            true,
            0,
            {row_named("Straight"), row_named("Curved"), row_named("Loop")},
            {3, 3, 2},
            {1, 1, 1}};
  }

  static inline std::unique_ptr<core::Communicator> world;
  static inline scene::Scene scene;
  static inline Summary summary;
  static inline std::unique_ptr<Atlas> atlas;
  archive::Records records;
  WitnessInput input;
};

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

TEST_F(WitnessOf, ACurveThatTurnsBackOnItself) {
  if (world->is_root()) {
    std::vector<archive::OrbitRecord> orbits = orbits_of(key_named("Curved"));
    const archive::OrbitRecord last = orbits.back();
    for (std::size_t n = orbits.size() - 1; n-- > 0;) {
      archive::OrbitRecord orbit = orbits[n];
      orbit.step = 2 * last.step - orbit.step;
      orbit.arclength = 2.0 * last.arclength - orbit.arclength;
      records.orbits.push_back(orbit);
    }
  }
  const std::vector<Found> rows = found();
  if (!world->is_root()) return;
  ASSERT_THAT(rows, ElementsAre(finding("contradiction", "retraced-curve")));
  EXPECT_EQ(rows[0].family, row_named("Curved"));
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
      end.energy = straight[8].energy + (times == 0 ? 0.01 : 0.0);
    }
  }
  const std::vector<Found> rows = found();
  if (!world->is_root()) return;
  ASSERT_THAT(rows, ElementsAre(finding("undecided", "unlisted-crossing"), finding("undecided", "unknown-family"),
                                finding("cut", "higher-order")));
  EXPECT_EQ(rows[0].other_family, row_named("Straight"));
  EXPECT_THAT(rows[2].text, HasSubstr("Comes: ends on Straight gone around 4 times"));
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
