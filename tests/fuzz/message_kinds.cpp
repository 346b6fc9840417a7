#include <cstdint>
#include <cstring>

#include <zlib.h>

#include "fuzz/kinds.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/queue/message.hpp"

namespace orbweaver::fuzz {

namespace {

const std::vector<std::string> words{std::string(8, '\0'), std::string(8, '\xff'), "branch", "0000.0001/003.q4.j1"};

std::vector<std::string> seeds() {
  const queue::Task task{"0000.0001", -7, "branch", "payload", "state"};
  queue::TaskOutcome outcome;
  outcome.key = task.key;
  outcome.children = {task, task};
  outcome.payload = std::string(200, 'p');
  const std::vector<queue::Message> messages{
      queue::Hello{},           queue::Assign{task},  queue::Outcome{outcome, 5},
      queue::FlushRequest{3},   queue::Stop{},        queue::ProgressReport{"k", {12, 34, {1.5, 2.5}}},
      queue::FlushGo{5},        queue::Alarm{"torn"}, queue::FlushReady{4, 9, "state"},
      queue::FlushDone{6, "e"}, queue::EndTask{"k"},  queue::Shutdown{"e", 1, 2, 3, 4, true, 6, 7, 8.5},
      queue::Goodbye{10, 0.25}};
  std::vector<std::string> packed;
  for (const queue::Message& message : messages) packed.push_back(queue::pack(message));
  return packed;
}

/// The envelope (message.hpp) made to fit the body again.
std::string in_its_envelope(std::string bytes) {
  constexpr std::size_t place_of_length = 16, place_of_sum = queue::envelope_bytes - sizeof(std::uint32_t);
  if (bytes.size() < queue::envelope_bytes) return bytes;
  const std::uint64_t length = bytes.size() - queue::envelope_bytes;
  std::memcpy(bytes.data() + place_of_length, &length, sizeof length);
  const auto* data = reinterpret_cast<const Bytef*>(bytes.data());
  const auto sum =
      static_cast<std::uint32_t>(crc32_z(crc32_z(0, data, place_of_sum), data + queue::envelope_bytes, length));
  std::memcpy(bytes.data() + place_of_sum, &sum, sizeof sum);
  return bytes;
}

}  // namespace

Kind messages() {
  return {[packed = seeds()](Mutator& mutator) {
            std::string bytes = mutator.changed(mutator.one_of(packed), words);
            return mutator.below(2) == 0 ? in_its_envelope(std::move(bytes)) : bytes;
          },
          [](const std::string& bytes) {
            try {
              (void)queue::unpack(bytes, "from rank 3");
            } catch (const core::EnvironmentError& error) {
              throw core::InputError(error.what());  // to a run a message that cannot be used is the machine's failure
            }
          }};
}

}  // namespace orbweaver::fuzz
