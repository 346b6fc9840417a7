#pragma once

#include <span>
#include <vector>

#include "evidence.hpp"
#include "loop_question.hpp"
#include "orbweaver/survey/witness/finding.hpp"

namespace orbweaver::survey {

/// One thing that a survey's tables must agree about. Each check is a header beside this one, named in checks.cpp.
class Check {
 public:
  Check() = default;
  Check(const Check&) = delete;
  Check& operator=(const Check&) = delete;
  Check(Check&&) = delete;
  Check& operator=(Check&&) = delete;
  virtual ~Check() = default;

  /// Where numbers do not decide: loops to be compared, by whatever rank is free. Asked for again until there are none,
  /// with the answers to the last ones.
  [[nodiscard]] virtual std::vector<LoopQuestion> questions(const Evidence& /*evidence*/,
                                                            std::span<const Answered> /*last*/) {
    return {};
  }
  /// What does not add up. `answered`: all questions, in their order. Pure.
  [[nodiscard]] virtual std::vector<Finding> findings(const Evidence& evidence,
                                                      std::span<const Answered> answered) const = 0;
};

}  // namespace orbweaver::survey
