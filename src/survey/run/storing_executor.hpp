#pragma once

#include <utility>

#include "orbweaver/queue/executor.hpp"
#include "state/payload_store.hpp"

namespace orbweaver::survey {

/// Does tasks whose payloads lie in the store, and puts there those of the tasks that come of them.
class StoringExecutor final : public queue::Executor {
 public:
  StoringExecutor(PayloadStore& store, queue::Executor& inner) : _store(store), _inner(inner) {}

  queue::TaskOutcome execute(const queue::Task& task, queue::TaskContext& context) override {
    queue::Task whole = task;
    whole.payload = _store.whole(task);
    queue::TaskOutcome outcome = _inner.execute(whole, context);
    for (queue::Task& child : outcome.children) _store.keep(child);
    return outcome;
  }
  void take_back_rows(bool flushed) override { _inner.take_back_rows(flushed); }

 private:
  PayloadStore& _store;
  queue::Executor& _inner;
};

}  // namespace orbweaver::survey
