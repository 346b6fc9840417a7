#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "orbweaver/archive/read/reader.hpp"
#include "orbweaver/core/serialization.hpp"
#include "orbweaver/queue/executor.hpp"
#include "verify/claims.hpp"
#include "verify/verified_atlas.hpp"

namespace orbweaver::survey {

/// Rows to be verified.
struct VerifyWork {
  static constexpr const char* payload_name = "rows to verify";
  enum class What {
    checksums,  ///< of the loops of orbits
    orbits,     ///< of one family
    crossings,
    sections,
    loci,  ///< points of them
    equilibria,
  };
  [[nodiscard]] friend constexpr What last_of(What) { return What::equilibria; }
  What what = What::orbits;
  std::int64_t first = 0;
  std::int64_t end = 0;

  static constexpr int wire_version = 1;
  template <class Archive>
  void serialize(Archive& archive, unsigned /*version*/) {
    core::serialize_members(archive, what, first, end);
  }
};

[[nodiscard]] queue::Task task_of(const VerifyWork& work);
/// What the task found; an objection to all of its rows where it failed.
[[nodiscard]] Findings findings_in(const queue::Task& task, const queue::TaskOutcome& outcome);

/// Verifies rows of an archive, which a rank opens when it gets the first.
class VerifyExecutor final : public queue::Executor {
 public:
  explicit VerifyExecutor(std::filesystem::path atlas) : _path(std::move(atlas)) {}
  queue::TaskOutcome execute(const queue::Task& task, queue::TaskContext& context) override;

 private:
  void check_checksums(const VerifyWork& work, Findings& findings);
  void check_sections(const VerifyWork& work, Findings& findings);
  const VerifiedAtlas& atlas();

  std::filesystem::path _path;
  std::optional<archive::Archive> _changed;
  std::optional<VerifiedAtlas> _atlas;
};

}  // namespace orbweaver::survey
