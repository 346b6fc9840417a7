#pragma once

#include <cstddef>
#include <vector>

#include "orbweaver/loop/symmetry/fundamental_domain.hpp"

namespace orbweaver::loop {

/// The filters of a StaggeredGrid as dense matrices on the domain alone, for symmetries that change signs of
/// coordinates and do not mix them. Coordinates with the same signs share matrices.
class FoldedFilters {
 public:
  /// cos and sin of q half cells, q = 0 .. 2 nodes - 1.
  struct Waves {
    std::vector<double> cosine;
    std::vector<double> sine;
  };

  FoldedFilters(const FundamentalDomain& domain, int cells, int stride);

  void to_midpoints(const double* y, double* z) const;
  void at_nodes(const double* y, double* z, double* slope) const;
  /// Writes the modes that the symmetries allow, leaves the others as they are.
  void to_modes(const double* y, double* modes) const;
  /// The inverse, for harmonics up to `cutoff`.
  void from_modes(int cutoff, const double* modes, double* y) const;

 private:
  /// rows x (cells + 1) numbers, entry (r, j) at [j * width + r], width = rows padded to whole SIMD registers.
  struct Matrix {
    int rows = 0;
    int width = 0;
    std::vector<double> entries;

    Matrix() = default;
    Matrix(int row_count, int columns);
    double& at(int r, int j) { return entries[static_cast<std::size_t>(j * width + r)]; }
  };
  struct Kind {
    double rotation_sign;  // under the generator
    double mirror_sign;    // under the reversor
    std::vector<int> coordinates;
    Matrix midpoint;
    Matrix node;
    Matrix slope;
    Matrix analysis;
    std::vector<int> analysed_rows;         // rows of the modes
    std::vector<double> synthesis_weights;  // what takes a row of the analysis back to y
  };
  void fill(Kind& kind, const Waves& waves) const;
  void multiply(const Matrix& matrix, const Kind& kind, const double* y) const;
  void apply(Matrix Kind::*matrix, const double* y, double* out, int out_stride) const;

  std::size_t _dimension;
  int _cells;
  int _stride;
  int _order;
  int _nodes;
  bool _mirrored;
  std::vector<Kind> _kinds;
  mutable std::vector<double> _work;
};

}  // namespace orbweaver::loop
