#include <cstdint>
#include <cstring>

#include <zlib.h>

#include "fuzz/kinds.hpp"
#include "orbweaver/core/log/log.hpp"
#include "state/branch_state.hpp"
#include "state/payload_store.hpp"
#include "state/resume.hpp"

namespace orbweaver::fuzz {

namespace {

using namespace survey;

const std::vector<std::string> words{"journal-",         "segment-000001.h5",  "branch",
                                     "0000.0000",        std::string(8, '\0'), std::string(8, '\xff'),
                                     "../../etc/passwd", "branch outcome"};

/// The head of a sealed file (sealed_file.hpp) made to fit its content again.
std::string sealed_again(std::string bytes) {
  constexpr std::size_t head = 24, place_of_length = 12, place_of_sum = 20;
  if (bytes.size() < head) return bytes;
  const std::uint64_t length = bytes.size() - head;
  std::memcpy(bytes.data() + place_of_length, &length, sizeof length);
  const auto* data = reinterpret_cast<const Bytef*>(bytes.data());
  const auto sum = static_cast<std::uint32_t>(crc32_z(crc32_z(0, data, place_of_sum), data + head, length));
  std::memcpy(bytes.data() + place_of_sum, &sum, sizeof sum);
  return bytes;
}

BranchWork branch_work() {
  BranchWork work;
  work.key = work.lineage.family = "0000.0000";
  work.name = "In-Phase";
  work.base.dimension = 2;
  work.base.cutoff = 1;
  work.base.period = 3.0;
  work.base.modes = {0.0, 1.0, 2.0, 3.0, 4.0, 5.0};
  work.base.winding = {0.0, 0.0};
  return work;
}

EndedTask ended(queue::Task task, std::string outcome) {
  EndedTask entry{std::move(task), {}, true};
  entry.outcome.key = entry.task.key;
  entry.outcome.payload = std::move(outcome);
  return entry;
}

/// A location, and where its payload lies.
queue::Task stored_location(PayloadStore& store) {
  LocateWork work;
  work.name = std::string(least_stored, 'x');
  queue::Task task = task_of(work);
  store.keep(task);
  return task;
}

/// One ended task of each kind, and two journals; payloads that are still counted on lie behind one that is not.
Checkpoint sample(const std::filesystem::path& folder) {
  PayloadStore store(folder);
  store.open(core::Communicator(MPI_COMM_SELF));
  (void)stored_location(store);
  BranchWork large = branch_work();
  large.name = std::string(least_stored, 'x');
  queue::Task stored_start = task_of(StartWork{large});
  store.keep(stored_start);
  BranchState state;
  state.children = {stored_location(store)};
  BranchOutcome branch;
  branch.key = "0000.0000";
  branch.before_limit = pack(state);
  SweepOutcome sweep;
  sweep.modes.resize(3);
  sweep.kernels.resize(1);
  sweep.equilibria.resize(2);
  sweep.rejected = {"a dip"};
  LocateOutcome located;
  located.state = {1.0, 2.0, 3.0, 4.0};
  located.leaving.resize(2);
  Checkpoint checkpoint;
  checkpoint.scene = "system: {name: double_pendulum}\nstarts: {}\n";
  checkpoint.journals = {
      write_journal(folder, 1, {ended(task_of(SweepWork{}), pack(sweep)), ended(task_of(branch_work()), pack(branch))}),
      write_journal(folder, 2,
                    {ended(task_of(LocateWork{}), pack(located)),
                     ended(task_of(StartWork{branch_work()}), pack(StartOutcome{})),
                     ended(stored_start, pack(StartOutcome{}))})};
  checkpoint.unfinished = {task_of(branch_work())};
  checkpoint.unfinished[0].state = pack(state);
  checkpoint.left_out = {task_of(LocateWork{}), stored_location(store)};
  return checkpoint;
}

/// `changed` is the name of the file that is another in each input.
Kind state_kind(const std::filesystem::path& folder, const std::string& changed) {
  const std::filesystem::path file = folder / changed;
  const Checkpoint checkpoint = sample(folder);
  write_checkpoint(folder, checkpoint);
  write_checkpoint(folder, checkpoint);
  std::vector<std::pair<std::filesystem::path, std::string>> whole;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    whole.emplace_back(entry.path(), bytes_of(entry.path()));
  core::start_logging(core::LogLevel::error, 0, 1);
  return {[bytes = bytes_of(file)](Mutator& mutator) {
            std::string other = mutator.changed(bytes, words);
            return mutator.below(2) == 0 ? sealed_again(std::move(other)) : other;
          },
          [=](const std::string& bytes) {
            for (const auto& [path, content] : whole) write_bytes(path, content);
            write_bytes(file, bytes);
            const core::Communicator comm(MPI_COMM_SELF);
            Found found = find_checkpoint(comm, folder);
            if (!found.found) throw WrongReading{"the checkpoints were not seen"};
            continue_with(scene::parse(checkpoint.scene, "scene"), folder, found.checkpoint, [](const EndedTask&) {});
          }};
}

}  // namespace

Kind checkpoints(const std::filesystem::path& folder) { return state_kind(folder, "checkpoint"); }
Kind journals(const std::filesystem::path& folder) { return state_kind(folder, "journal-000001"); }
Kind payloads(const std::filesystem::path& folder) { return state_kind(folder, payload_file(1)); }

}  // namespace orbweaver::fuzz
