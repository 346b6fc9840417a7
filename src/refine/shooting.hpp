#pragma once

#include <optional>
#include <vector>

#include "orbweaver/loop/curve/loop.hpp"
#include "orbweaver/loop/symmetry/isotropy.hpp"
#include "orbweaver/refine/exact_map.hpp"
#include "orbweaver/systems/formulas.hpp"
#include "orbweaver/systems/scales.hpp"
#include "orbweaver/systems/structure.hpp"
#include "orbweaver/taylor/flow.hpp"

namespace orbweaver::refine {

/// The states of an orbit at a few instants of its fundamental domain, and its period. In the units of the system.
template <class Real>
struct Points {
  std::vector<std::vector<Real>> nodes;
  Real period;
};

/// What follows from them by integration.
template <class Real>
struct Passage {
  std::vector<std::vector<Real>> ends;    ///< one a segment
  std::vector<Matrix<Real>> transitions;  ///< the same; empty where they were not asked for
};

/// Where the nodes of multiple shooting lie, and what an orbit of a family fulfils besides the field: numbers and maps
/// that hold exactly.
struct ShootingSetup {
  /// `loop`: a guess in the units of the system, in standard phase, with its `isotropy` at that phase.
  ShootingSetup(const systems::Formulas& formulas, const systems::Structure& structure, const systems::Scales& scales,
                const loop::Loop& loop, const loop::Isotropy& isotropy);

  /// A map that states obey, z -> matrix z + turns 2 pi.
  struct Map {
    enum class Between { start_and_start, end_and_end, start_and_end } between;
    ExactMatrix matrix;
    std::vector<double> turns;  ///< whole quarters
  };

  systems::Formulas formulas;
  systems::Structure structure;
  systems::Scales scales;
  int order = 1;          ///< p
  bool mirrored = false;  ///< a reversor halves the domain
  std::string reversor_name;
  ExactMatrix generator;  ///< g
  ExactMatrix reversor;   ///< R of phase 0; the identity where there is none
  std::vector<Map> maps;
  std::vector<double> fractions;  ///< of the nodes, in parts of the period, but for the last, which is 1/copies
  /// Without a reversor: the coordinate that is largest at the start, or of a driven system the drive's phase, which is
  /// 0 there.
  std::optional<std::size_t> phase;
  double phase_winding = 0.0;  ///< its winding number
  Points<double> guess;

  [[nodiscard]] std::size_t dimension() const { return static_cast<std::size_t>(formulas.dimension); }
  [[nodiscard]] int copies() const { return mirrored ? 2 * order : order; }
  [[nodiscard]] std::size_t segments() const { return fractions.size() - 1; }
  [[nodiscard]] bool starts_with_drive() const { return phase.has_value() && structure.driven; }
};

/// The equations of multiple shooting on the fundamental domain in some arithmetic, in the scales:
///   Phi(x_m) = x_(m+1);
///   x_0 in Fix(R) and x_M in Fix(g R), or x_M = g x_0 and z_i largest (the drive's phase 0) at the start;
///   x_0 kept by what keeps every point of the orbit.
/// They are more than the unknowns (by what symmetries and the energy make dependent), and agree at an orbit. Where a
/// quantity is conserved, one condition that picks an orbit of the family is missing.
template <class Real>
class Shooting {
 public:
  /// `digits`: of the integration. `extra_order`: of its Taylor series, so that two computations differ.
  Shooting(const ShootingSetup& setup, double digits, int extra_order);

  [[nodiscard]] Passage<Real> pass(const Points<Real>& points, bool with_transitions);
  [[nodiscard]] Vector<Real> residual(const Points<Real>& points, const Passage<Real>& passage) const;
  /// Its derivatives by the nodes, one after the other, and the period, all in the scales.
  [[nodiscard]] Matrix<Real> jacobian(const Points<Real>& points, const Passage<Real>& passage) const;

  [[nodiscard]] Vector<Real> field(const std::vector<Real>& z) const;
  /// df/dz.
  [[nodiscard]] Matrix<Real> linearized(const std::vector<Real>& z) const;
  [[nodiscard]] Real energy(const std::vector<Real>& z) const;
  [[nodiscard]] Vector<Real> energy_gradient(const std::vector<Real>& z) const;
  /// Over the whole domain.
  [[nodiscard]] Matrix<Real> transition(const Passage<Real>& passage) const;
  /// g^-1 M(T/p), M being the transition matrix from the start on.
  [[nodiscard]] Matrix<Real> fundamental_map(const Passage<Real>& passage) const;
  /// M(T).
  [[nodiscard]] Matrix<Real> monodromy(const Matrix<Real>& fundamental_map) const;
  /// det M(T), as the product of the segments'. Without a reversor.
  [[nodiscard]] Real determinant(const Passage<Real>& passage) const;
  /// The direction of the family at the start, (dz, dT), with along . (dz, dT) = 1, `along` in the scales.
  [[nodiscard]] Vector<Real> tangent(const Points<Real>& points, const Passage<Real>& passage,
                                     const Eigen::VectorXd& along) const;

  [[nodiscard]] const taylor::Flow<Real>& flow() const { return _flow; }
  [[nodiscard]] const std::vector<Real>& parameters() const { return _parameters; }

 private:
  [[nodiscard]] Real fraction(std::size_t node) const;
  [[nodiscard]] const std::vector<Real>& from(const ShootingSetup::Map& map, const Points<Real>& points) const;
  [[nodiscard]] const std::vector<Real>& to(const ShootingSetup::Map& map, const Points<Real>& points) const;

  const ShootingSetup& _setup;
  std::vector<Real> _parameters;
  std::vector<Matrix<Real>> _matrices;  // of the maps
  Matrix<Real> _generator;
  Matrix<Real> _reversor;
  Real _two_pi;
  taylor::Flow<Real> _flow;
};

extern template class Shooting<double>;
extern template class Shooting<numerics::Extended>;

}  // namespace orbweaver::refine
