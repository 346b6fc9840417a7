#pragma once

#include <cstddef>
#include <memory>
#include <vector>

namespace orbweaver::loop {

/// Real Fourier transforms between modes and N equidistant nodes s_j = 2 pi j / N. Plans are made once a size and kept
/// for the process (FFTW_ESTIMATE only, so that results repeat). Not thread-safe; one instance a process and size.
class FourierGrid {
 public:
  /// The grid with `nodes` nodes, even or odd. Throws MisuseError for nodes < 2.
  [[nodiscard]] static const FourierGrid& of_size(int nodes);
  /// The even number of nodes N >= 2 (2 cutoff + 1), with small factors, on which the loss is a true integral.
  [[nodiscard]] static int nodes_for(int cutoff);
  /// The smallest even number of nodes >= `least` with small factors.
  [[nodiscard]] static int nodes_at_least(int least);

  FourierGrid(const FourierGrid&) = delete;
  FourierGrid& operator=(const FourierGrid&) = delete;
  FourierGrid(FourierGrid&&) = delete;
  FourierGrid& operator=(FourierGrid&&) = delete;
  ~FourierGrid();

  [[nodiscard]] int nodes() const { return _nodes; }

  /// Modes ((2 cutoff + 1) x dimension, rows a_0, a_1, b_1, ...) to nodal values (component-major, dimension x nodes).
  /// Needs cutoff < nodes / 2.
  void synthesize(int cutoff, int dimension, const double* modes, double* nodal) const;

  /// The derivative with respect to s of what `synthesize` gives.
  void synthesize_derivative(int cutoff, int dimension, const double* modes, double* nodal) const;

  /// Sums over nodes of one nodal function g: cosines[m] = sum_j g_j cos(m s_j), sines[m] = sum_j g_j sin(m s_j),
  /// m = 0 .. highest <= nodes / 2. Arrays of size highest + 1.
  void sums(const double* g, int highest, double* cosines, double* sines) const;

  /// Nodal values (component-major) to the modes of the trigonometric interpolant, truncated at `cutoff` < nodes / 2.
  void analyze(int cutoff, int dimension, const double* nodal, double* modes) const;

 private:
  explicit FourierGrid(int nodes);
  struct Plans;
  int _nodes;
  std::unique_ptr<Plans> _plans;
};

}  // namespace orbweaver::loop
