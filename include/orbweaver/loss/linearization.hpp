#pragma once

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include "orbweaver/core/error.hpp"
#include "orbweaver/loop/curve/loop.hpp"
#include "orbweaver/loop/grid/fourier.hpp"
#include "orbweaver/loss/unknowns.hpp"
#include "orbweaver/systems/system.hpp"

namespace orbweaver::loss {

/// How much of the second derivative of the loss is wanted.
enum class Curvature {
  gauss_newton,  ///< 2 J'J: exact at an orbit
  full,          ///< 2 (J'J + sum R d2R): exact everywhere
};

/// What is thrown where `what` of a system is not finite (`value`) at the time t of a loop: names the place in units.
[[nodiscard]] core::NotFiniteError not_finite(const systems::System& system, std::string_view what, double value,
                                              double t, double period, std::span<const double> state);

/// The loss of one loop and its derivatives, kept as nodal values on N equidistant points
/// (docs/mathematics.md, "Loss"; paper, section II A and B):
///
///   r_j = (2 pi / T) z'(s_j) / w_j - f(z(s_j)),   R_j = sqrt(w_j / N) r_j,   loss = |R|^2 = mean over time of |r|^2,
///
/// w_j = 2 pi phi'(s_j), the density of the loop's time map (1 without one). N = loop::nodes_for(loop) >= 2 (2K + 1),
/// so that the mean is the integral and not only zero at nodes. Every operation costs O(N log N).
class Linearization {
 public:
  enum class Order {
    residual = 0,
    jacobian = 1,  ///< also df/dz at the nodes
    second = 2,    ///< also sum_i r_i d2f_i at the nodes
  };

  /// `scalars`: those of the unknowns that it will be asked about, unless T is the only one. Throws MisuseError for an
  /// invalid loop, NumericalError where the field or its derivatives are not finite (which node, which time, which
  /// state).
  Linearization(const systems::System& system, const loop::Loop& loop, Order order,
                std::span<const Scalar> scalars = {});

  [[nodiscard]] int nodes() const { return _nodes; }
  [[nodiscard]] int dimension() const { return _dimension; }
  [[nodiscard]] int rows() const { return _nodes * _dimension; }
  [[nodiscard]] Order order() const { return _order; }
  [[nodiscard]] int cutoff() const { return _cutoff; }
  /// Mean over time of |r|^2.
  [[nodiscard]] double loss() const { return _loss; }
  /// R, dimension x nodes, component-major.
  [[nodiscard]] std::vector<double> residual() const;

  /// J v (dimension x nodes). Needs order >= jacobian, as everything below.
  [[nodiscard]] std::vector<double> apply_jacobian(const Unknowns& unknowns, std::span<const double> v) const;
  /// J' y, one entry an unknown.
  [[nodiscard]] std::vector<double> apply_jacobian_transposed(const Unknowns& unknowns,
                                                              std::span<const double> y) const;
  /// Gradient of the loss: 2 J' R.
  [[nodiscard]] std::vector<double> gradient(const Unknowns& unknowns) const;
  /// H v. Curvature::full needs order second.
  [[nodiscard]] std::vector<double> apply_hessian(const Unknowns& unknowns, std::span<const double> v,
                                                  Curvature curvature) const;

  // Nodal data for the assembly of matrices (loss/assembled.hpp).
  [[nodiscard]] double rate() const { return _rate; }      ///< 2 pi / T
  [[nodiscard]] double period() const { return _period; }  ///< T
  [[nodiscard]] const loop::FourierGrid& grid() const { return *_grid; }
  [[nodiscard]] const double* raw_residual(int i) const { return _r.data() + offset(i); }
  [[nodiscard]] const std::vector<double>& density() const { return _density; }         ///< w: 2 pi dphi/ds
  [[nodiscard]] const double* slope(int i) const { return _slope.data() + offset(i); }  ///< z_i'/w: dz_i/d(2 pi t/T)
  [[nodiscard]] bool evenly_in_time() const { return _evenly; }                         ///< w = 1 at all nodes
  [[nodiscard]] const double* field_jacobian(int i, int l) const { return _a.data() + offset(i * _dimension + l); }
  /// -dr/ds of a parameter (df/dp) or of an unfolding (the gradient), dimension x nodes.
  [[nodiscard]] const std::vector<double>& column(const Scalar& scalar) const;
  [[nodiscard]] const double* contracted(int i, int l) const { return _s.data() + offset(i * _dimension + l); }

 private:
  [[nodiscard]] std::size_t offset(int i) const {
    return static_cast<std::size_t>(i) * static_cast<std::size_t>(_nodes);
  }
  void check_finite(const systems::System& system, const loop::Loop& loop, std::span<const double> values,
                    const char* what) const;
  [[nodiscard]] std::vector<double> perturbation(const Unknowns& unknowns, std::span<const double> v) const;
  [[nodiscard]] std::vector<double> project_adjoint(const Unknowns& unknowns, const std::vector<double>& with_slope,
                                                    const std::vector<double>& with_value) const;
  void require_order(Order order) const;
  // Calls use(index in u, column) for each scalar but T.
  template <class Use>
  void for_each_column(const Unknowns& unknowns, const Use& use) const;

  int _nodes;
  int _dimension;
  int _cutoff;
  Order _order;
  double _period;
  double _rate;
  double _loss = 0.0;
  const loop::FourierGrid* _grid;
  bool _evenly;
  std::vector<double> _density;
  std::vector<double> _scale;  // sqrt(w / N)
  std::vector<double> _z;
  std::vector<double> _slope;
  std::vector<double> _r;
  std::vector<double> _a;
  std::vector<double> _s;
  std::vector<std::pair<Scalar, std::vector<double>>> _columns;
};

}  // namespace orbweaver::loss
