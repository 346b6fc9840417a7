#include "channel.hpp"

#include <limits>
#include <utility>

#include <fmt/format.h>

#include "orbweaver/core/error.hpp"
#include "orbweaver/core/mpi/check_mpi.hpp"

namespace orbweaver::queue {

Message Received::open() const {
  const std::string where = fmt::format("from rank {}", source);
  Message message = unpack(bytes, where);
  if (!is(tag_of(message)))
    throw core::EnvironmentError(fmt::format("the message {} cannot be used: it came as {} and is a {}", where,
                                             tag_name(tag), tag_name(static_cast<int>(tag_of(message)))));
  return message;
}

Channel::~Channel() {
  for (Sending& one : _sending) MPI_Wait(&one.request, MPI_STATUS_IGNORE);
}

void Channel::send(int to, const Message& message) {
  start(to, tag_of(message), std::make_shared<const std::string>(pack(message)));
}

void Channel::send_to_workers(const Message& message) {
  const auto bytes = std::make_shared<const std::string>(pack(message));
  for (int worker = 1; worker < _comm.size(); ++worker) start(worker, tag_of(message), bytes);
}

void Channel::start(int to, Tag tag, std::shared_ptr<const std::string> bytes) {
  if (bytes->size() > static_cast<std::size_t>(std::numeric_limits<int>::max()))
    throw core::EnvironmentError(
        fmt::format("a message must have less than 2 GiB, and a {} to rank {} has {} bytes; keep large "
                    "results for the flush instead of putting them into payloads",
                    tag_name(static_cast<int>(tag)), to, bytes->size()));
  Sending& one = _sending.emplace_back(Sending{std::move(bytes)});
  core::check_mpi(MPI_Isend(one.bytes->data(), static_cast<int>(one.bytes->size()), MPI_BYTE, to, static_cast<int>(tag),
                            _comm.get(), &one.request),
                  "MPI_Isend");
}

std::optional<Received> Channel::poll() {
  MPI_Status status{};
  int found = 0;
  core::check_mpi(MPI_Iprobe(MPI_ANY_SOURCE, MPI_ANY_TAG, _comm.get(), &found, &status), "MPI_Iprobe");
  if (found == 0) return std::nullopt;
  int count = 0;
  core::check_mpi(MPI_Get_count(&status, MPI_BYTE, &count), "MPI_Get_count");
  Received received{status.MPI_SOURCE, status.MPI_TAG, std::string(static_cast<std::size_t>(count), '\0')};
  core::check_mpi(
      MPI_Recv(received.bytes.data(), count, MPI_BYTE, received.source, received.tag, _comm.get(), MPI_STATUS_IGNORE),
      "MPI_Recv");
  return received;
}

bool Channel::sending() {
  for (auto one = _sending.begin(); one != _sending.end();) {
    int sent = 0;
    core::check_mpi(MPI_Test(&one->request, &sent, MPI_STATUS_IGNORE), "MPI_Test");
    one = sent != 0 ? _sending.erase(one) : std::next(one);
  }
  return !_sending.empty();
}

}  // namespace orbweaver::queue
