#include "payload_store.hpp"

#include <algorithm>
#include <charconv>
#include <system_error>

#include <fmt/format.h>

#include "orbweaver/core/error.hpp"
#include "orbweaver/core/log/log.hpp"
#include "orbweaver/core/mpi/collective.hpp"
#include "orbweaver/core/pause.hpp"
#include "tasks/payload/stored_work.hpp"

namespace orbweaver::survey {

namespace {

/// The number behind the last of the folder's files.
int first_free(const std::filesystem::path& folder) {
  int free = 1;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (!name.starts_with(payload_prefix)) continue;
    int number = 0;
    std::from_chars(name.data() + payload_prefix.size(), name.data() + name.size(), number);
    free = std::max(free, std::min(number, StoredWork::most_files) + 1);
  }
  return free;
}

}  // namespace

std::string payload_file(int number) { return fmt::format("{}{:06}", payload_prefix, number); }

std::string whole_payload(const std::filesystem::path& folder, const std::string& payload) {
  if (!is_stored(payload)) return payload;
  const StoredWork work = unpack_stored_work(payload);
  return archive::read_piece(folder / payload_file(work.file), {work.offset, work.bytes, work.checksum});
}

void PayloadStore::open(const core::Communicator& comm) {
  core::on_root(comm.get(), [&] { _number = first_free(_folder); });
  _number = core::agreed(comm.get(), _number) + comm.rank();
  _file.reset();
  if (_number < StoredWork::most_files) _file.emplace(_folder / payload_file(_number));
}

void PayloadStore::keep(queue::Task& task) {
  if (task.payload.size() >= least_stored) keep(task.payload, told_of(task));
}

void PayloadStore::keep(std::string& bytes, const std::string& told) {
  if (!_file || bytes.size() < least_stored || is_stored(bytes)) return;
  try {
    const archive::Piece piece = _file->append(bytes);
    core::pause_point("store a payload");
    bytes = pack(StoredWork{_number, piece.offset, piece.bytes, piece.checksum, told});
  } catch (const core::EnvironmentError& error) {  // a flush, which cannot write either, says so; else nothing is lost
    if (!_has_warned) core::log_warning(fmt::format("a payload stays in memory: {}", error.what()));
    _has_warned = true;
  }
}

std::string PayloadStore::whole(const queue::Task& task) {
  try {
    return whole_payload(_folder, task.payload);
  } catch (const core::InputError& error) {
    _fault = fmt::format("task \"{}\": {}", task.key, error.what());
    throw;
  }
}

void PayloadStore::sync() {
  if (!_fault.empty()) throw core::EnvironmentError(_fault);
  if (!_file) return;
  core::pause_point("sync payloads");
  _file->sync();
}

}  // namespace orbweaver::survey
