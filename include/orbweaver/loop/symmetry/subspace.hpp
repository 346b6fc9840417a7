#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "orbweaver/loop/curve/loop.hpp"
#include "orbweaver/loop/symmetry/isotropy.hpp"

namespace orbweaver::loop {

/// The perturbations of a loop that keep its isotropy (or change sign under chosen elements): an orthonormal basis of
/// modes, harmonic by harmonic. Without symmetries: all modes. For the paper's symmetric pendulum loops (S@1/2 R@0):
/// cosines of the angles and sines of the velocities at odd harmonics, a quarter of all.
class Subspace {
 public:
  /// One coefficient of a basis vector: row of the modes (0: a_0, 2k-1: a_k, 2k: b_k) and coordinate.
  struct Entry {
    int row;
    int coordinate;
    double weight;
  };

  /// All modes of a loop of `dimension` coordinates up to `cutoff`.
  [[nodiscard]] static Subspace unrestricted(int dimension, int cutoff);

  /// Modes v with g v = v for each element of `isotropy`; with `signs` (one a generator, +1 or -1) g v = sign v.
  /// Throws MisuseError if sizes disagree.
  Subspace(int dimension, int cutoff, const Isotropy& isotropy, std::span<const int> signs = {});

  /// Where residuals z' - f(z) of loops in this subspace lie: the same symmetries, the signs of reversors flipped.
  [[nodiscard]] Subspace image() const;

  [[nodiscard]] int size() const { return static_cast<int>(_begin.size()) - 1; }
  [[nodiscard]] int dimension() const { return _dimension; }
  [[nodiscard]] int cutoff() const { return _cutoff; }
  /// Nonzero coefficients of basis vector n; all belong to one harmonic.
  [[nodiscard]] std::span<const Entry> basis(int n) const {
    const auto b = static_cast<std::size_t>(n);
    return {_entries.data() + _begin[b], _begin[b + 1] - _begin[b]};
  }
  [[nodiscard]] int harmonic(int n) const { return (basis(n).front().row + 1) / 2; }

  /// modes += sum_n coordinates_n basis_n. `modes`: (2 cutoff + 1) x dimension.
  void add_to(std::span<const double> coordinates, std::span<double> modes) const;
  /// coordinates_n = <basis_n, modes>: the orthogonal projection.
  void project(std::span<const double> modes, std::span<double> coordinates) const;

 private:
  Subspace() = default;
  void append_harmonic(int k, const Eigen::MatrixXd& basis);
  int _dimension = 0;
  int _cutoff = 0;
  Isotropy _isotropy;
  std::vector<int> _signs;
  std::vector<Entry> _entries;
  std::vector<std::size_t> _begin{0};
};

}  // namespace orbweaver::loop
