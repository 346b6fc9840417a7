#pragma once

namespace orbweaver::continuation {

/// The step to try next after an accepted one of `length`, whose prediction of degree `order` was wrong by `error`:
/// such that the next one is wrong by `wanted`, by a factor between 0.3 and 1.6. A pure function, reads no clock.
[[nodiscard]] double next_step_length(double length, double error, double wanted, int order);

/// How often that step has to be halved for its pieces to be as long as one that is wrong by `wanted`, to the nearest
/// power of 2 and three times at most.
[[nodiscard]] int halvings_of_step(double error, double wanted, int order);

}  // namespace orbweaver::continuation
