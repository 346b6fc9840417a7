#include "same_plane.hpp"

#include <cmath>

namespace orbweaver::bifurcation {

namespace {

/// Overlap above which two planes are one that has turned. Of planes that are orthogonal to one another only one can
/// have as much of another plane.
constexpr double same_plane = 0.75;

}  // namespace

double overlap(const spectrum::Rotation& a, const spectrum::Rotation& b) {
  return Eigen::Matrix2d(a.plane.transpose() * b.plane).determinant();
}

Counterpart counterpart(const spectrum::Rotation& of, const spectrum::Stability& there) {
  Counterpart best;
  for (const spectrum::Rotation& rotation : there.rotations) {
    const double shared = overlap(of, rotation);
    if (std::abs(shared) > std::abs(best.overlap)) best = {&rotation, shared};
  }
  return std::abs(best.overlap) > same_plane ? best : Counterpart{};
}

}  // namespace orbweaver::bifurcation
