#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "orbweaver/archive/read/reader.hpp"
#include "orbweaver/survey/atlas/invariant_curve.hpp"
#include "orbweaver/survey/tree/family_end.hpp"

namespace orbweaver::survey {

/// One end of a family: where it stopped and why.
struct FamilyEnd {
  std::size_t orbit = 0;  ///< of the family's orbits, the last on this side
  EndKind kind = survey::EndKind::unknown;
};

struct TreeFamily {
  std::string name;
  int parent = -1;
  int crossing = -1;
  int multiplicity = 1;
  std::string isotropy;
  int end_family = -1;
  int end_crossing = -1;
  std::size_t first_orbit = 0;
  std::vector<double> arclengths;
  double birth_arclength = archive::not_computed;  ///< of `crossing`, on the family
  InvariantCurve curve;
  std::vector<FamilyEnd> ends;  ///< one, or two: forwards, backwards
  std::vector<int> crossings;   ///< rows of those that lie on it

  [[nodiscard]] std::size_t orbits() const { return arclengths.size(); }
};

struct TreeCrossing {
  std::string kind;
  int family = -1;
  int multiplicity = 1;
  int kernel_dimension = 0;
  int sector_j = 0;
  int sector_q = 1;
  int fundamental_order = 1;
  double period = 0.0;
  double level = 0.0;        ///< the energy, or the parameter that moves
  double level_scale = 0.0;  ///< of the family's orbit nearest to it; NaN: neither
  /// How far it may lie from its place, in what the place is told by; 0 where an older archive does not say.
  double place_error = 0.0;  ///< in arclength
  double place_error_period = 0.0;
  double place_error_level = 0.0;
  std::string parameter;      ///< that moves; empty: none does
  std::vector<int> children;  ///< rows of the families born there
};

/// An atlas as a tree. Rows are those of the archive.
struct AtlasTree {
  AtlasTree(const archive::Archive& atlas, double tolerance);

  const archive::Archive& atlas;
  std::vector<TreeFamily> families;
  std::vector<TreeCrossing> crossings;
  std::vector<int> roots;  ///< families without a parent
  std::string parameter;   ///< that moves along the families; empty: none does

  [[nodiscard]] bool in_parameter() const { return !parameter.empty(); }
  /// Of the family's orbits, the one of the first step.
  [[nodiscard]] std::size_t first_step_of(const TreeFamily& family) const;
};

/// How far two places of crossings are apart, relative in period and level.
[[nodiscard]] double apart(const TreeCrossing& x, const TreeCrossing& y);
/// The same beyond what the errors of both explain.
[[nodiscard]] double apart_beyond_errors(const TreeCrossing& x, const TreeCrossing& y);

/// "period-doubling T 8.44293", "fold-parameter T 5.23599, drive_amplitude 0.4"
[[nodiscard]] std::string place_text(const TreeCrossing& crossing);

}  // namespace orbweaver::survey
