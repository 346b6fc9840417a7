// Three oscillators that are mirrored in the third, two of them nearly alike: families cross one another at two branch
// points next to one another.
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "orbweaver/systems/model/model_system.hpp"
#include "support/described.hpp"
#include "survey/surveyed_well.hpp"

namespace mirrored_oscillators_test {

using namespace orbweaver;

/// Unit masses in V = k1 x^2 + k2 y^2 + k3 z^2 and terms of third and fourth order, which are even in z.
class MirroredOscillators {
 public:
  static constexpr int dimension = 6;
  static constexpr int quantities = 1;

  static systems::ModelInfo info() {
    return test::described("mirrored_oscillators", "three oscillators that are mirrored in one of them",
                           {"x", "y", "z", "px", "py", "pz"});
  }

  static systems::Structure structure(const systems::Bound&) {
    const auto diagonal = [](double x, double y, double z, double px, double py, double pz) {
      return Eigen::MatrixXd(Eigen::Matrix<double, 6, 1>{x, y, z, px, py, pz}.asDiagonal());
    };
    systems::Structure structure;
    structure.dimension = dimension;
    structure.conserved = {"energy"};
    structure.symplectic = true;
    structure.equivariances = {{"Z", diagonal(1, 1, -1, 1, 1, -1)}};
    structure.reversors = {{"R", diagonal(1, 1, 1, -1, -1, -1)}, {"RZ", diagonal(1, 1, -1, -1, -1, 1)}};
    return structure;
  }

  template <class P>
  class With {
   public:
    explicit With(const systems::BoundTo<P>&) {}

    template <class S>
    void field(const S* s, S* f) const {
      const S x = s[0], y = s[1], z = s[2], xx = x * x, yy = y * y, zz = z * z;
      for (int i = 0; i < 3; ++i) f[i] = s[3 + i];
      f[3] = -(x * 0.9894 + zz * 0.1226 + yy * 0.2374 + x * y * 0.5914 - xx * 0.28986 + x * zz * 0.65 +
               x * yy * 0.3022 + x * xx * 0.6864);
      f[4] = -(y * 1.0324 + zz * 0.2684 + yy * 0.6057 + x * y * 0.4748 + xx * 0.2957 + y * zz * 0.6958 +
               y * yy * 1.4392 + xx * y * 0.3022);
      f[5] = -(z * 4.094 + y * z * 0.5368 + x * z * 0.2452 + z * zz * 0.9484 + yy * z * 0.6958 + xx * z * 0.65);
    }

    template <int, class S>
    S conserved(const S* s) const {
      const S x = s[0], y = s[1], z = s[2], xx = x * x, yy = y * y, zz = z * z;
      return action_density(s) * 0.5 + xx * 0.4947 + yy * 0.5162 + zz * 2.047 + y * zz * 0.2684 + y * yy * 0.2019 +
             x * zz * 0.1226 + x * yy * 0.2374 + xx * y * 0.2957 - x * xx * 0.09662 + zz * zz * 0.2371 +
             yy * zz * 0.3479 + yy * yy * 0.3598 + xx * zz * 0.325 + xx * yy * 0.1511 + xx * xx * 0.1716;
    }

    template <class S>
    S action_density(const S* s) const {
      return s[3] * s[3] + s[4] * s[4] + s[5] * s[5];
    }
  };
};

namespace {

// Both branches leave mode 1 so that its orbits beside the crossings are the nearest ones to theirs, and have all their
// symmetries. They passed for orbits of the branches, and the survey contradicted itself.
TEST(MirroredOscillators, OrbitsOfMoreSymmetryAreNotTheBranches) {
  const auto system =
      systems::Registered<MirroredOscillators>::make(systems::bound_to(MirroredOscillators::info(), {}, {}));
  const test::Atlas atlas = test::survey_of(
      system, {"survey.depth=1", "survey.subharmonics=3", "limits.period=16", "limits.energy=[-0.5, 0.177]"}, true);
  for (const std::string name : {"Equilibrium 1, mode 1 B1", "Equilibrium 1, mode 1 B2"})
    EXPECT_GT(atlas.column("period", name).size(), 1U) << name;
}

}  // namespace
}  // namespace mirrored_oscillators_test
