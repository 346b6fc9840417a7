#pragma once

#include <map>

#include "orbweaver/certificate/verdict.hpp"
#include "witness/check.hpp"

namespace orbweaver::survey {

/// Orbits that their certificates contradict, or of which they say nothing: once a family and verdict.
class Certificates final : public Check {
 public:
  [[nodiscard]] std::vector<Finding> findings(const Evidence& evidence,
                                              std::span<const Answered> /*answered*/) const override {
    using certificate::Verdict;
    std::vector<Finding> found;
    const archive::Table& orbits = evidence.tree.atlas.orbits();
    for (std::size_t row = 0; row < evidence.tree.families.size(); ++row) {
      const TreeFamily& family = evidence.tree.families[row];
      std::map<std::int64_t, Finding> by_verdict;
      for (std::size_t orbit = family.first_orbit; orbit < family.first_orbit + family.orbits(); ++orbit) {
        const std::int64_t verdict = orbits.integers("verdict")[orbit];
        if (verdict <= static_cast<std::int64_t>(Verdict::holds) ||
            verdict > static_cast<std::int64_t>(last_of(Verdict{})))
          continue;
        Finding& finding = by_verdict[verdict];
        if (finding.number++ > 0) continue;
        const auto is = static_cast<Verdict>(verdict);
        finding.kind = is_failure(is) ? FindingKind::failed_certificate : FindingKind::silent_certificate;
        finding.severity = is_failure(is) ? Severity::contradiction : Severity::undecided;
        finding.family = static_cast<int>(row);
        finding.period = orbits.reals("period")[orbit];
        finding.level = orbits.reals(evidence.tree.in_parameter() ? "parameter" : "energy")[orbit];
        finding.other_number = static_cast<int>(family.orbits());
        finding.detail = name_of(is);
      }
      for (const auto& [verdict, finding] : by_verdict) found.push_back(finding);
    }
    return found;
  }
};

}  // namespace orbweaver::survey
