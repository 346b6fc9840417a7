#include "checkpoint.hpp"

#include <algorithm>
#include <functional>
#include <string_view>

#include <fmt/format.h>

#include "orbweaver/archive/file/sealed_file.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/core/survey_folder.hpp"
#include "orbweaver/core/text.hpp"
#include "tasks/payload/payload.hpp"

namespace orbweaver::survey {

namespace {

// Counts up with every change of what the files hold, payloads and states included.
constexpr std::uint32_t file_version = 6;
constexpr archive::Seal checkpoint_seal{"ORBWCKP\x1a", file_version};
constexpr archive::Seal journal_seal{"ORBWJRN\x1a", file_version};

struct Journal {
  static constexpr const char* payload_name = "journal";
  std::vector<EndedTask> entries;

  static constexpr int wire_version = 1;
  template <class Archive>
  void serialize(Archive& archive, unsigned /*version*/) {
    core::serialize_members(archive, entries);
  }
};

/// A file with the right seal that does not hold what it should is wrong input all the same.
template <class T>
T unsealed(const std::filesystem::path& path, const archive::Seal& seal) {
  const std::string bytes = archive::read_sealed(path, seal);
  try {
    return from_payload<T>(bytes);
  } catch (const core::EnvironmentError& error) {
    throw core::InputError(fmt::format("{}: {}", path.string(), error.what()));
  }
}

}  // namespace

std::filesystem::path state_folder(const std::filesystem::path& directory) { return core::segments_in(directory); }
std::filesystem::path checkpoint_path(const std::filesystem::path& folder) { return folder / "checkpoint"; }
std::filesystem::path previous_checkpoint_path(const std::filesystem::path& folder) {
  return folder / "checkpoint.previous";
}

CheckpointMark write_checkpoint(const std::filesystem::path& folder, const Checkpoint& checkpoint,
                                const CheckpointMark& newest) {
  const std::string bytes = to_payload(checkpoint);
  const CheckpointMark mark{bytes.size(), std::hash<std::string_view>()(bytes)};
  if (mark == newest && std::filesystem::exists(checkpoint_path(folder))) return mark;
  archive::write_sealed_keeping(checkpoint_path(folder), previous_checkpoint_path(folder), checkpoint_seal, bytes);
  return mark;
}

Checkpoint read_checkpoint(const std::filesystem::path& path) { return unsealed<Checkpoint>(path, checkpoint_seal); }

std::size_t next_journal(const Checkpoint& checkpoint) {
  std::size_t largest = 0;
  for (const JournalFile& file : checkpoint.journals)
    largest = std::max(largest, static_cast<std::size_t>(std::stoul(file.name.substr(file.name.find('-') + 1))));
  return largest + 1;
}

JournalFile write_journal(const std::filesystem::path& folder, std::size_t number,
                          const std::vector<EndedTask>& entries) {
  JournalFile file{fmt::format("journal-{:06}", number), entries.size()};
  archive::write_sealed(folder / file.name, journal_seal, to_payload(Journal{entries}));
  return file;
}

std::vector<EndedTask> read_journal(const std::filesystem::path& folder, const JournalFile& file) {
  std::vector<EndedTask> entries = unsealed<Journal>(folder / file.name, journal_seal).entries;
  for (EndedTask& entry : entries) entry.outcome.reason = core::recordable(entry.outcome.reason);
  if (entries.size() != file.entries)
    throw core::InputError(fmt::format("{}: it should list {} ended tasks and lists {}", (folder / file.name).string(),
                                       file.entries, entries.size()));
  return entries;
}

scene::Scene scene_of(const Checkpoint& checkpoint) {
  return scene::parse(checkpoint.scene, "the checkpoint's scene", {}, checkpoint.model);
}

}  // namespace orbweaver::survey
