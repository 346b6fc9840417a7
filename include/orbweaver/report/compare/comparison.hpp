#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "orbweaver/archive/read/reader.hpp"

namespace orbweaver::report {

struct CompareOptions {
  /// Of the period; the energy's is the same part of action/period (the mean of p . dq/dt). Where orbits lie at other
  /// places of their family, the error of the interpolation between them comes on top.
  double tolerance = 1e-9;
  int loops = 1;  ///< orbits of each family whose loops are compared as well; 0: only where all else leaves a choice
  bool strict_names = false;  ///< another name is a difference
};

enum class DifferenceKind {
  system,      ///< other equations, parameters or coordinates: nothing else is compared
  only_in_a,   ///< a family
  only_in_b,   ///< a family
  birth,       ///< the same orbits, born elsewhere
  name,        ///< with CompareOptions::strict_names
  isotropy,    ///< no symmetry of the system takes the one to the other
  orbits,      ///< orbits that lie off the other's curve of period, energy, action, stability
  range,       ///< one goes further than the other
  loop,        ///< the same numbers, other loops
  end_reason,  ///< of other kinds
  end_target,  ///< they joined different families, or at different crossings
  end_place,   ///< the limit at which both end lies elsewhere
  crossing_only_in_a,
  crossing_only_in_b,
  crossing_place,   ///< further apart than the tolerance
  crossing_kernel,  ///< dimension of the kernel, or order of the fundamental map
};

/// "crossing-place": as in the JSON form.
[[nodiscard]] std::string_view name_of(DifferenceKind kind);

struct Difference {
  DifferenceKind kind = DifferenceKind::system;
  std::string family_a;  ///< empty: not in A, or not about a family
  std::string family_b;
  std::string text;                   ///< what, and by how much
  double by = archive::not_computed;  ///< relative, where it is a number
  double allowed = archive::not_computed;
};

/// The deviation that came closest to what was allowed, or went furthest beyond it.
struct LargestDeviation {
  std::string quantity;  ///< "period of crossings"
  double value = archive::not_computed;
  double allowed = archive::not_computed;
  std::string where;
};

struct AtlasSize {
  std::string path;
  std::size_t families = 0;
  std::size_t orbits = 0;
  std::size_t crossings = 0;
};

struct Renaming {
  std::string a;
  std::string b;
};

struct Comparison {
  AtlasSize a;
  AtlasSize b;
  std::vector<std::string> notes;       ///< what differs and does not count: the scene, the program's version
  std::vector<Renaming> renamed;        ///< families with another name: letters of twins
  std::vector<Difference> differences;  ///< in the order of A's families, then what is in B only
  std::vector<LargestDeviation> largest;
  std::size_t families = 0;   ///< matched
  std::size_t crossings = 0;  ///< matched
  std::size_t orbits = 0;     ///< of both that were found on the other's curve
  std::size_t loops = 0;      ///< compared

  [[nodiscard]] bool same() const { return differences.empty(); }
};

/// Compares two atlases as trees. Families without a parent are matched by the orbits they hold, others by the crossing
/// they were born at, multiplicity and, among several, their orbits; crossings by kind, sector, multiplicity and place.
/// Orbits need not lie at the same places of a family: each is held against the curve through the other's orbits, as
/// the numbers that no symmetry changes (period, energy, action, parameter, trace of the stability) depend on one
/// another; loops are compared where that leaves a choice, and CompareOptions::loops times a family
/// (bifurcation::same_family). Names do not count. Cost: linear in the number of orbits. Needs a core::Session. Throws
/// InputError where a file cannot be read.
[[nodiscard]] Comparison compare(const archive::Archive& a, const archive::Archive& b,
                                 const CompareOptions& options = {});

}  // namespace orbweaver::report
