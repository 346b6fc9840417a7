// Hopf points of systems that conserve linear totals, a stiff network of reactions and an epidemic.
#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include <gmock/gmock.h>

#include "orbweaver/starts/equilibrium_curve.hpp"
#include "orbweaver/starts/natural_scales.hpp"
#include "orbweaver/systems/linear_totals.hpp"
#include "orbweaver/systems/recorded_model.hpp"
#include "orbweaver/systems/reduced_system.hpp"
#include "orbweaver/systems/scaled_system.hpp"
#include "support/described.hpp"

namespace orbweaver::starts::hopf_of_networks_test {
namespace {

/// Nine reactions of six species, with rates from 1e-9 to 1e9. Its Hopf point is at k9 = 5.160737862e-4 with
/// T = 1945.34: eigenvalues +-3.2e-3 i beside -2.65e9.
class Network {
 public:
  static constexpr int dimension = 6;
  static constexpr int quantities = 0;
  static systems::ModelInfo info() {
    systems::ModelInfo info =
        test::described("network", "a network of reactions", {"X1", "X2", "X3", "X4", "X5", "X6"}, {"k9"});
    info.parameters[0].standard = 0.0005160737862267585;
    return info;
  }
  static systems::Structure structure(const systems::Bound&) { return test::dissipative_structure(dimension); }
  template <class P>
  class With {
   public:
    explicit With(const systems::BoundTo<P>& bound) : _k9(bound["k9"]) {}
    template <class S>
    void field(const S* z, S* f) const {
      const S r1 = z[1] * 2.8384448207706775e-09, r2 = z[0] * 2.276606366932523e-10, r3 = z[2] * 1.0000091094346868;
      const S r4 = z[4] * 29473.54319518398, r5 = z[3] * 0.01816749288551057, r6 = z[3] * 0.002345143593835089;
      const S r7 = z[5] * 2.499174147678733e-05, r8 = z[0] * z[4] * 1601057615.0026472, r9 = z[0] * z[5] * _k9;
      f[0] = r1 - r2 - r8 - r9;
      f[1] = r2 - r1 + r8 + r9;
      f[2] = r6 - r3 + r8;
      f[3] = r4 - r5 - r6 + r9;
      f[4] = r3 - r4 + r7 - r8;
      f[5] = r5 - r7 - r9;
    }

   private:
    P _k9;
  };
};

TEST(HopfOfNetworks, ASlowOneBesideAFastDecay) {
  systems::Bound bound = systems::bound_to(Network::info(), {}, {});
  bound.scalars.free = {"k9"};
  const auto whole = systems::recorded<Network>(bound);
  const std::vector<double> state{1.6563516576558746,    352329753.92793924,     1.0,
                                  0.0038843824790898043, 3.7708607296986027e-10, 0.08021161610521155};
  const std::vector<systems::LinearTotal> totals = systems::linear_totals(*whole);
  ASSERT_EQ(totals.size(), 2U);
  const auto system = systems::without_totals(whole, totals, {.values = {}, .place = state, .moving = bound.scalars});
  std::vector<double> start = systems::reduced_state(*system, state);
  systems::Scales scales = natural_scales(*system, {{start[0]}, {start[1]}, {start[2]}, {start[3]}});
  EXPECT_GT(scales.time, 10.0);  // of the oscillation, some hundreds, not of the decay
  scales.parameters = {0x1p-11};
  for (std::size_t i = 0; i < start.size(); ++i) start[i] /= scales.coordinate(i);
  const EquilibriumCurve curve = follow_equilibrium(
      *systems::scaled(system, scales), start, {.parameter_from = 0.0004 / 0x1p-11, .parameter_to = 0.0007 / 0x1p-11});
  ASSERT_EQ(curve.hopf.size(), 1U);
  EXPECT_NEAR(curve.hopf[0].at.parameter * 0x1p-11, 5.160737862e-4, 1e-12);
  EXPECT_NEAR(curve.hopf[0].period * scales.time, 1945.34, 0.01);
  for (const EquilibriumPoint& point : curve.points) {
    EXPECT_NE(point.kind, EquilibriumKind::branch_point);
    EXPECT_FALSE(point.may_branch_before || point.may_pass_before);
  }
}

/// Susceptible, infected and recovered with the incidence S I^2 (Liu, Levin, Iwasa 1986, doi:10.1007/BF00276956):
/// recovery v = 1, births and deaths m = 0.02, loss of immunity w = 0.1. At the equilibrium S I = v + m and
/// R = v I/(w + m); the trace of what is left beside the population, v - w - I^2, is 0 at the Hopf point, and the
/// determinant v (v - w) - (w + m)^2.
class Epidemic {
 public:
  static constexpr int dimension = 3;
  static constexpr int quantities = 0;
  static systems::ModelInfo info() { return test::described("epidemic", "an epidemic", {"S", "I", "R"}); }
  static systems::Structure structure(const systems::Bound&) { return test::dissipative_structure(dimension); }
  template <class P>
  class With {
   public:
    explicit With(const systems::BoundTo<P>&) {}
    template <class S>
    void field(const S* z, S* f) const {
      const S infected = z[0] * z[1] * z[1];
      f[0] = (z[1] + z[2]) * 0.02 - infected + z[2] * 0.1;
      f[1] = infected - z[1] * 1.02;
      f[2] = z[1] - z[2] * 0.12;
    }
  };
};

TEST(HopfOfNetworks, InTheSizeOfAPopulation) {
  const auto whole = systems::recorded<Epidemic>(systems::bound_to(Epidemic::info(), {}, {}));
  const std::vector<double> state{1.02, 1.0, 1.0 / 0.12};
  const auto system = systems::without_totals(
      whole, systems::linear_totals(*whole),
      {.values = {}, .place = state, .moving = {.free = {"total_S"}, .hold = systems::FamilyScalars::Hold::nothing}});
  const EquilibriumCurve curve = follow_equilibrium(*system, systems::reduced_state(*system, state),
                                                    {.parameter_from = 9.0, .parameter_to = 11.0});
  ASSERT_EQ(curve.hopf.size(), 1U);
  const double infected = std::sqrt(0.9);
  EXPECT_NEAR(curve.hopf[0].at.parameter, 1.02 / infected + infected * (1.0 + 1.0 / 0.12), 1e-11);
  EXPECT_NEAR(curve.hopf[0].period, 2.0 * std::numbers::pi / std::sqrt(0.9 - 0.0144), 1e-10);
}

}  // namespace
}  // namespace orbweaver::starts::hopf_of_networks_test
