#pragma once

#include <array>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "orbweaver/continuation/branch.hpp"
#include "orbweaver/continuation/ending.hpp"
#include "orbweaver/loop/curve/loop.hpp"
#include "orbweaver/loop/curve/tangent.hpp"
#include "orbweaver/loop/symmetry/isotropy.hpp"
#include "orbweaver/systems/system.hpp"

namespace orbweaver::continuation {

/// Where a locus ceases to be what it is for, though its test function goes on vanishing.
struct LocusBoundary {
  Ending ending;
  std::function<double(const loop::Loop&)> inside{};  ///< positive before, zero there
};

/// Between two neighbouring points of a locus: an orbit that has a symmetry more.
struct LocusArrival {
  std::string symmetry;  ///< for people: "S@1/2"
  /// The signed part of an orbit that breaks it, 1 at the first of the two and zero where none does, and its size.
  std::function<std::array<double, 2>(const loop::Loop&)> broken{};
};

/// What vanishes along a locus. One of the first two is set.
struct LocusTest {
  /// A test function of an orbit; NaN where it has no value.
  std::function<double(const loop::Loop&)> value{};
  /// Of folds: how the two quantities, of which the first folds where the second is held, change along a direction of
  /// the surface. The surface folds over their plane where the changes along two directions are parallel.
  std::function<std::array<double, 2>(const loop::Loop&, const loop::Tangent&)> projection{};
  std::vector<LocusBoundary> boundaries{};
  /// The symmetries that an orbit between two neighbouring points may have and theirs lack.
  std::function<std::vector<LocusArrival>(const loop::Loop&, const loop::Loop&)> arrivals{};
};

/// A point of a locus.
struct LocusPoint {
  loop::Loop loop;
  double arclength = 0.0;  ///< from the start, in the length in which branches measure their steps
  bool is_cusp = false;    ///< the curve of folds turns back in the plane of its two quantities
  bool is_return = false;  ///< the second parameter has the start's value again
};

struct LocusOptions {
  Options branch{};  ///< limits as of branches; `step_limit` points
  /// Of the second parameter, the last of the system's free ones, in its scale.
  double from = -std::numeric_limits<double>::infinity();
  double to = std::numeric_limits<double>::infinity();
  double largest_step = 0.25;           ///< in the length of steps: a curve of less than that is drawn by its ends
  std::function<void()> before_each{};  ///< called before every orbit that is sought; may throw
};

struct Locus {
  std::vector<LocusPoint> points;  ///< without the start
  Ending ending;
};

/// Follows the orbits of a surface at which a test function vanishes, from one of them (docs/mathematics.md, "Loci").
///
/// The orbits of one isotropy of `system`, whose families have one parameter more than is usual (its last free one),
/// are a surface: two conditions pick one, the place along the locus and the place across it. The second is found such
/// that the test function vanishes (a minimally extended system). Steps and predictions are those of branches.
///
/// `start`: an orbit of the locus, with values for all free parameters; `family`: the direction of the family with the
/// last of them held, without it among its scalars. `side`: 1 or -1, the two ways from the start. Throws InputError
/// where collocation does not apply to orbits of this isotropy.
[[nodiscard]] Locus follow_locus(const std::shared_ptr<const systems::System>& system, const loop::Isotropy& isotropy,
                                 const loop::Loop& start, const loop::Tangent& family, const LocusTest& test, int side,
                                 const LocusOptions& options);

}  // namespace orbweaver::continuation
