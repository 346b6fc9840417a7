#pragma once

#include <memory>
#include <vector>

#include "orbweaver/loop/curve/loop.hpp"
#include "orbweaver/loop/symmetry/fundamental_domain.hpp"

namespace orbweaver::loop {

class FoldedFilters;

/// Equidistant nodes s_j = j h, j = 0 .. cells, on a fundamental domain, and the midpoints between them. A loop is held
/// by nodal values of y, whose harmonics are those of z divided by sin(x)/x, x = k h / 2: at a midpoint
/// dz/ds = (y_(j+1) - y_j) / h exactly, so that the box scheme on y differs from the true operator only where z itself
/// enters. y and z leave the winding out and stand relative to `centre`, which the symmetries map to itself.
///
/// Small grids multiply by dense matrices folded over the symmetries, large ones (and symmetries that mix coordinates)
/// transform the whole loop by FFT. One instance a size and domain; work space inside, not thread-safe.
class StaggeredGrid {
 public:
  /// The grid of this size on this domain, made once and kept for the process.
  [[nodiscard]] static const StaggeredGrid& shared(const FundamentalDomain& domain, int cells);
  /// Throws MisuseError for fewer than 2 cells.
  StaggeredGrid(const FundamentalDomain& domain, int cells);
  ~StaggeredGrid();
  StaggeredGrid(const StaggeredGrid&) = delete;
  StaggeredGrid& operator=(const StaggeredGrid&) = delete;

  [[nodiscard]] int cells() const { return _cells; }
  [[nodiscard]] int dimension() const { return _domain.dimension(); }
  /// Nodes of the whole loop.
  [[nodiscard]] int nodes() const { return _cells * _domain.copies(); }
  [[nodiscard]] double spacing() const;
  /// The highest harmonic below the Nyquist one.
  [[nodiscard]] int cutoff() const { return (nodes() - 1) / 2; }
  [[nodiscard]] const FundamentalDomain& domain() const { return _domain; }
  /// Distance in memory between coordinates of nodal values of y: cells + 1, padded.
  [[nodiscard]] int stride() const { return _stride; }

  /// z at the midpoints (dimension x cells, component-major) of y (dimension x stride).
  void to_midpoints(const double* y, double* z) const;
  /// z and dz/ds at the nodes 0 .. cells (dimension x stride each).
  void at_nodes(const double* y, double* z, double* slope) const;
  /// Modes of z ((2 cutoff + 1) x dimension; a_0 relative to the centre).
  void to_modes(const double* y, double* modes) const;
  /// y at the nodes (dimension x stride) of modes with `modes_cutoff` harmonics; those above this grid's are dropped.
  void from_modes(int modes_cutoff, const double* modes, double* y) const;
  /// y of given z at the nodes 0 .. cells (dimension x stride each).
  void from_nodal(const double* z, double* y) const;

 private:
  struct Transforms;
  void expand(const double* y, double* full) const;
  /// Multiplies the harmonics by real + i imaginary.
  void apply_by_fft(const std::vector<double>& real, const std::vector<double>& imaginary, const double* y, double* out,
                    int count, int out_stride) const;

  FundamentalDomain _domain;
  int _cells;
  int _stride;
  struct Image {
    int node;     // of the domain, 0 .. cells
    int element;  // index into _elements
  };
  std::vector<Image> _images;              // of every node of the whole loop
  std::vector<Eigen::MatrixXd> _elements;  // symmetries that map the domain to its copies
  std::vector<double> _midpoint_real, _midpoint_imaginary, _node, _slope, _zero;  // filters by harmonic, with 1/nodes
  std::vector<double> _unfilter;                                                  // x / sin x of each harmonic
  bool _diagonal = false;  // every element is a diagonal of signs
  std::unique_ptr<FoldedFilters> _filters;
  std::unique_ptr<Transforms> _transforms;
};

}  // namespace orbweaver::loop
