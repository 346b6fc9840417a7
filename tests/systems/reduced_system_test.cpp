// Systems with several conserved quantities, told without those that are linear in the coordinates.
#include "orbweaver/systems/reduced_system.hpp"

#include <cmath>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <Eigen/Dense>

#include "orbweaver/core/error.hpp"
#include "orbweaver/model/evaluate.hpp"
#include "orbweaver/systems/formulas.hpp"
#include "orbweaver/systems/identities.hpp"
#include "orbweaver/systems/quad_system.hpp"
#include "orbweaver/systems/registry.hpp"
#include "orbweaver/systems/undeclared_symmetries.hpp"
#include "support/lattice.hpp"

namespace orbweaver::systems::reduced_system_test {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using test::CentralField;
using test::Lattice;
using test::LatticeByHand;
using test::reduced_model;
using testing::ElementsAre;
using testing::HasSubstr;
using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

std::vector<std::vector<double>> states_of(const System& system) {
  const std::vector<double> centre(static_cast<std::size_t>(system.dimension()), 1.5);
  return states_around(system.structure(), {centre}, 6, 0.7);
}

VectorXd field_of(const System& system, const std::vector<double>& z) {
  VectorXd f(system.dimension());
  system.field(1, z.data(), f.data());
  return f;
}

MatrixXd jacobian_of(const System& system, const std::vector<double>& z) {
  VectorXd f(system.dimension());
  RowMajor jacobian(system.dimension(), system.dimension());
  system.field_jacobian(1, z.data(), f.data(), jacobian.data());
  EXPECT_LT((f - field_of(system, z)).norm(), 1e-14 * f.norm());
  return jacobian;
}

std::vector<std::shared_ptr<const System>> all_kinds() {
  return {reduced_model<Lattice>(),
          reduced_model<Lattice>({{"momentum", 0.3}}),
          reduced_model<Lattice>({{"closing", 0.0}, {"m2", 2.5}}),
          reduced_model<Lattice>({{"closing", 0.7}, {"m2", 0.4}, {"momentum", -1.2}}),
          reduced_model<CentralField>(),
          reduced_model<CentralField>({{"L", 0.2}, {"b", 3.0}})};
}

TEST(ReducedSystem, LeavesOutTwoCoordinatesAQuantity) {
  const auto ring = reduced_model<Lattice>();
  EXPECT_EQ(ring->dimension(), 4);
  EXPECT_THAT(ring->structure().conserved, ElementsAre("energy"));
  EXPECT_TRUE(ring->structure().symplectic);
  EXPECT_EQ(ring->structure().pairs(), 1);
  EXPECT_EQ(ring->structure().equivariances.size(), 5U);
  EXPECT_EQ(ring->structure().reversors.size(), 4U);
  EXPECT_THAT(ring->info().meaning, HasSubstr("held: momentum = 0"));
  const auto orbit = reduced_model<CentralField>();
  EXPECT_THAT(orbit->info().state_names, ElementsAre("r", "pr"));
  EXPECT_THAT(orbit->structure().angles, ElementsAre());
  // Its mirror and its reversor turn the angular momentum round: neither is left, and their product is.
  EXPECT_TRUE(orbit->structure().equivariances.empty());
  ASSERT_EQ(orbit->structure().reversors.size(), 1U);
  EXPECT_EQ(orbit->structure().reversors.front().name, "RM");
}

TEST(ReducedSystem, IsTheSystemWhereOneQuantityIsConserved) {
  const auto plain = recorded<LatticeByHand>(bound_to(LatticeByHand::info(), {}, {}));
  EXPECT_EQ(reduced(plain), plain);
  EXPECT_EQ(whole_of(*plain), nullptr);
  EXPECT_EQ(why_not_reduced(*plain), "");
}

TEST(ReducedSystem, KeepsWhatItsStructurePromises) {
  for (const auto& system : all_kinds())
    for (const IdentityError& found : identity_errors(*system, states_of(*system)))
      EXPECT_LT(found.error, 1e-13) << system->info().name << ": " << found.identity;
}

// All that measures loops takes symmetries for isometries: frames are chosen for that, or coordinates straightened.
TEST(ReducedSystem, SymmetriesStayOrthogonal) {
  const auto ring = reduced_model<Lattice>();
  EXPECT_THAT(ring->info().state_names, ElementsAre("x2_rel", "x3_rel", "p2_rel", "p3_rel"));
  for (const auto& system : all_kinds())
    for (const auto* symmetries : {&system->structure().equivariances, &system->structure().reversors})
      for (const Symmetry& s : *symmetries) EXPECT_TRUE(s.map.matrix.isUnitary(1e-14)) << s.name;
  // The mirror of a chain keeps the particle in its middle.
  const auto chain = reduced_model<Lattice>({{"closing", 0.0}});
  EXPECT_THAT(chain->info().state_names, ElementsAre("x1", "x3", "p1", "p3"));
  EXPECT_EQ(chain->structure().equivariances.size(), 1U);
  EXPECT_EQ(chain->structure().reversors.size(), 2U);
}

TEST(ReducedSystem, MovesAsTheWholeOneInItsFrame) {
  for (const auto& system : all_kinds()) {
    const System& whole = *whole_of(*system);
    for (const std::vector<double>& y : states_of(*system)) {
      const std::vector<double> z = whole_state(*system, y);
      const std::vector<double> back = reduced_state(*system, z);
      for (std::size_t i = 0; i < y.size(); ++i) EXPECT_NEAR(back[i], y[i], 1e-14);
      EXPECT_NEAR(system->conserved(0, y), whole.conserved(0, z), 1e-14 * std::abs(whole.conserved(0, z)));
      // The image of the motion, by a small step to both sides.
      const VectorXd f = field_of(whole, z);
      constexpr double step = 1e-5;
      std::vector<double> later = z, before = z;
      for (std::size_t i = 0; i < z.size(); ++i) {
        later[i] += step * f(static_cast<Eigen::Index>(i));
        before[i] -= step * f(static_cast<Eigen::Index>(i));
      }
      const std::vector<double> a = reduced_state(*system, later), b = reduced_state(*system, before);
      const VectorXd rates = field_of(*system, y);
      for (std::size_t i = 0; i < y.size(); ++i)
        EXPECT_NEAR((a[i] - b[i]) / (2.0 * step), rates(static_cast<Eigen::Index>(i)), 1e-9) << system->info().name;
    }
  }
}

TEST(ReducedSystem, DerivativesAreThoseOfItsField) {
  constexpr double step = 1e-5;
  for (const auto& system : all_kinds()) {
    SCOPED_TRACE(system->info().name);
    const Eigen::Index d = system->dimension();
    for (const std::vector<double>& y : states_of(*system)) {
      const MatrixXd jacobian = jacobian_of(*system, y);
      VectorXd weights(d), gradient(d);
      for (Eigen::Index i = 0; i < d; ++i) weights(i) = 0.3 + 0.2 * static_cast<double>(i);
      RowMajor contracted(d, d);
      system->second_derivatives(1, y.data(), weights.data(), contracted.data());
      system->conserved_gradient(0, y, {gradient.data(), y.size()});
      for (std::size_t l = 0; l < y.size(); ++l) {
        std::vector<double> above = y, below = y;
        above[l] += step;
        below[l] -= step;
        const auto column = static_cast<Eigen::Index>(l);
        EXPECT_LT(((field_of(*system, above) - field_of(*system, below)) / (2.0 * step) - jacobian.col(column)).norm(),
                  1e-8 * (1.0 + jacobian.norm()));
        const MatrixXd change = (jacobian_of(*system, above) - jacobian_of(*system, below)) / (2.0 * step);
        EXPECT_LT((change.transpose() * weights - contracted.col(column)).norm(), 1e-8 * (1.0 + contracted.norm()));
        EXPECT_NEAR((system->conserved(0, above) - system->conserved(0, below)) / (2.0 * step), gradient(column),
                    1e-8 * (1.0 + gradient.norm()));
      }
    }
  }
}

TEST(ReducedSystem, MovesWithParametersAndWithTheValuesHeld) {
  const std::map<std::string, double> odd{{"closing", 0.7}, {"m2", 0.4}, {"momentum", -1.2}};
  const auto lattice = reduced_model<Lattice>(odd);
  const auto check = [](const System& system, const std::string& name) {
    constexpr double step = 1e-5;
    const double value = system.parameters().at(name);
    const auto above = system.with_parameters({{name, value + step}});
    const auto below = system.with_parameters({{name, value - step}});
    for (const std::vector<double>& y : states_of(system)) {
      VectorXd slope(system.dimension());
      system.parameter_derivatives(name, 1, y.data(), slope.data());
      const VectorXd difference = (field_of(*above, y) - field_of(*below, y)) / (2.0 * step);
      EXPECT_LT((difference - slope).norm(), 1e-8 * (1.0 + slope.norm())) << name;
    }
  };
  for (const auto& [name, value] : odd) check(*lattice, name);
  check(*reduced_model<CentralField>(), "L");
  check(*reduced_model<CentralField>(), "b");
}

// Formulas have all digits, the irrational numbers of straightened coordinates among them: in quadruple precision the
// field of the ring keeps its symmetry to more digits than doubles have.
TEST(ReducedSystem, FormulasAreThoseOfItsField) {
  for (const auto& system : all_kinds())
    for (const std::vector<double>& y : states_of(*system)) {
      numerics::QuadVector z(system->dimension()), f;
      numerics::QuadMatrix jacobian;
      for (std::size_t i = 0; i < y.size(); ++i) z(static_cast<Eigen::Index>(i)) = y[i];
      dynamic_cast<const QuadSystem&>(*system).linearize(z, f, jacobian);
      const VectorXd expected = field_of(*system, y);
      const MatrixXd linear = jacobian_of(*system, y);
      EXPECT_LT((f.cast<double>() - expected).norm(), 1e-14 * (1.0 + expected.norm()));
      EXPECT_LT((jacobian.cast<double>() - linear).norm(), 1e-14 * (1.0 + linear.norm()));
      const Formulas formulas = dynamic_cast<const FormulaSystem&>(*system).formulas();
      ASSERT_EQ(formulas.conserved.size(), 1U);
      const std::vector<double> inputs(y), parameters(formulas.values);
      const std::vector<double> energy =
          model::evaluate<double>(formulas.graph, formulas.conserved, inputs, parameters);
      EXPECT_NEAR(energy.front(), system->conserved(0, y), 1e-14 * (1.0 + std::abs(energy.front())));
      VectorXd gradient(system->dimension());
      system->conserved_gradient(0, y, {gradient.data(), y.size()});
      const std::vector<double> slopes =
          model::evaluate<double>(formulas.graph, formulas.conserved_gradients.front(), inputs, parameters);
      for (std::size_t i = 0; i < y.size(); ++i) EXPECT_NEAR(slopes[i], gradient(static_cast<Eigen::Index>(i)), 1e-13);
    }
  // C turns by 120 degrees in both planes.
  const auto ring = reduced_model<Lattice>();
  using numerics::Quad;
  const Quad half = Quad(1.0) / 2.0, root = sqrt(Quad(3.0)) / 2.0;
  numerics::QuadMatrix exact(4, 4);
  const MatrixXd turn = ring->structure().equivariances.front().map.matrix;
  for (Eigen::Index i = 0; i < 4; ++i)
    for (Eigen::Index l = 0; l < 4; ++l) {
      const double entry = turn(i, l);
      const double size = std::abs(entry);
      exact(i, l) = size < 0.1 ? Quad(0.0) : (size < 0.7 ? half : root) * (entry < 0.0 ? -1.0 : 1.0);
    }
  numerics::QuadVector z(4), f, image;
  numerics::QuadMatrix unused;
  z << 0.3, -1.2, 0.7, 0.9;
  const auto& quad = dynamic_cast<const QuadSystem&>(*ring);
  quad.linearize(z, f, unused);
  quad.linearize(exact * z, image, unused);
  EXPECT_LT(static_cast<double>((image - exact * f).norm()), 1e-30);
}

/// The lattice, with another second quantity: one that is not linear in the coordinates, one that is not conserved, one
/// that says the same twice.
enum class Told { turning, first_momentum, twice };

template <Told told>
class ToldLattice {
 public:
  static constexpr int dimension = 6;
  static constexpr int quantities = told == Told::twice ? 3 : 2;
  static ModelInfo info() { return Lattice::info(); }
  static Structure structure(const Bound& bound) {
    Structure structure = Lattice::structure(bound);
    structure.conserved = {"energy", "Q"};
    if (told == Told::twice) structure.conserved.push_back("momentum");
    return structure;
  }
  template <class P>
  class With : public Lattice::With<P> {
   public:
    using Lattice::With<P>::With;
    template <int K, class S>
    S conserved(const S* z) const {
      if constexpr (K == 1 && told == Told::turning) return z[0] * z[4] - z[1] * z[3];
      if constexpr (K == 1 && told == Told::first_momentum) return z[3] * 1.0;
      if constexpr (K == 1 && told == Told::twice) return (z[3] + z[4] + z[5]) * 2.0;
      return Lattice::With<P>::template conserved < K == 0 ? 0 : 1, S > (z);
    }
  };
};

template <Told told>
std::string obstacle() {
  const auto plain = recorded<ToldLattice<told>>(bound_to(Lattice::info(), {}, {}));
  EXPECT_EQ(reduced(plain), plain);
  return why_not_reduced(*plain);
}

TEST(ReducedSystem, SaysWhyItCannotBe) {
  EXPECT_EQ(obstacle<Told::turning>(), "none of energy, Q is linear in the coordinates");
  EXPECT_EQ(obstacle<Told::first_momentum>(), "Q changes along the field");
  EXPECT_EQ(obstacle<Told::twice>(),
            "its field stays the same along 1 translation of the coordinates, and 2 of its conserved quantities are "
            "linear in them, where each belongs to one");
}

/// A system that names its energy alone.
template <class Model>
class EnergyAlone : public Model {
 public:
  static constexpr int quantities = 1;
  static Structure structure(const Bound& bound) {
    Structure structure = Model::structure(bound);
    structure.conserved.resize(1);
    return structure;
  }
};

TEST(ReducedSystem, AMomentumThatIsNotNamedIsTold) {
  const auto made = []<class Model>() { return recorded<EnergyAlone<Model>>(bound_to(Model::info(), {}, {})); };
  EXPECT_THAT(undeclared_translations(*made.operator()<Lattice>()), ElementsAre("x1", "x2", "x3"));
  EXPECT_THAT(undeclared_translations(*made.operator()<CentralField>()), ElementsAre("phi"));
  EXPECT_THAT(undeclared_translations(*reduced_model<Lattice>()), ElementsAre());
  EXPECT_THAT(undeclared_translations(*make_system("henon_heiles")), ElementsAre());
  EXPECT_THAT(undeclared_translations(*make_system("double_pendulum")), ElementsAre());
}

TEST(ReducedSystem, AStateOfAnotherValueIsRefused) {
  const auto ring = reduced_model<Lattice>({{"momentum", 0.5}});
  const std::vector<double> right{0.1, 0.2, 0.3, 0.2, 0.2, 0.1};
  EXPECT_NO_THROW(static_cast<void>(reduced_state(*ring, right)));
  const std::vector<double> wrong{0.1, 0.2, 0.3, 0.2, 0.2, 0.2};
  try {
    static_cast<void>(reduced_state(*ring, wrong));
    ADD_FAILURE() << "taken";
  } catch (const core::InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("momentum = 0.5, which is held, got one with 0.6"));
    EXPECT_THAT(error.what(), HasSubstr("give the system the parameter `momentum: 0.6`"));
  }
}

}  // namespace
}  // namespace orbweaver::systems::reduced_system_test
