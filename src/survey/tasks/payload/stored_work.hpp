#pragma once

#include <cstdint>
#include <string>

#include "branch_work.hpp"
#include "orbweaver/core/serialization.hpp"
#include "orbweaver/queue/task.hpp"

namespace orbweaver::survey {

/// What travels in the place of a large payload: where it lies (state/payload_store.hpp), and what rank 0 reads of it.
struct StoredWork {
  static constexpr const char* payload_name = "stored work";
  static constexpr int most_files = 1'000'000'000;
  int file = 0;  ///< its number
  std::uint64_t offset = 0;
  std::uint64_t bytes = 0;
  std::uint32_t checksum = 0;
  std::string told;  ///< of a branch, or a start's branch: its work without loops

  static constexpr int wire_version = 1;
  template <class Archive>
  void serialize(Archive& archive, unsigned /*version*/) {
    core::serialize_members(archive, file, offset, bytes, checksum, told);
    if constexpr (Archive::is_loading::value) check_file(file);
  }

 private:
  static void check_file(int file);
};

[[nodiscard]] std::string pack(const StoredWork& work);
/// Throws EnvironmentError for bytes that hold something else, of another build, or torn.
[[nodiscard]] StoredWork unpack_stored_work(const std::string& bytes);
/// Whether a task's payload is one of these.
[[nodiscard]] bool is_stored(const std::string& payload);

/// What rank 0 reads of the payload of a branch or a start: the branch's work, without loops where it is stored.
[[nodiscard]] BranchWork told_branch(const queue::Task& task);
/// Packed for StoredWork::told; empty for tasks of other kinds.
[[nodiscard]] std::string told_of(const queue::Task& task);

}  // namespace orbweaver::survey
