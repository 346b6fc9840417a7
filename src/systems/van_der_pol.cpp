#include <limits>

#include "orbweaver/systems/model/model_system.hpp"

namespace orbweaver::systems {

/// Van der Pol's oscillator x'' - mu (1 - x^2) x' + x = 0 (B. van der Pol 1926, doi:10.1080/14786442608564127), without
/// units; state x, v. It takes energy in where |x| < 1 and loses it outside: one limit cycle at each mu > 0.
class VanDerPol {
 public:
  static constexpr int dimension = 2;
  static constexpr int quantities = 0;
  static ModelInfo info();
  static Structure structure(const Bound& bound);

  template <class P>
  class With {
   public:
    explicit With(const BoundTo<P>& bound) : _mu(bound["mu"]) {}

    template <class S>
    void field(const S* z, S* f) const {
      f[0] = z[1];
      f[1] = (1.0 - z[0] * z[0]) * z[1] * _mu - z[0];
    }

    template <class S>
    S action_density(const S*) const {
      return S(std::numeric_limits<double>::quiet_NaN());
    }

   private:
    P _mu;
  };
};

ModelInfo VanDerPol::info() {
  ModelInfo info;
  info.name = "van_der_pol";
  info.title = "Van der Pol oscillator";
  info.meaning = "an oscillator that takes energy in where |x| < 1 and loses it outside";
  info.state_names = {"x", "v"};
  info.winding_names = {"", ""};
  info.parameters = {
      {"mu", 1.0, 0.0, std::numeric_limits<double>::infinity(), false, "1", "strength of what it takes in and loses"}};
  return info;
}

Structure VanDerPol::structure(const Bound&) {
  const Eigen::Matrix2d mirror = -Eigen::Matrix2d::Identity();
  Structure structure;
  structure.dimension = dimension;
  structure.equivariances = {{"S", mirror}};
  structure.dissipative = true;
  return structure;
}

template struct Registered<VanDerPol>;

}  // namespace orbweaver::systems
