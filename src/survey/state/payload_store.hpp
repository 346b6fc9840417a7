#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "orbweaver/archive/file/piece_file.hpp"
#include "orbweaver/core/mpi/communicator.hpp"
#include "orbweaver/queue/task.hpp"

namespace orbweaver::survey {

/// Bytes that are fewer travel as they are: a message of this size is sent in one piece.
inline constexpr std::size_t least_stored = 4096;

/// What the names of files of payloads begin with.
inline constexpr std::string_view payload_prefix = "payloads-";
/// The name of one, in the folder of segments.
[[nodiscard]] std::string payload_file(int number);

/// What a task's payload, or the state of a branch before a limit, stands for, from `folder`; that itself if it is not
/// stored. Throws InputError that names the file if it cannot be read as it was written.
[[nodiscard]] std::string whole_payload(const std::filesystem::path& folder, const std::string& payload);

/// Keeps large payloads of the tasks that this rank makes, and states of its branches before limits, in a file of its
/// own beside the segments, so that rank 0, its journals and checkpoints have only where they lie (StoredWork). Every
/// rank reads those of all.
class PayloadStore {
 public:
  explicit PayloadStore(std::filesystem::path folder) : _folder(std::move(folder)) {}

  /// Gives every rank the name of a file that is not there. Collective, when rank 0 has put the folder in order.
  void open(const core::Communicator& comm);
  /// A large payload goes into the file, and the task says where; one that cannot be written stays in the task.
  void keep(queue::Task& task);
  void keep(std::string& bytes, const std::string& told = {});
  /// As whole_payload; what it throws, the next sync throws as well.
  [[nodiscard]] std::string whole(const queue::Task& task);
  /// All that was kept is on the disk. Throws EnvironmentError.
  void sync();

 private:
  std::filesystem::path _folder;
  int _number = 0;
  std::optional<archive::PieceWriter> _file;
  std::string _fault;       // why a payload could not be read
  bool _has_warned = false;  // of payloads that cannot be written
};

}  // namespace orbweaver::survey
