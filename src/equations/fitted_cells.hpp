#pragma once

#include <vector>

namespace orbweaver::equations {

/// The Jacobians B_j of a box scheme w (y_(j+1) - y_j) - (B_j / 2) (y_j + y_(j+1)) such that its solutions where A is
/// constant are those of y' = A y: 2 w tanh(B_j / 2 w) instead of B_j, in cells over which the linearised flow turns or
/// grows by more than the plain scheme follows. Empty where no cell does.
///
/// The plain scheme has a fast oscillation at a frequency of its own, and where the orbit is near a resonance with it
/// the preconditioner is wrong in sign. (Exponential fitting: Liniger and Willoughby 1970, doi:10.1137/0707002.)
/// `blocks`: entry (i, l) of cell j at [(i * dimension + l) * count + j].
[[nodiscard]] std::vector<double> fitted_cells(const double* blocks, int dimension, int count, double difference);

}  // namespace orbweaver::equations
