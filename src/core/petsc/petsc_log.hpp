#pragma once

namespace orbweaver::core {

/// Registers all stages and events with PETSc, in one order on every rank, if PETSc logs at all; without `-log_view`
/// LogStage and LogEvent do nothing. Called by Session once PETSc runs; `forget_log_stages` when it is about to end.
void register_log_stages();
void forget_log_stages() noexcept;

}  // namespace orbweaver::core
