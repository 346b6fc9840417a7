#pragma once

#include <string>
#include <vector>

#include "orbweaver/scene/scene.hpp"
#include "orbweaver/starts/sweep.hpp"

namespace orbweaver::report {

/// A normal mode with how well a step along it closes (paper, Table I): after a step of 0.5 degrees, in degrees; in a
/// system without angles after one of 0.01, in the units of the coordinate with the largest scale.
struct ModeRow {
  std::string name;
  double period = 0.0;          ///< refined
  double grid_period = 0.0;     ///< of the sweep's grid, as in the paper
  double deviation = 0.0;       ///< |Phi_T(z) - z| after the step, refined period and direction
  double grid_deviation = 0.0;  ///< the same with the period and eigenvector of the grid
  std::string isotropy;
};

/// A mode outside the range of periods.
struct LeftOutRow {
  std::string name;
  double period = 0.0;
};

/// The sweep at one equilibrium. Periods are in the units of the scene, eigenvalues of the Hessian and deviations
/// without angles in the survey's scales.
struct EquilibriumReport {
  std::vector<double> point;
  std::string text;     ///< "th1 = 0 deg, ..."
  bool angles = false;  ///< deviations are in degrees
  starts::SweepResult sweep;
  /// The same table over loops that are opposite to themselves half a period later: no oscillation goes around twice.
  std::vector<starts::SweepPoint> odd;
  std::vector<ModeRow> modes;
  std::vector<LeftOutRow> left_out;
};

/// Finds the scene's equilibria and sweeps the period at each; not collective. Throws as find_fixed_points and sweep
/// do.
[[nodiscard]] std::vector<EquilibriumReport> sweep_report(const scene::Scene& scene);

/// The modes, those left out, dips passed over, equilibria without oscillations and the stability of each, for people.
[[nodiscard]] std::string to_text(const std::vector<EquilibriumReport>& reports);

/// Smallest eigenvalue against period as text with aligned columns (one column an equilibrium), or as CSV with full
/// precision. Where ranges differ, as automatic ones do, each equilibrium has a column of its own periods.
[[nodiscard]] std::string eigenvalue_table(const std::vector<EquilibriumReport>& reports);
[[nodiscard]] std::string eigenvalue_csv(const std::vector<EquilibriumReport>& reports);

}  // namespace orbweaver::report
