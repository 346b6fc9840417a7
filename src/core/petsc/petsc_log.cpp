#include "petsc_log.hpp"

#include <iterator>

#include <petsclog.h>

#include "orbweaver/core/log/log_stage.hpp"
#include "orbweaver/core/petsc/check.hpp"

namespace orbweaver::core {

namespace {

// In the order of the enums. PETSc's table has 16 columns for the name of an event.
constexpr const char* stage_names[] = {"Sweep",       "Continuation", "Corrector", "Spectrum",
                                       "Certificate", "Archive",      "Queue wait"};
constexpr const char* event_names[] = {"LoopResidual", "LoopJacobian",    "FieldEvaluation", "LoopAssembly",
                                       "BoxFactor",    "BoxPrecondition", "Multipliers",     "StepValidation"};
static_assert(std::size(stage_names) == detail::stages && std::size(event_names) == detail::events);

// Logging is no reason to fail: PETSc's errors are left aside.
void push_stage(int id) noexcept { static_cast<void>(PetscLogStagePush(id)); }
void pop_stage() noexcept { static_cast<void>(PetscLogStagePop()); }
void begin_event(int id) noexcept { static_cast<void>(PetscLogEventBegin(id, 0, 0, 0, 0)); }
void end_event(int id) noexcept { static_cast<void>(PetscLogEventEnd(id, 0, 0, 0, 0)); }

}  // namespace

void register_log_stages() {
  PetscBool active = PETSC_FALSE;
  check(PetscLogIsActive(&active), "PetscLogIsActive");
  if (active == PETSC_FALSE) return;
  detail::Log log = detail::no_log;
  log.push_stage = push_stage;
  log.pop_stage = pop_stage;
  log.begin_event = begin_event;
  log.end_event = end_event;
  PetscClassId orbweaver = 0;
  check(PetscClassIdRegister("Orbweaver", &orbweaver), "PetscClassIdRegister");
  for (int n = 0; n < detail::stages; ++n) {
    check(PetscLogStageRegister(stage_names[n], &log.stage[n]), "PetscLogStageRegister");
    // PETSc prints the name of a stage only if rank 0 has entered it, and under mpirun rank 0 does no task.
    check(PetscLogStagePush(log.stage[n]), "PetscLogStagePush");
    check(PetscLogStagePop(), "PetscLogStagePop");
  }
  for (int n = 0; n < detail::events; ++n)
    check(PetscLogEventRegister(event_names[n], orbweaver, &log.event[n]), "PetscLogEventRegister");
  detail::log = log;
}

void forget_log_stages() noexcept { detail::log = detail::no_log; }

}  // namespace orbweaver::core
