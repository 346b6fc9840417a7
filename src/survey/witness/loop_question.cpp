#include "loop_question.hpp"

#include <fmt/format.h>

#include "tasks/payload/payload.hpp"
#include "witness/tolerance.hpp"

namespace orbweaver::survey {

queue::Task task_of(const LoopQuestion& question, std::size_t number) {
  return {fmt::format("compare {:08}", number), 0, "compare", to_payload(question)};
}

LoopReply reply_in(const queue::TaskOutcome& outcome) {
  return outcome.failed || outcome.payload.empty() ? LoopReply{} : from_payload<LoopReply>(outcome.payload);
}

const AtlasTree& LoopExecutor::tree() {
  if (!_atlas) _atlas.emplace(_path);
  if (!_tree) _tree.emplace(*_atlas, witness_tolerance);
  return *_tree;
}

queue::TaskOutcome LoopExecutor::execute(const queue::Task& task, queue::TaskContext& /*context*/) {
  const auto question = from_payload<LoopQuestion>(task.payload);
  const AtlasTree& atlas = tree();
  const TreeFamily& family = atlas.families.at(static_cast<std::size_t>(question.family));
  const TreeFamily& beside = atlas.families.at(static_cast<std::size_t>(question.beside));
  const auto segment = static_cast<std::size_t>(question.segment);
  LoopAnswer answer;
  if (question.crossing >= 0) {
    answer = _loops.ask_crossing(atlas, static_cast<std::size_t>(question.crossing), beside, segment);
  } else {
    const OrbitBeside orbit{atlas, family, static_cast<std::size_t>(question.orbit), atlas, beside, segment};
    answer = _loops.ask(orbit);
    if (answer.same && !_loops.is_on_curve(orbit)) answer.same = answer.decided = false;
  }
  queue::TaskOutcome done;
  done.payload = to_payload(LoopReply{answer.same, answer.decided, answer.distance});
  return done;
}

}  // namespace orbweaver::survey
