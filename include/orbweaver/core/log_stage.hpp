#pragma once

#include <petscsys.h>

namespace orbweaver::core {

/// What `-log_view` tells apart as stages: the work of a layer, without what it hands to another (stages nest, and PETSc
/// counts each second in the innermost one, so that the stages and "Main Stage" add up to the whole).
enum class Stage { sweep, continuation, corrector, spectrum, certificate, archive, queue_wait };

/// What it tells apart as events, in whichever stage they happen. Events include events begun within them.
enum class Event { residual, jacobian, field, assembly, factor, precondition, multipliers };

/// Registers all stages and events with PETSc, in one order on every rank, if PETSc logs at all; without `-log_view` the
/// objects below do nothing. Called by Session once PETSc runs; `forget_log_stages` when it is about to end.
void register_log_stages();
void forget_log_stages() noexcept;

namespace detail {
inline constexpr int stages = 7;
inline constexpr int events = 7;
/// PETSc's numbers, -1 while nothing is logged.
struct LogIds {
  PetscLogStage stage[stages];
  PetscLogEvent event[events];
};
extern LogIds log_ids;
void push_stage(PetscLogStage id) noexcept;
void pop_stage() noexcept;
void begin_event(PetscLogEvent id) noexcept;
void end_event(PetscLogEvent id) noexcept;
}  // namespace detail

/// From here to the end of the scope (by whatever way it is left) time counts for a stage. Costs a comparison if nothing
/// is logged.
class LogStage {
 public:
  explicit LogStage(Stage stage) noexcept : _id(detail::log_ids.stage[static_cast<int>(stage)]) {
    if (_id >= 0) detail::push_stage(_id);
  }
  ~LogStage() {
    if (_id >= 0) detail::pop_stage();
  }
  LogStage(const LogStage&) = delete;
  LogStage& operator=(const LogStage&) = delete;

 private:
  PetscLogStage _id;
};

/// The same for an event.
class LogEvent {
 public:
  explicit LogEvent(Event event) noexcept : _id(detail::log_ids.event[static_cast<int>(event)]) {
    if (_id >= 0) detail::begin_event(_id);
  }
  ~LogEvent() {
    if (_id >= 0) detail::end_event(_id);
  }
  LogEvent(const LogEvent&) = delete;
  LogEvent& operator=(const LogEvent&) = delete;

 private:
  PetscLogEvent _id;
};

}  // namespace orbweaver::core
