#include "witness/witness.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "orbweaver/core/log/log_stage.hpp"
#include "orbweaver/core/mpi/collective.hpp"
#include "orbweaver/queue/run_for_outcomes.hpp"
#include "orbweaver/survey/tree/naming.hpp"
#include "tasks/units.hpp"
#include "witness/checks.hpp"
#include "witness/tolerance.hpp"

namespace orbweaver::survey {

namespace {

FindingNames names_of(const AtlasTree& tree, const Finding& finding, const Units& units) {
  const auto name = [&](int row) { return row < 0 ? "" : tree.families[static_cast<std::size_t>(row)].name; };
  return {name(finding.family), name(finding.other_family),
          finding.crossing < 0 ? "" : place_text(tree.crossings[static_cast<std::size_t>(finding.crossing)]),
          units.level_name()};
}

void add(const AtlasTree& tree, const Finding& finding, const Units& units, Testimony& testimony) {
  const std::string text = limited(text_of(finding, names_of(tree, finding, units)));
  testimony.records.push_back({std::string(name_of(finding.severity)), std::string(name_of(finding.kind)),
                               finding.family, finding.other_family, finding.crossing, finding.period,
                               tree.in_parameter() ? archive::not_computed : finding.level,
                               tree.in_parameter() ? finding.level : archive::not_computed, finding.deviation, text});
  testimony.summaries.push_back({finding.severity, finding.kind, text});
  if (is_wrong(finding.severity)) ++testimony.wrong;
}

/// Rank 0's part.
class Witness {
 public:
  Witness(const std::filesystem::path& atlas, const scene::Scene& scene,
          const std::shared_ptr<const systems::System>& system, WitnessInput input)
      : _atlas(atlas), _tree(_atlas, witness_tolerance), _evidence(_tree, system, scene, std::move(input)) {
    if (_evidence.known.stopped_early) return;
    for (std::size_t n = 0; n < _checks.size(); ++n) _asked[n].questions = _checks[n]->questions(_evidence, {});
  }

  /// The loops to be compared next; none: all have been.
  [[nodiscard]] std::vector<queue::Task> tasks() const {
    std::vector<queue::Task> tasks;
    for (const Asked& asked : _asked)
      for (const LoopQuestion& question : asked.questions) tasks.push_back(task_of(question, tasks.size()));
    return tasks;
  }

  /// `outcomes`: of these tasks, in their order.
  void hear(const std::vector<queue::TaskOutcome>& outcomes) {
    std::size_t next = 0;
    for (std::size_t n = 0; n < _checks.size(); ++n) {
      Asked& asked = _asked[n];
      if (asked.questions.empty()) continue;
      const std::size_t known = asked.answered.size();
      for (const LoopQuestion& question : asked.questions)
        asked.answered.push_back({question, reply_in(outcomes[next++])});
      asked.questions = _checks[n]->questions(_evidence, std::span(asked.answered).subspan(known));
    }
  }

  [[nodiscard]] Testimony testimony() const {
    std::vector<Finding> findings;
    for (std::size_t n = 0; n < _checks.size(); ++n) {
      const std::vector<Finding> found = _checks[n]->findings(_evidence, _asked[n].answered);
      findings.insert(findings.end(), found.begin(), found.end());
    }
    std::stable_sort(findings.begin(), findings.end(),
                     [](const Finding& a, const Finding& b) { return a.severity < b.severity; });
    Testimony testimony;
    for (const Finding& finding : findings) {
      add(_tree, finding, Units(*_evidence.system), testimony);
      if (finding.kind != FindingKind::failed_certificate && finding.kind != FindingKind::silent_certificate) continue;
      std::string& doubts = testimony.doubts[_evidence.key(finding.family)];
      doubts += fmt::format("{}{} of {} orbits: {}", doubts.empty() ? "" : "; ", finding.number, finding.other_number,
                            finding.detail);
    }
    return testimony;
  }

 private:
  archive::Archive _atlas;
  AtlasTree _tree;
  Evidence _evidence;
  std::vector<std::unique_ptr<Check>> _checks = all_checks();
  /// Of a check: what it asks, and all answers.
  struct Asked {
    std::vector<LoopQuestion> questions;
    std::vector<Answered> answered;
  };
  std::vector<Asked> _asked = std::vector<Asked>(_checks.size());
};

}  // namespace

std::optional<Testimony> testify(const core::Communicator& comm, const std::filesystem::path& atlas,
                                 const scene::Scene& scene, const std::shared_ptr<const systems::System>& system,
                                 WitnessInput input) {
  std::optional<Witness> witness;
  core::on_root(comm.get(), [&] { witness.emplace(atlas, scene, system, std::move(input)); });
  LoopExecutor executor(core::agreed(comm.get(), atlas.string()), system);
  for (bool has_asked = true; has_asked;) {
    std::vector<queue::Task> tasks;
    core::on_root(comm.get(), [&] { tasks = witness->tasks(); });
    has_asked = core::agreed(comm.get(), !tasks.empty());
    const auto outcomes = queue::run_for_outcomes(comm, std::move(tasks), executor);
    if (!outcomes) return std::nullopt;
    core::on_root(comm.get(), [&] { witness->hear(*outcomes); });
  }
  Testimony testimony;
  core::on_root(comm.get(), [&] { testimony = witness->testimony(); });
  testimony.wrong = core::agreed(comm.get(), testimony.wrong);
  return testimony;
}

}  // namespace orbweaver::survey
