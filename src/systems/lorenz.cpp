#include <limits>

#include "orbweaver/systems/model/model_system.hpp"

namespace orbweaver::systems {

/// Lorenz's model of convection (E. N. Lorenz 1963, doi:10.1175/1520-0469(1963)020<0130:DNF>2.0.CO;2), without units:
///   x' = sigma (y - x),   y' = x (rho - z) - y,   z' = x y - beta z.
/// Volumes shrink at the rate sigma + 1 + beta.
class Lorenz {
 public:
  static constexpr int dimension = 3;
  static constexpr int quantities = 0;
  static ModelInfo info();
  static Structure structure(const Bound& bound);

  template <class P>
  class With {
   public:
    explicit With(const BoundTo<P>& bound) : _sigma(bound["sigma"]), _rho(bound["rho"]), _beta(bound["beta"]) {}

    template <class S>
    void field(const S* z, S* f) const {
      f[0] = (z[1] - z[0]) * _sigma;
      f[1] = z[0] * (_rho - z[2]) - z[1];
      f[2] = z[0] * z[1] - z[2] * _beta;
    }

    template <class S>
    S action_density(const S*) const {
      return S(std::numeric_limits<double>::quiet_NaN());
    }

   private:
    P _sigma;
    P _rho;
    P _beta;
  };
};

ModelInfo Lorenz::info() {
  constexpr double inf = std::numeric_limits<double>::infinity();
  ModelInfo info;
  info.name = "lorenz";
  info.title = "Lorenz system";
  info.meaning = "convection in three modes: how fast it turns, and two of the temperature";
  info.state_names = {"x", "y", "z"};
  info.winding_names = {"", "", ""};
  info.parameters = {{"sigma", 10.0, 0.0, inf, true, "1", "Prandtl number"},
                     {"rho", 28.0, 0.0, inf, false, "1", "Rayleigh number over its critical value"},
                     {"beta", 8.0 / 3.0, 0.0, inf, true, "1", "shape of the rolls"}};
  return info;
}

Structure Lorenz::structure(const Bound&) {
  const Eigen::Matrix3d half_turn = Eigen::Vector3d(-1, -1, 1).asDiagonal();
  Structure structure;
  structure.dimension = dimension;
  structure.equivariances = {{"S", half_turn}};
  structure.dissipative = true;
  return structure;
}

template struct Registered<Lorenz>;

}  // namespace orbweaver::systems
