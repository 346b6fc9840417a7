#include "verify/verify_task.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "orbweaver/core/error.hpp"
#include "orbweaver/loop/curve/measures.hpp"
#include "tasks/payload/payload.hpp"
#include "tasks/section_rows.hpp"
#include "verify/crossing_check.hpp"
#include "verify/equilibrium_check.hpp"
#include "verify/locus_check.hpp"
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
  const char* table = work.what == VerifyWork::What::crossings    ? "crossings"
                      : work.what == VerifyWork::What::loci       ? "loci"
                      : work.what == VerifyWork::What::equilibria ? "equilibria"
                                                                  : "orbits";
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
    case VerifyWork::What::loci:
      for (std::int64_t row = work.first; row < work.end; ++row)
        check_locus_point(atlas(), static_cast<std::size_t>(row), findings);
      break;
    case VerifyWork::What::equilibria:
      for (std::int64_t row = work.first; row < work.end; ++row)
        check_equilibrium(atlas(), static_cast<std::size_t>(row), findings);
      break;
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

/// What the section has of orbits [first, end).
void VerifyExecutor::check_sections(const VerifyWork& work, Findings& findings) {
  const archive::Table& table = atlas().archive().sections();
  const std::vector<std::int64_t>& orbits = table.integers("orbit");
  const systems::System& system = *atlas().system();
  const std::size_t d = atlas().archive().header().state_names.size();
  const scene::Section section = atlas().section();
  for (std::int64_t orbit = work.first; orbit < work.end; ++orbit) {
    const auto [begin, end] = std::equal_range(orbits.begin(), orbits.end(), orbit);
    const loop::Loop loop = atlas().loop(static_cast<std::size_t>(orbit));
    const std::vector<double> times = section_times(section, system, loop);
    Claims(findings, "orbits", orbit)
        .expect(static_cast<std::size_t>(end - begin) == times.size(), "sections",
                fmt::format("has {} rows of this orbit, which passes {} = {:.9g} {} times", end - begin,
                            section.coordinate, atlas().scene().section.value, times.size()));
    const double size = loop::rms_size(loop);
    for (auto row = static_cast<std::size_t>(begin - orbits.begin());
         row < static_cast<std::size_t>(end - orbits.begin()); ++row) {
      Claims claims(findings, "sections", static_cast<std::int64_t>(row));
      const std::vector<double> state = loop::state_at(loop, table.reals("time")[row] / system.scales().time);
      claims.below("time", section_distance(section, system, state), same_point * (1.0 + size),
                   "the distance from the section at that time");
      for (std::size_t i = 0; i < d; ++i) {
        const double unit = system.scales().coordinate(i);
        claims.agree("state", table.reals("state")[row * d + i], state[i] * unit,
                     same_point * (unit + std::abs(state[i] * unit)));
      }
    }
  }
}

}  // namespace orbweaver::survey
