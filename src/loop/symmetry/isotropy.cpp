#include "orbweaver/loop/symmetry/isotropy.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "orbweaver/core/error.hpp"
#include "orbweaver/core/text.hpp"
#include "orbweaver/loop/curve/measures.hpp"
#include "orbweaver/loop/symmetry/subspace.hpp"
#include "orbweaver/numerics/decompositions.hpp"

namespace orbweaver::loop {

namespace {

void apply_matrix(const Eigen::MatrixXd& matrix, Loop& loop) {
  const auto rows = static_cast<Eigen::Index>(2 * loop.cutoff + 1);
  Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>> modes(loop.modes.data(), rows,
                                                                                           loop.dimension);
  modes = (modes * matrix.transpose()).eval();
  Eigen::Map<Eigen::VectorXd> winding(loop.winding.data(), loop.dimension);
  winding = (matrix * winding).eval();
}

void apply(const systems::AffineMap& map, Loop& loop) {
  apply_matrix(map.matrix, loop);
  if (map.is_linear()) return;
  for (int i = 0; i < loop.dimension; ++i) loop.cosine(0, i) += map.offset(i);
}

Loop reversed(const Loop& loop) {
  Loop out = loop;
  for (int k = 1; k <= loop.cutoff; ++k)
    for (int i = 0; i < loop.dimension; ++i) out.sine(k, i) = -loop.sine(k, i);
  for (double& n : out.winding) n = -n;
  out.time_map = loop.time_map.reversed();
  return out;
}

// Shifts the means of the angles by whole turns to those of `target`.
void reduce_angles_to(const Loop& target, const std::vector<int>& angles, Loop& loop) {
  for (const int i : angles) {
    const double turns = std::round((loop.cosine(0, i) - target.cosine(0, i)) / (2.0 * std::numbers::pi));
    loop.cosine(0, i) -= 2.0 * std::numbers::pi * turns;
  }
}

// Enough harmonics to see every pattern of shifts with denominators up to 12.
constexpr int pattern_cutoff = 12;

std::optional<SymmetryElement> match(const systems::Symmetry& declared, bool reversing,
                                     const systems::Structure& system, const Loop& loop, double tolerance,
                                     int max_denominator) {
  for (int q = 1; q <= max_denominator; ++q)
    for (int p = 0; p < q; ++p) {
      if (std::gcd(p, q) != 1) continue;
      SymmetryElement element{declared.name, reversing, declared.map, p, q};
      if (symmetry_defect(loop, element, system.angles) <= tolerance) return element;
    }
  return std::nullopt;
}

}  // namespace

Isotropy with_declared_matrices(Isotropy isotropy, const systems::Structure& system) {
  for (SymmetryElement& g : isotropy) {
    const auto& declared = g.reversing ? system.reversors : system.equivariances;
    const auto found =
        std::find_if(declared.begin(), declared.end(), [&](const systems::Symmetry& s) { return s.name == g.name; });
    if (found == declared.end())
      throw core::EnvironmentError(
          fmt::format("a task names the symmetry `{}`, which the system does not declare", core::printable(g.name)));
    if (g.shift_denominator < 1)
      throw core::EnvironmentError(
          fmt::format("a task names `{}` with the shift {}/{}", g.name, g.shift_numerator, g.shift_denominator));
    g.map = found->map;
  }
  return isotropy;
}

std::string to_text(const Isotropy& isotropy) {
  std::string text;
  for (const bool reversing : {false, true})
    for (const SymmetryElement& e : isotropy) {
      if (e.reversing != reversing) continue;
      if (!text.empty()) text += ' ';
      text += e.shift_numerator == 0 ? fmt::format("{}@0", e.name)
                                     : fmt::format("{}@{}/{}", e.name, e.shift_numerator, e.shift_denominator);
    }
  return text;
}

Loop transformed(const Loop& loop, const systems::AffineMap& map, bool reversing, double shift) {
  core::require(map.dimension() == loop.dimension, "a symmetry of another dimension cannot act on this loop");
  // For a symmetry of z both give z back.
  Loop out = reversing ? reversed(time_shifted(loop, shift)) : time_shifted(loop, shift);
  apply(map.inverse(), out);
  return out;
}

Loop transformed(const Loop& loop, const SymmetryElement& element) {
  return transformed(loop, element.map, element.reversing, element.shift());
}

Loop transformed_perturbation(const Loop& perturbation, const SymmetryElement& element) {
  return transformed(perturbation, element.map.matrix, element.reversing, element.shift());
}

double symmetry_defect(const Loop& loop, const SymmetryElement& element, const std::vector<int>& angles) {
  Loop image = transformed(loop, element);
  if (image.winding != loop.winding) return std::numeric_limits<double>::infinity();
  reduce_angles_to(loop, angles, image);
  return mean_distance(loop, image);
}

Isotropy find_isotropy(const systems::Structure& system, const Loop& loop, double tolerance, int max_denominator) {
  Isotropy isotropy;
  const auto size_with = [&loop](const Isotropy& generators) {
    return Subspace(loop.dimension, pattern_cutoff, generators).size();
  };
  const auto consider = [&](const systems::Symmetry& declared, bool reversing) {
    const auto element = match(declared, reversing, system, loop, tolerance, max_denominator);
    if (!element) return;
    Isotropy extended = isotropy;
    extended.push_back(*element);
    // A product of the generators so far restricts nothing further.
    if (size_with(extended) < size_with(isotropy)) isotropy = std::move(extended);
  };
  for (const systems::Symmetry& s : system.equivariances) consider(s, false);
  for (const systems::Symmetry& r : system.reversors) consider(r, true);
  return isotropy;
}

std::optional<SymmetryElement> find_map(const systems::Structure& system, const Loop& from, const Loop& to,
                                        double tolerance, int max_denominator) {
  const auto fits = [&](const SymmetryElement& element) {
    Loop image = transformed(from, element);
    if (image.winding != to.winding) return false;
    reduce_angles_to(to, system.angles, image);
    return mean_distance(image, to) <= tolerance;
  };
  const auto search = [&](const systems::Symmetry& declared, bool reversing) -> std::optional<SymmetryElement> {
    for (int q = 1; q <= max_denominator; ++q)
      for (int p = 0; p < q; ++p) {
        const SymmetryElement element{declared.name, reversing, declared.map, p, q};
        if (std::gcd(p, q) == 1 && fits(element)) return element;
      }
    return std::nullopt;
  };
  if (auto found = search({"1", systems::AffineMap::identity(from.dimension)}, false)) return found;
  for (const systems::Symmetry& s : system.equivariances)
    if (auto found = search(s, false)) return found;
  for (const systems::Symmetry& r : system.reversors)
    if (auto found = search(r, true)) return found;
  return std::nullopt;
}

}  // namespace orbweaver::loop
