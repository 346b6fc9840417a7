#pragma once

#include <string>

#include "branch_work.hpp"
#include "orbweaver/core/serialization.hpp"
#include "orbweaver/queue/task.hpp"
#include "task_kind.hpp"

namespace orbweaver::survey {

/// Find the first orbit of a family along a direction.
struct StartWork {
  static constexpr const char* payload_name = "start work";
  BranchWork branch;  ///< with the amplitude to try first

  static constexpr int wire_version = 1;
  template <class Archive>
  void serialize(Archive& archive, unsigned /*version*/) {
    core::serialize_members(archive, branch);
  }
};

struct StartOutcome {
  static constexpr const char* payload_name = "start outcome";
  int limited_by = 0;  ///< Limit: with wider ones another amplitude would have served, or a first one

  static constexpr int wire_version = 1;
  template <class Archive>
  void serialize(Archive& archive, unsigned /*version*/) {
    core::serialize_members(archive, limited_by);
    if constexpr (Archive::is_loading::value) check_limits(limited_by);
  }
};

[[nodiscard]] queue::Task task_of(const StartWork& work);

[[nodiscard]] std::string pack(const StartWork& work);
[[nodiscard]] std::string pack(const StartOutcome& outcome);
/// Throws EnvironmentError for bytes that hold something else, of another build, or torn.
[[nodiscard]] StartWork unpack_start_work(const std::string& bytes);
[[nodiscard]] StartOutcome unpack_start_outcome(const std::string& bytes);

}  // namespace orbweaver::survey
