#include "verify/verify_task.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "orbweaver/core/error.hpp"
#include "tasks/payload/payload.hpp"
#include "verify/crossing_check.hpp"
#include "verify/orbit_check.hpp"

namespace orbweaver::survey {

namespace {

/// Of the largest coordinate of a section point, in the loop's units.
constexpr double same_point = 1e-12;

}  // namespace

queue::Task task_of(const VerifyWork& work) {
  return {fmt::format("verify {} {:012}", static_cast<int>(work.what), work.first), 0, "verify", to_payload(work)};
}

Findings findings_in(const queue::Task& task, const queue::TaskOutcome& outcome) {
  if (!outcome.failed && !outcome.payload.empty()) return from_payload<Findings>(outcome.payload);
  const auto work = from_payload<VerifyWork>(task.payload);
  Findings findings;
  const char* table = work.what == VerifyWork::What::crossings ? "crossings" : "orbits";
  findings.objections.push_back(
      {table, work.first, "",
       fmt::format("could not be verified (rows {} to {}): {}", work.first, work.end - 1, outcome.reason)});
  return findings;
}

const VerifiedAtlas& VerifyExecutor::atlas() {
  if (!_atlas) _atlas.emplace(_path);
  return *_atlas;
}

queue::TaskOutcome VerifyExecutor::execute(const queue::Task& task, queue::TaskContext& /*context*/) {
  const auto work = from_payload<VerifyWork>(task.payload);
  Findings findings;
  switch (work.what) {
    case VerifyWork::What::checksums: check_checksums(work, findings); break;
    case VerifyWork::What::orbits:
      check_orbits(atlas(), static_cast<std::size_t>(work.first), static_cast<std::size_t>(work.end), findings);
      break;
    case VerifyWork::What::crossings:
      for (std::int64_t row = work.first; row < work.end; ++row)
        check_crossing(atlas(), static_cast<std::size_t>(row), findings);
      break;
    case VerifyWork::What::sections: check_sections(work, findings); break;
  }
  queue::TaskOutcome done;
  done.payload = to_payload(findings);
  return done;
}

void VerifyExecutor::check_checksums(const VerifyWork& work, Findings& findings) {
  if (!_changed) _changed.emplace(_path, archive::ChangedRows::listed);
  std::vector<std::int64_t> known;
  for (const archive::ChangedRow& row : _changed->changed_rows())
    if (row.table == "orbits") known.push_back(static_cast<std::int64_t>(row.row));
  for (std::int64_t row = work.first; row < work.end; ++row) {
    if (std::find(known.begin(), known.end(), row) != known.end()) continue;  // its ranges may be changed too
    for (const archive::ChangedRow& changed : _changed->changed_loop(static_cast<std::size_t>(row)))
      findings.objections.push_back({changed.table, row, "modes", changed.text});
  }
}

void VerifyExecutor::check_sections(const VerifyWork& work, Findings& findings) {
  const archive::Table& table = atlas().archive().sections();
  const std::size_t d = atlas().archive().header().state_names.size();
  for (std::int64_t at = work.first; at < work.end; ++at) {
    const auto row = static_cast<std::size_t>(at);
    Claims claims(findings, "sections", at);
    const loop::Loop loop = atlas().loop(static_cast<std::size_t>(table.integers("orbit")[row]));
    const std::vector<double> state = loop::state_at(loop, table.reals("time")[row] / atlas().system()->scales().time);
    for (std::size_t i = 0; i < d; ++i) {
      const double unit = atlas().system()->scales().coordinate(i);
      claims.agree("state", table.reals("state")[row * d + i], state[i] * unit,
                   same_point * (unit + std::abs(state[i] * unit)));
    }
  }
}

}  // namespace orbweaver::survey
