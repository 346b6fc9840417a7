#pragma once

#include "witness/check.hpp"

namespace orbweaver::survey {

/// Tasks that failed, that rounding leaves undecided, or that were not done, and arrivals that contradict each other.
class FailedTasks final : public Check {
 public:
  [[nodiscard]] std::vector<Finding> findings(const Evidence& evidence,
                                              std::span<const Answered> /*answered*/) const override {
    std::vector<Finding> found;
    const auto add = [&](FindingKind kind, Severity severity, const std::string& family, const std::string& detail) {
      Finding& finding = found.emplace_back();
      finding.kind = kind;
      finding.severity = severity;
      finding.family = evidence.row_of(family);
      finding.detail = detail;
    };
    for (const std::string& failure : evidence.known.failures)
      add(FindingKind::failed_task, Severity::failure, "", failure);
    for (const auto* failures : {&evidence.known.tree.failures, &evidence.known.tree.failed_loci})
      for (const FailureEvidence& failure : *failures)
        add(FindingKind::failed_task, Severity::failure, failure.family, failure.reason);
    for (const FailureEvidence& event : evidence.known.tree.undecided)
      add(FindingKind::undecided_event, Severity::undecided, event.family, event.reason);
    for (const std::string& family : evidence.known.tree.disputed)
      add(FindingKind::disputed_arrival, Severity::contradiction, family, "");
    for (const std::string& task : evidence.known.interrupted) add(FindingKind::interrupted, Severity::cut, "", task);
    return found;
  }
};

}  // namespace orbweaver::survey
