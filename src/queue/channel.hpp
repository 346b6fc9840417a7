#pragma once

#include <list>
#include <memory>
#include <optional>
#include <string>

#include <mpi.h>

#include "orbweaver/core/mpi/communicator.hpp"
#include "orbweaver/queue/message.hpp"

namespace orbweaver::queue {

/// A message as it came.
struct Received {
  int source = 0;
  int tag = 0;
  std::string bytes;

  [[nodiscard]] bool is(Tag expected) const { return tag == static_cast<int>(expected); }
  /// Validated. Throws EnvironmentError.
  [[nodiscard]] Message open() const;
};

/// Sends and receives the queue's messages; nothing here waits for another rank.
class Channel {
 public:
  explicit Channel(const core::Communicator& comm) : _comm(comm) {}
  Channel(const Channel&) = delete;
  Channel& operator=(const Channel&) = delete;
  Channel(Channel&&) = delete;
  Channel& operator=(Channel&&) = delete;
  /// Waits for what is still being sent, for its bytes live here.
  ~Channel();

  /// Throws EnvironmentError when the message is too long for MPI (2 GiB).
  void send(int to, const Message& message);
  /// The same from rank 0 to all others.
  void send_to_workers(const Message& message);
  /// The next message from anybody, if there is one.
  [[nodiscard]] std::optional<Received> poll();
  /// Whether a message is still being sent.
  [[nodiscard]] bool sending();

 private:
  struct Sending {
    std::shared_ptr<const std::string> bytes;
    MPI_Request request = MPI_REQUEST_NULL;
  };
  void start(int to, Tag tag, std::shared_ptr<const std::string> bytes);

  const core::Communicator& _comm;
  std::list<Sending> _sending;
};

}  // namespace orbweaver::queue
