#pragma once

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
inline void PrintTo(const FindingRecord& finding, std::ostream* out) {
  *out << finding.severity << " " << finding.kind << ": " << finding.text;
}

}  // namespace orbweaver::archive

namespace orbweaver::survey {

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

[[nodiscard]] inline auto finding(const std::string& severity, const std::string& kind) {
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
  /// As if the family went back along itself from its last orbit.
  void turn_back(const std::string& name) {
    const std::vector<archive::OrbitRecord> orbits = orbits_of(key_named(name));
    const archive::OrbitRecord& last = orbits.back();
    for (std::size_t n = orbits.size() - 1; n-- > 0;) {
      archive::OrbitRecord orbit = orbits[n];
      orbit.step = 2 * last.step - orbit.step;
      orbit.arclength = 2.0 * last.arclength - orbit.arclength;
      records.orbits.push_back(orbit);
    }
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

}  // namespace orbweaver::survey
