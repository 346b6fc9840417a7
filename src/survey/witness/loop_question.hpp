#pragma once

#include <memory>
#include <optional>
#include <string>

#include "orbweaver/archive/read/reader.hpp"
#include "orbweaver/core/serialization.hpp"
#include "orbweaver/queue/executor.hpp"
#include "orbweaver/scene/scene.hpp"
#include "orbweaver/survey/atlas/loop_check.hpp"
#include "orbweaver/systems/system.hpp"

namespace orbweaver::survey {

/// Whether an orbit of one family, or the orbit at a crossing, lies on another family. Rows of the atlas.
struct LoopQuestion {
  static constexpr const char* payload_name = "loop question";
  int family = -1;
  int orbit = 0;      ///< of the family's; or
  int crossing = -1;  ///< the crossing's orbit, gone around as what is born there
  int beside = -1;
  int segment = 0;  ///< between its orbits segment and segment + 1

  static constexpr int wire_version = 1;
  template <class Archive>
  void serialize(Archive& archive, unsigned /*version*/) {
    core::serialize_members(archive, family, orbit, crossing, beside, segment);
  }
};

struct LoopReply {
  static constexpr const char* payload_name = "loop reply";
  bool same = false;
  bool decided = false;
  double distance = 0.0;

  static constexpr int wire_version = 1;
  template <class Archive>
  void serialize(Archive& archive, unsigned /*version*/) {
    core::serialize_members(archive, same, decided, distance);
  }
};

struct Answered {
  LoopQuestion question;
  LoopReply reply;
};

[[nodiscard]] queue::Task task_of(const LoopQuestion& question, std::size_t number);
/// Not decided where the task failed.
[[nodiscard]] LoopReply reply_in(const queue::TaskOutcome& outcome);

/// Answers questions about an atlas, which a rank opens when it gets the first.
class LoopExecutor final : public queue::Executor {
 public:
  LoopExecutor(std::filesystem::path atlas, std::shared_ptr<const systems::System> system)
      : _path(std::move(atlas)), _loops(std::move(system)) {}
  queue::TaskOutcome execute(const queue::Task& task, queue::TaskContext& context) override;

 private:
  [[nodiscard]] const AtlasTree& tree();

  std::filesystem::path _path;
  LoopCheck _loops;
  std::optional<archive::Archive> _atlas;
  std::optional<AtlasTree> _tree;
};

}  // namespace orbweaver::survey
