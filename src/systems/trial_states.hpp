#pragma once

namespace orbweaver::systems {

/// Sizes of the states at which a field is asked for what it keeps: a model's units may be far from its coordinates'
/// values. So many states each.
inline constexpr double trial_sizes[] = {1.0, 0x1p-10, 0x1p-20, 0x1p-30, 0x1p10};
inline constexpr int states_a_size = 8;
/// Sweeps that bring rows and columns of what is found there to the size 1.
inline constexpr int balancing_sweeps = 8;
/// Relative to terms that cancel: half the digits, as in identities.cpp, where a model's own terms cancel.
inline constexpr double half_the_digits = 1.5e-8;

}  // namespace orbweaver::systems
