#include "orbweaver/core/log_stage.hpp"

#include <algorithm>
#include <iterator>

#include <petsclog.h>

#include "orbweaver/core/check.hpp"

namespace orbweaver::core {

namespace {

constexpr detail::LogIds nothing = [] {
  detail::LogIds ids{};
  std::fill(std::begin(ids.stage), std::end(ids.stage), -1);
  std::fill(std::begin(ids.event), std::end(ids.event), -1);
  return ids;
}();

// In the order of the enums. PETSc's table has 16 columns for the name of an event.
constexpr const char* stage_names[] = {"Sweep",       "Continuation", "Corrector", "Spectrum",
                                       "Certificate", "Archive",      "Queue wait"};
constexpr const char* event_names[] = {"LoopResidual", "LoopJacobian",    "FieldEvaluation", "LoopAssembly",
                                       "BoxFactor",    "BoxPrecondition", "Multipliers"};
static_assert(std::size(stage_names) == detail::stages && std::size(event_names) == detail::events);

}  // namespace

namespace detail {

LogIds log_ids = nothing;

// Logging is no reason to fail: PETSc's errors are left aside.
void push_stage(PetscLogStage id) noexcept { static_cast<void>(PetscLogStagePush(id)); }
void pop_stage() noexcept { static_cast<void>(PetscLogStagePop()); }
void begin_event(PetscLogEvent id) noexcept { static_cast<void>(PetscLogEventBegin(id, 0, 0, 0, 0)); }
void end_event(PetscLogEvent id) noexcept { static_cast<void>(PetscLogEventEnd(id, 0, 0, 0, 0)); }

}  // namespace detail

void register_log_stages() {
  PetscBool active = PETSC_FALSE;
  check(PetscLogIsActive(&active), "PetscLogIsActive");
  if (active == PETSC_FALSE) return;
  detail::LogIds ids = nothing;
  PetscClassId orbweaver = 0;
  check(PetscClassIdRegister("Orbweaver", &orbweaver), "PetscClassIdRegister");
  for (int n = 0; n < detail::stages; ++n) {
    check(PetscLogStageRegister(stage_names[n], &ids.stage[n]), "PetscLogStageRegister");
    // PETSc prints the name of a stage only if rank 0 has entered it, and under mpirun rank 0 does no task.
    check(PetscLogStagePush(ids.stage[n]), "PetscLogStagePush");
    check(PetscLogStagePop(), "PetscLogStagePop");
  }
  for (int n = 0; n < detail::events; ++n)
    check(PetscLogEventRegister(event_names[n], orbweaver, &ids.event[n]), "PetscLogEventRegister");
  detail::log_ids = ids;
}

void forget_log_stages() noexcept { detail::log_ids = nothing; }

}  // namespace orbweaver::core
