#pragma once

namespace orbweaver::continuation {

/// The step to try next after an accepted one: longer where the corrector needed few iterations and the tangent hardly
/// turned, shorter where either was expensive; by a factor between 0.4 and 2. A pure function, reads no clock.
[[nodiscard]] double next_step_length(double length, int iterations, double turning, double wanted_turning);

}  // namespace orbweaver::continuation
