#include <cstdint>
#include <cstring>
#include <fstream>
#include <sstream>

#include <zlib.h>

#include "archive/sample.hpp"
#include "state/branch_state.hpp"
#include "state/resume.hpp"
#include "support/fuzz.hpp"
#include "tasks/payload/payload.hpp"
#include "tasks/payload/work.hpp"

namespace {

using namespace orbweaver;
using namespace orbweaver::survey;
using test::FuzzBounds;
using test::Mutator;

const std::vector<std::string> words{"journal-",         "segment-000001.h5",  "branch",
                                     "0000.0000",        std::string(8, '\0'), std::string(8, '\xff'),
                                     "../../etc/passwd", "branch outcome"};

std::string bytes_of(const std::filesystem::path& path) {
  return (std::ostringstream() << std::ifstream(path, std::ios::binary).rdbuf()).str();
}

void write(const std::filesystem::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

/// The head of a sealed file (sealed_file.hpp) made to fit its content again.
std::string sealed_again(std::string bytes) {
  constexpr std::size_t head = 24;
  if (bytes.size() < head) return bytes;
  const std::uint64_t length = bytes.size() - head;
  std::memcpy(bytes.data() + 12, &length, sizeof length);
  const auto* data = reinterpret_cast<const Bytef*>(bytes.data());
  const auto sum = static_cast<std::uint32_t>(crc32_z(crc32_z(0, data, 20), data + head, length));
  std::memcpy(bytes.data() + 20, &sum, sizeof sum);
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

TEST(Fuzz, CheckpointsAndJournals) {
  const core::Communicator comm;
  const auto folder = test::fresh_folder("fuzz");
  BranchOutcome end;
  end.key = "0000.0000";
  end.orbits = 5;
  EndedTask entry{task_of(branch_work()), {}, true};
  entry.outcome.payload = pack(end);
  Checkpoint checkpoint;
  checkpoint.scene = "system: {name: double_pendulum}\nstarts: {}\n";
  checkpoint.journals = {write_journal(folder, 1, {entry, entry})};
  checkpoint.unfinished = {task_of(branch_work())};
  write_checkpoint(folder, checkpoint);
  write_checkpoint(folder, checkpoint);
  const std::vector<std::string> names{"checkpoint", "checkpoint.previous", "journal-000001"};
  std::vector<std::string> whole;
  for (const std::string& name : names) whole.push_back(bytes_of(folder / name));
  Mutator mutator(4);
  FuzzBounds bounds;
  int gone_on = 0;
  for (int n = test::fuzz_count(1000); n > 0; --n) {
    for (std::size_t i = 0; i < names.size(); ++i) write(folder / names[i], whole[i]);
    const std::size_t which = mutator.below(names.size());
    std::string changed = mutator.changed(whole[which], words);
    if (mutator.below(2) == 0) changed = sealed_again(std::move(changed));
    write(folder / names[which], changed);
    bounds.run(changed, [&] { gone_on += find_checkpoint(comm, folder).found ? 1 : 0; });
  }
  EXPECT_GT(gone_on, 0) << "some must fall back to the other checkpoint";
  bounds.check("checkpoints and journals");
}

template <class T>
void change(Mutator& mutator, FuzzBounds& bounds, const T& value) {
  const std::string changed = mutator.changed(to_payload(value), words);
  bounds.run(changed, [&] {
    try {
      (void)from_payload<T>(changed);
    } catch (const core::EnvironmentError& error) {
      throw core::InputError(error.what());
    }
  });
}

TEST(Fuzz, Payloads) {
  Mutator mutator(5);
  FuzzBounds bounds;
  SweepOutcome sweep;
  sweep.modes.resize(3);
  sweep.rejected = {"a dip"};
  LocateOutcome located;
  located.state = {1.0, 2.0, 3.0, 4.0};
  for (int n = test::fuzz_count(3000); n > 0; --n) switch (mutator.below(4)) {
      case 0: change(mutator, bounds, branch_work()); break;
      case 1: change(mutator, bounds, sweep); break;
      case 2: change(mutator, bounds, located); break;
      default: change(mutator, bounds, BranchState{});
    }
  bounds.check("payloads");
}

}  // namespace
