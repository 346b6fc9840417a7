#pragma once

namespace orbweaver::survey {

/// Relative deviation of period, energy and action of one orbit that was computed twice: as report::CompareOptions.
inline constexpr double witness_tolerance = 1e-9;

}  // namespace orbweaver::survey
