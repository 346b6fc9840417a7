#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <variant>

#include "orbweaver/core/serialization.hpp"
#include "orbweaver/queue/progress.hpp"
#include "orbweaver/queue/task.hpp"

namespace orbweaver::queue {

/// Version of who sends what and when (docs/protocol.md); ranks of different versions do not work together.
inline constexpr std::uint32_t protocol_version = 3;
/// Version of the envelope and of how the messages are laid out in it.
inline constexpr std::uint32_t message_format_version = 3;

/// All MPI tags of the queue; the tag is also the type in the envelope.
enum class Tag : int {
  hello = 1,
  assign,
  outcome,
  progress,
  flush_request,
  flush_ready,
  flush_go,
  flush_done,
  stop,
  alarm,
  shutdown,
  goodbye,
  end_task,
};

/// Worker -> rank 0: I am here and have no task.
struct Hello {
  static constexpr Tag tag = Tag::hello;
  std::uint32_t version = protocol_version;

  static constexpr int wire_version = 1;
  template <class Archive>
  void serialize(Archive& archive, unsigned /*version*/) {
    core::serialize_members(archive, version);
  }
};

/// Rank 0 -> idle worker: do this.
struct Assign {
  static constexpr Tag tag = Tag::assign;
  Task task;

  static constexpr int wire_version = 1;
  template <class Archive>
  void serialize(Archive& archive, unsigned /*version*/) {
    core::serialize_members(archive, task);
  }
};

/// Worker -> rank 0: this became of your task; I have none now.
struct Outcome {
  static constexpr Tag tag = Tag::outcome;
  TaskOutcome outcome;
  std::int64_t rows = 0;  ///< ready since the last message that counted rows

  static constexpr int wire_version = 1;
  template <class Archive>
  void serialize(Archive& archive, unsigned /*version*/) {
    core::serialize_members(archive, outcome, rows);
  }
};

/// Worker -> rank 0: this far.
struct ProgressReport {
  static constexpr Tag tag = Tag::progress;
  std::string key;
  Progress progress;

  static constexpr int wire_version = 1;
  template <class Archive>
  void serialize(Archive& archive, unsigned /*version*/) {
    core::serialize_members(archive, key, progress);
  }
};

/// Rank 0 -> all workers: stand still at your next report.
struct FlushRequest {
  static constexpr Tag tag = Tag::flush_request;
  int number = 0;

  static constexpr int wire_version = 1;
  template <class Archive>
  void serialize(Archive& archive, unsigned /*version*/) {
    core::serialize_members(archive, number);
  }
};

/// Worker -> rank 0: I stand still.
struct FlushReady {
  static constexpr Tag tag = Tag::flush_ready;
  int number = 0;
  std::int64_t rows = 0;  ///< ready since the last message that counted rows
  std::string state{};    ///< of the running task; empty: none, or it would begin again

  static constexpr int wire_version = 1;
  template <class Archive>
  void serialize(Archive& archive, unsigned /*version*/) {
    core::serialize_members(archive, number, rows, state);
  }
};

/// Rank 0 -> all workers: enter the flush now.
struct FlushGo {
  static constexpr Tag tag = Tag::flush_go;
  int number = 0;

  static constexpr int wire_version = 1;
  template <class Archive>
  void serialize(Archive& archive, unsigned /*version*/) {
    core::serialize_members(archive, number);
  }
};

/// Worker -> rank 0: I have flushed, or failed to.
struct FlushDone {
  static constexpr Tag tag = Tag::flush_done;
  int number = 0;
  std::string error;  ///< empty: it went well

  static constexpr int wire_version = 1;
  template <class Archive>
  void serialize(Archive& archive, unsigned /*version*/) {
    core::serialize_members(archive, number, error);
  }
};

/// Rank 0 -> all workers: end the task you have at your next report. Worker -> rank 0: I was asked to stop the run.
struct Stop {
  static constexpr Tag tag = Tag::stop;

  static constexpr int wire_version = 1;
  template <class Archive>
  void serialize(Archive& /*archive*/, unsigned /*version*/) {}
};

/// Worker -> rank 0: the protocol broke here; end the run.
struct Alarm {
  static constexpr Tag tag = Tag::alarm;
  std::string error;

  static constexpr int wire_version = 1;
  template <class Archive>
  void serialize(Archive& archive, unsigned /*version*/) {
    core::serialize_members(archive, error);
  }
};

/// Rank 0 -> all workers: the run is over.
struct Shutdown {
  static constexpr Tag tag = Tag::shutdown;
  std::string error;  ///< empty: it ended well; else what every rank throws
  std::uint64_t done = 0;
  std::uint64_t failed = 0;
  std::uint64_t waiting = 0;
  std::uint64_t stopped = 0;
  bool stopped_early = false;
  int flushes = 0;
  std::int64_t rows = 0;
  double seconds = 0.0;

  static constexpr int wire_version = 1;
  template <class Archive>
  void serialize(Archive& archive, unsigned /*version*/) {
    core::serialize_members(archive, error, done, failed, waiting, stopped, stopped_early, flushes, rows, seconds);
  }
};

/// Worker -> rank 0: my last message.
struct Goodbye {
  static constexpr Tag tag = Tag::goodbye;
  std::int64_t tasks = 0;
  double busy_seconds = 0.0;

  static constexpr int wire_version = 1;
  template <class Archive>
  void serialize(Archive& archive, unsigned /*version*/) {
    core::serialize_members(archive, tasks, busy_seconds);
  }
};

/// Rank 0 -> worker: end this task at your next report; its time is over.
struct EndTask {
  static constexpr Tag tag = Tag::end_task;
  std::string key;

  static constexpr int wire_version = 1;
  template <class Archive>
  void serialize(Archive& archive, unsigned /*version*/) {
    core::serialize_members(archive, key);
  }
};

using Message = std::variant<Hello, Assign, Outcome, ProgressReport, FlushRequest, FlushReady, FlushGo, FlushDone, Stop,
                             Alarm, Shutdown, Goodbye, EndTask>;

[[nodiscard]] Tag tag_of(const Message& message);
/// "flush_ready", ...; "tag 77" for a number that is none of ours.
[[nodiscard]] std::string tag_name(int tag);

/// Size of the envelope: magic (8 bytes), format version (4), type (4), body length (8), CRC-32 of all that and the
/// body (4).
inline constexpr std::size_t envelope_bytes = 28;

/// The bytes to send. They are for ranks of one job (same machine type, same build), not for files.
[[nodiscard]] std::string pack(const Message& message);

/// The message in `bytes`. `where` says where they came from ("from rank 3"). Throws EnvironmentError, naming what was
/// expected and what came, unless they are whole, unchanged, ours, and of our format version.
[[nodiscard]] Message unpack(std::string_view bytes, std::string_view where);

}  // namespace orbweaver::queue
