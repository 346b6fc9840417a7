#pragma once

namespace orbweaver::core {

/// What `-log_view` tells apart as stages: the work of a layer, without what it hands to another (stages nest, and
/// PETSc counts each second in the innermost one, so that the stages and "Main Stage" add up to the whole). Session
/// registers them.
enum class Stage { sweep, continuation, corrector, spectrum, certificate, archive, queue_wait };

/// What it tells apart as events, in whichever stage they happen. Events include events begun within them.
enum class Event { residual, jacobian, field, assembly, factor, precondition, multipliers, validation };

namespace detail {
inline constexpr int stages = 7;
inline constexpr int events = 8;
/// Who keeps the times (PETSc, while a Session lives that logs), and the numbers of stages and events there.
/// Numbers are -1, and nothing is called, while nobody does.
struct Log {
  int stage[stages];
  int event[events];
  void (*push_stage)(int) noexcept;
  void (*pop_stage)() noexcept;
  void (*begin_event)(int) noexcept;
  void (*end_event)(int) noexcept;
};
extern const Log no_log;
extern Log log;
}  // namespace detail

/// From here to the end of the scope (by whatever way it is left) time counts for a stage. Costs a comparison if
/// nothing is logged.
class LogStage {
 public:
  explicit LogStage(Stage stage) noexcept : _id(detail::log.stage[static_cast<int>(stage)]) {
    if (_id >= 0) detail::log.push_stage(_id);
  }
  ~LogStage() {
    if (_id >= 0) detail::log.pop_stage();
  }
  LogStage(const LogStage&) = delete;
  LogStage& operator=(const LogStage&) = delete;

 private:
  int _id;
};

/// The same for an event.
class LogEvent {
 public:
  explicit LogEvent(Event event) noexcept : _id(detail::log.event[static_cast<int>(event)]) {
    if (_id >= 0) detail::log.begin_event(_id);
  }
  ~LogEvent() {
    if (_id >= 0) detail::log.end_event(_id);
  }
  LogEvent(const LogEvent&) = delete;
  LogEvent& operator=(const LogEvent&) = delete;

 private:
  int _id;
};

}  // namespace orbweaver::core
