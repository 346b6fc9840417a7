#include "certify_orbits.hpp"

#include <algorithm>
#include <span>

#include <fmt/format.h>

#include "orbweaver/archive/schema/schema.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/core/mpi/collective.hpp"
#include "orbweaver/queue/run_for_outcomes.hpp"
#include "tasks/certified.hpp"
#include "tasks/payload/payload.hpp"
#include "verify/verified_atlas.hpp"

namespace orbweaver::survey {

namespace {

/// Rows a task, of one family: some tens of milliseconds.
constexpr std::size_t orbits_a_task = 16;

struct CertifyWork {
  static constexpr const char* payload_name = "orbits to certify";
  std::int64_t first = 0;
  std::int64_t end = 0;

  static constexpr int wire_version = 1;
  template <class Archive>
  void serialize(Archive& archive, unsigned /*version*/) {
    core::serialize_members(archive, first, end);
  }
};

struct CertifiedRows {
  static constexpr const char* payload_name = "certificates";
  std::vector<archive::CertificateRecord> rows;

  static constexpr int wire_version = 1;
  template <class Archive>
  void serialize(Archive& archive, unsigned /*version*/) {
    core::serialize_members(archive, rows);
  }
};

class CertifyExecutor final : public queue::Executor {
 public:
  explicit CertifyExecutor(std::filesystem::path atlas) : _path(std::move(atlas)) {}

  queue::TaskOutcome execute(const queue::Task& task, queue::TaskContext& /*context*/) override {
    const auto work = from_payload<CertifyWork>(task.payload);
    if (!_atlas) _atlas.emplace(_path);
    const archive::Table& orbits = _atlas->archive().orbits();
    const auto family = static_cast<std::size_t>(orbits.integers("family")[static_cast<std::size_t>(work.first)]);
    certificate::Options options;
    options.level = certificate_level(_atlas->scene());
    certificate::Certifier certifier(*_atlas->system(), _atlas->isotropy(family), options);
    CertifiedRows done;
    for (std::int64_t at = work.first; at < work.end; ++at) {
      const auto row = static_cast<std::size_t>(at);
      const loop::Loop loop = _atlas->loop(row);
      const certificate::Evidence evidence = stored_evidence(*_atlas, row, loop);
      done.rows.push_back(record_of(certifier(loop, evidence.growth), evidence));
    }
    queue::TaskOutcome outcome;
    outcome.payload = to_payload(done);
    return outcome;
  }

 private:
  std::filesystem::path _path;
  std::optional<VerifiedAtlas> _atlas;
};

/// In the order of their keys.
std::vector<queue::Task> tasks_of(const archive::Archive& atlas) {
  std::vector<queue::Task> tasks;
  for (std::size_t family = 0; family < atlas.families().rows(); ++family) {
    const auto first = static_cast<std::size_t>(atlas.families().integers("first_orbit")[family]);
    const std::size_t end = first + static_cast<std::size_t>(atlas.families().integers("orbit_count")[family]);
    for (std::size_t row = first; row < end; row += orbits_a_task)
      tasks.push_back({fmt::format("certify {:012}", row), 0, "certify",
                       to_payload(CertifyWork{static_cast<std::int64_t>(row),
                                              static_cast<std::int64_t>(std::min(row + orbits_a_task, end))})});
  }
  return tasks;
}

}  // namespace

std::optional<std::vector<archive::CertificateRecord>> certificates_of(const core::Communicator& comm,
                                                                       const std::filesystem::path& atlas) {
  std::vector<queue::Task> tasks;
  core::on_root(comm.get(), [&] { tasks = tasks_of(archive::Archive(atlas)); });
  CertifyExecutor executor(core::agreed(comm.get(), atlas.string()));
  const auto outcomes = queue::run_for_outcomes(comm, std::move(tasks), executor);
  if (!outcomes) return std::nullopt;
  std::vector<archive::CertificateRecord> rows;
  core::on_root(comm.get(), [&] {
    for (const queue::TaskOutcome& outcome : *outcomes) {
      if (outcome.failed) throw core::NumericalError("certificates: " + outcome.reason);
      const auto done = from_payload<CertifiedRows>(outcome.payload);
      rows.insert(rows.end(), done.rows.begin(), done.rows.end());
    }
  });
  return rows;
}

}  // namespace orbweaver::survey
