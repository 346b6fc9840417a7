#include "stored_work.hpp"

#include <fmt/format.h>

#include "orbweaver/core/error.hpp"
#include "payload.hpp"
#include "start_work.hpp"
#include "task_kind.hpp"

namespace orbweaver::survey {

void StoredWork::check_file(int file) {
  if (file < 0 || file >= most_files)
    throw core::EnvironmentError(
        fmt::format("stored work lies in a file {}, where a number below {} was expected", file, most_files));
}

std::string pack(const StoredWork& work) { return to_payload(work); }
StoredWork unpack_stored_work(const std::string& bytes) { return from_payload<StoredWork>(bytes); }
bool is_stored(const std::string& payload) { return is_named(payload_type<StoredWork>(), payload); }

BranchWork told_branch(const queue::Task& task) {
  if (is_stored(task.payload)) return unpack_branch_work(unpack_stored_work(task.payload).told);
  return kind_of(task) == TaskKind::start ? unpack_start_work(task.payload).branch : unpack_branch_work(task.payload);
}

std::string told_of(const queue::Task& task) {
  const TaskKind kind = kind_of(task);
  if (kind != TaskKind::branch && kind != TaskKind::start) return {};
  BranchWork work = told_branch(task);
  work.base = {};
  work.direction = {};
  return pack(work);
}

}  // namespace orbweaver::survey
