#pragma once

#include "orbweaver/continuation/branch.hpp"
#include "orbweaver/corrector/correct.hpp"
#include "orbweaver/loss/unknowns.hpp"

namespace orbweaver::continuation {

/// One predicted and corrected orbit.
struct Attempt {
  corrector::Result result;
  loop::Tangent tangent;  ///< unit flat direction at the result, on the side of the one it was predicted along
  double turning = 0.0;   ///< angle between the two, radians
};

/// The conditions under which `guess` is corrected: the step orthogonal to `normal`, and orthogonal to the time shift where
/// the subspace contains it (the phase condition of loops without a reversor; paper, section II B). One a column.
[[nodiscard]] Eigen::MatrixXd conditions_at(const loop::Loop& guess, const loss::Unknowns& unknowns,
                                            const Eigen::VectorXd& normal);

/// Predicts base + length * direction / |direction| and corrects it with the step held orthogonal to the direction, in
/// the subspace of `isotropy` (paper, section III B).
[[nodiscard]] Attempt correct_along(const systems::System& system, const loop::Loop& base,
                                    const loop::Tangent& direction, double length, const loop::Isotropy& isotropy,
                                    const corrector::Options& options);

/// What the last harmonics of a loop may weigh.
[[nodiscard]] double tail_limit(const loop::Loop& loop, const Options& options);

/// True where a correction shows that the cutoff is too low for this orbit.
[[nodiscard]] bool needs_more_harmonics(const corrector::Result& result, const Options& options);

}  // namespace orbweaver::continuation
