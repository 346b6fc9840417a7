#include "orbweaver/starts/equilibrium_curve.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "orbweaver/core/error.hpp"
#include "orbweaver/systems/recorded_model.hpp"
#include "support/described.hpp"
#include "support/lorenz_equations.hpp"
#include "support/van_der_pol.hpp"

namespace orbweaver::starts::equilibrium_curve_test {
namespace {

/// With sigma = 10, beta = 8/3: Hopf points at rho = sigma (sigma + beta + 3)/(sigma - beta - 1) = 470/19, with
/// omega^2 = 2 sigma (sigma + 1) beta/(sigma - beta - 1); the two equilibria leave the origin at rho = 1.
constexpr double hopf_rho = 470.0 / 19.0;
const double hopf_period =
    2.0 * std::numbers::pi / std::sqrt(2.0 * 10.0 * 11.0 * (8.0 / 3.0) / (10.0 - 8.0 / 3.0 - 1.0));

TEST(EquilibriumCurve, OfLorenzHasTheKnownHopfPoint) {
  const test::LorenzEquations system(20.0);
  const double x = std::sqrt(8.0 / 3.0 * 19.0);
  const EquilibriumCurve curve =
      follow_equilibrium(system, std::vector<double>{x, x, 19.0}, {.parameter_from = 1.5, .parameter_to = 30.0});
  ASSERT_EQ(curve.hopf.size(), 1U);
  EXPECT_NEAR(curve.hopf[0].at.parameter, hopf_rho, 1e-11);
  EXPECT_NEAR(curve.hopf[0].period, hopf_period, 1e-11);
  EXPECT_TRUE(curve.hopf[0].isotropy.empty());
  EXPECT_THAT(curve.ends, ::testing::ElementsAre(::testing::HasSubstr("rho = 1.5"), ::testing::HasSubstr("rho = 30")));
  EXPECT_NEAR(curve.points.back().at.state[2], 29.0, 1e-10);
}

TEST(EquilibriumCurve, ThroughThePitchforkTurnsOnTheOtherSide) {
  // x = y = +-sqrt(beta (rho - 1)): one curve, whose rho turns at 1 at the origin.
  const test::LorenzEquations system(20.0);
  const double x = std::sqrt(8.0 / 3.0 * 19.0);
  const EquilibriumCurve curve =
      follow_equilibrium(system, std::vector<double>{x, x, 19.0}, {.parameter_from = 0.0, .parameter_to = 25.0});
  ASSERT_EQ(curve.folds.size(), 1U);
  EXPECT_NEAR(curve.folds[0].parameter, 1.0, 1e-10);
  EXPECT_NEAR(curve.folds[0].state[0], 0.0, 1e-5);
  EXPECT_EQ(curve.hopf.size(), 2U);  // one on each side
}

std::vector<EquilibriumPoint> branch_points(const EquilibriumCurve& curve) {
  std::vector<EquilibriumPoint> found;
  for (const EquilibriumPoint& point : curve.points)
    if (point.kind == EquilibriumKind::branch_point) found.push_back(point);
  return found;
}

TEST(EquilibriumCurve, KnowsWhereTheOtherCurveOfAPitchforkPasses) {
  const auto origin = [](double rho) {  // from 0.5 on a step ends at the branch point itself
    return follow_equilibrium(test::LorenzEquations(rho), std::vector<double>(3, 0.0),
                              {.parameter_from = 0.0, .parameter_to = 25.0});
  };
  const EquilibriumCurve through = origin(0.5);
  const EquilibriumCurve past = origin(0.53);
  EXPECT_TRUE(through.folds.empty());
  const double x = std::sqrt(8.0 / 3.0 * 19.0);
  const EquilibriumCurve beside = follow_equilibrium(test::LorenzEquations(20.0), std::vector<double>{x, x, 19.0},
                                                     {.parameter_from = 0.0, .parameter_to = 25.0});
  for (const EquilibriumCurve* curve : {&through, &past, &beside}) {
    const std::vector<EquilibriumPoint> found = branch_points(*curve);
    ASSERT_EQ(found.size(), 1U);
    EXPECT_NEAR(found[0].at.parameter, 1.0, 1e-9);
    for (const double z : found[0].at.state) EXPECT_NEAR(z, 0.0, 1e-5);
  }
}

/// x' = m x - x^3 and y' = m y - y^3: two eigenvalues pass zero at once, where the determinant keeps its sign.
class TwoPitchforks {
 public:
  static constexpr int dimension = 2;
  static constexpr int quantities = 0;
  static systems::ModelInfo info() {
    return test::described("two_pitchforks", "two pitchforks at once", {"x", "y"}, {"m"}, 0.0);
  }
  static systems::Structure structure(const systems::Bound&) { return test::dissipative_structure(dimension); }
  template <class P>
  class With {
   public:
    explicit With(const systems::BoundTo<P>& bound) : _m(bound["m"]) {}
    template <class S>
    void field(const S* z, S* f) const {
      f[0] = z[0] * _m - z[0] * z[0] * z[0];
      f[1] = z[1] * _m - z[1] * z[1] * z[1];
    }

   private:
    P _m;
  };
};

TEST(EquilibriumCurve, KnowsABranchPointAtWhichTwoEigenvaluesPassZero) {
  for (const double start : {-0.37, -0.43, -0.5}) {
    systems::Bound bound = systems::bound_to(TwoPitchforks::info(), {{"m", start}}, {});
    bound.scalars.free = {"m"};
    const EquilibriumCurve curve =
        follow_equilibrium(*systems::recorded<TwoPitchforks>(bound), std::vector<double>(2, 0.0),
                           {.parameter_from = -1.0, .parameter_to = 1.0});
    const std::vector<EquilibriumPoint> found = branch_points(curve);
    ASSERT_EQ(found.size(), 1U) << start;
    EXPECT_NEAR(found[0].at.parameter, 0.0, 1e-12);
  }
}

/// Of x' = g(m) x - x^3 in each coordinate: a branch point where a g is zero. The coordinates are o + u x.
template <class Rates>
class Pitchforks {
 public:
  static constexpr int dimension = Rates::count;
  static constexpr int quantities = 0;
  static systems::ModelInfo info() {
    std::vector<std::string> names;
    for (int i = 0; i < dimension; ++i) names.push_back(fmt::format("x{}", i));
    return test::described("pitchforks", "pitchforks of one curve", names, {"m", "a", "b", "c", "o", "u"}, 0.0);
  }
  static systems::Structure structure(const systems::Bound&) { return test::dissipative_structure(dimension); }
  template <class P>
  class With {
   public:
    explicit With(const systems::BoundTo<P>& bound)
        : _m(bound["m"]), _zeros{bound["a"], bound["b"], bound["c"]}, _o(bound["o"]), _u(bound["u"]) {}
    template <class S>
    void field(const S* z, S* f) const {
      const auto rates = Rates::of(_m, _zeros);
      for (int i = 0; i < dimension; ++i) {
        const S x = (z[i] - _o) / _u;
        f[i] = (x * rates[static_cast<std::size_t>(i)] - x * x * x) * _u;
      }
    }

   private:
    P _m;
    std::array<P, 3> _zeros;
    P _o, _u;
  };
};

struct OfThree {
  static constexpr int count = 3;
  template <class P>
  static std::array<P, 3> of(const P& m, const std::array<P, 3>& zeros) {
    return {m - zeros[0], (m - zeros[1]) * 40.0, m - zeros[2]};
  }
};

struct ForthAndBack {
  static constexpr int count = 1;
  template <class P>
  static std::array<P, 1> of(const P& m, const std::array<P, 3>& zeros) {
    return {(m - zeros[0]) * (m - zeros[1])};
  }
};

struct InTurn {
  static constexpr int count = 2;
  template <class P>
  static std::array<P, 2> of(const P& m, const std::array<P, 3>& zeros) {
    return {m - zeros[0], zeros[1] - m};
  }
};

/// The rate changes its sign by a pole.
struct OfAPole {
  static constexpr int count = 1;
  template <class P>
  static std::array<P, 1> of(const P& m, const std::array<P, 3>& zeros) {
    return {1e-3 / (m - zeros[0])};
  }
};

template <class Rates>
EquilibriumCurve of_pitchforks(double start, std::array<double, 3> zeros, double offset = 0.0, double unit = 1.0) {
  systems::Bound bound = systems::bound_to(
      Pitchforks<Rates>::info(),
      {{"m", start}, {"a", zeros[0]}, {"b", zeros[1]}, {"c", zeros[2]}, {"o", offset}, {"u", unit}}, {});
  bound.scalars.free = {"m"};
  return follow_equilibrium(*systems::recorded<Pitchforks<Rates>>(bound), std::vector<double>(Rates::count, offset),
                            {.parameter_from = -1.0, .parameter_to = 1.0});
}

std::vector<double> branching_parameters(const EquilibriumCurve& curve) {
  std::vector<double> found;
  for (const EquilibriumPoint& point : branch_points(curve)) found.push_back(point.at.parameter);
  for (const EquilibriumPoint& point : curve.points) EXPECT_FALSE(point.may_branch_before);
  return found;
}

TEST(EquilibriumCurve, SeveralBranchPointsWithinOneStepAreFound) {
  using ::testing::DoubleNear;
  for (const double start : {-0.5, -0.43, -0.2, 0.0, 0.02})
    for (const auto& [offset, unit] :
         {std::pair(0.0, 1.0), std::pair(0.0, 1e3), std::pair(0.0, 1e-3), std::pair(1e6, 1.0), std::pair(-3e3, 1.0)}) {
      SCOPED_TRACE(fmt::format("{} {} {}", start, offset, unit));
      const auto found = [&](double a, double b, double c) {
        return branching_parameters(of_pitchforks<OfThree>(start, {a, b, c}, offset, unit));
      };
      const auto near = [](double at) { return DoubleNear(at, 1e-9); };
      EXPECT_THAT(found(0.01, 0.03, 0.5), ::testing::ElementsAre(near(0.01), near(0.03), near(0.5)));
      EXPECT_THAT(found(0.012, 0.06, 0.01), ::testing::ElementsAre(near(0.01), near(0.012), near(0.06)));
      EXPECT_THAT(found(0.01, 0.01, 0.03), ::testing::ElementsAre(near(0.01), near(0.03)));
      EXPECT_THAT(found(0.0, 0.0, 0.0), ::testing::ElementsAre(near(0.0)));
      if (std::abs(offset) > 1e5) continue;
      EXPECT_THAT(found(0.01 + 1e-6, 0.01, 0.5), ::testing::ElementsAre(near(0.01), near(0.01 + 1e-6), near(0.5)));
    }
}

TEST(EquilibriumCurve, BranchPointsWhoseSignsCancelAreFound) {
  for (const double start : {-0.5, -0.43, -0.2, 0.0}) {
    SCOPED_TRACE(start);
    const auto found = ::testing::ElementsAre(::testing::DoubleNear(0.01, 1e-9), ::testing::DoubleNear(0.03, 1e-9));
    EXPECT_THAT(branching_parameters(of_pitchforks<ForthAndBack>(start, {0.01, 0.03, 0.0})), found);
    EXPECT_THAT(branching_parameters(of_pitchforks<InTurn>(start, {0.01, 0.03, 0.0})), found);
  }
}

TEST(EquilibriumCurve, ASignThatChangesWithoutAZeroIsUndecided) {
  const EquilibriumCurve curve = of_pitchforks<OfAPole>(-0.5, {0.0123, 0.0, 0.0});
  EXPECT_TRUE(branch_points(curve).empty());
  EXPECT_EQ(std::count_if(curve.points.begin(), curve.points.end(),
                          [](const EquilibriumPoint& point) { return point.may_branch_before; }),
            1);
}

/// x_i' = m x_i - x_i^3 + x_{i-1} - 2 x_i + x_{i+1} between walls: branch points at m = 2 - 2 cos(pi k/(d + 1)).
class Lattice {
 public:
  static constexpr int dimension = 60;
  static constexpr int quantities = 0;
  static systems::ModelInfo info() {
    std::vector<std::string> names;
    for (int i = 0; i < dimension; ++i) names.push_back(fmt::format("x{}", i));
    return test::described("lattice", "a lattice of pitchforks", names, {"m"}, 0.0);
  }
  static systems::Structure structure(const systems::Bound&) { return test::dissipative_structure(dimension); }
  template <class P>
  class With {
   public:
    explicit With(const systems::BoundTo<P>& bound) : _m(bound["m"]) {}
    template <class S>
    void field(const S* z, S* f) const {
      for (int i = 0; i < dimension; ++i) {
        f[i] = z[i] * (_m - 2.0) - z[i] * z[i] * z[i];
        if (i > 0) f[i] = f[i] + z[i - 1];
        if (i + 1 < dimension) f[i] = f[i] + z[i + 1];
      }
    }

   private:
    P _m;
  };
};

TEST(EquilibriumCurve, BranchPointsInManyDimensionsAreFound) {
  for (const double start : {-0.3, 0.0}) {
    systems::Bound bound = systems::bound_to(Lattice::info(), {{"m", start}}, {});
    bound.scalars.free = {"m"};
    const EquilibriumCurve curve =
        follow_equilibrium(*systems::recorded<Lattice>(bound), std::vector<double>(Lattice::dimension, 0.0),
                           {.parameter_from = -0.5, .parameter_to = 0.7});
    const std::vector<double> found = branching_parameters(curve);
    ASSERT_EQ(found.size(), 16U);
    for (std::size_t k = 1; k <= found.size(); ++k)
      EXPECT_NEAR(found[k - 1], 2.0 - 2.0 * std::cos(std::numbers::pi * static_cast<double>(k) / 61.0), 1e-9);
  }
}

/// x' = m - x^2, which turns at x = 0, and y' = (x - 0.03) (x + 0.04) y - y^3.
class FoldBetweenPitchforks {
 public:
  static constexpr int dimension = 2;
  static constexpr int quantities = 0;
  static systems::ModelInfo info() {
    return test::described("fold_between", "a fold between two branch points", {"x", "y"}, {"m"}, 0.0);
  }
  static systems::Structure structure(const systems::Bound&) { return test::dissipative_structure(dimension); }
  template <class P>
  class With {
   public:
    explicit With(const systems::BoundTo<P>& bound) : _m(bound["m"]) {}
    template <class S>
    void field(const S* z, S* f) const {
      f[0] = -z[0] * z[0] + _m;
      f[1] = (z[0] - 0.03) * (z[0] + 0.04) * z[1] - z[1] * z[1] * z[1];
    }

   private:
    P _m;
  };
};

TEST(EquilibriumCurve, AFoldBetweenBranchPointsWithinOneStepIsFoundWithThem) {
  for (const double start : {0.25, 0.3, 0.35, 0.4}) {
    SCOPED_TRACE(start);
    systems::Bound bound = systems::bound_to(FoldBetweenPitchforks::info(), {{"m", start}}, {});
    bound.scalars.free = {"m"};
    const EquilibriumCurve curve =
        follow_equilibrium(*systems::recorded<FoldBetweenPitchforks>(bound), std::vector<double>{std::sqrt(start), 0.0},
                           {.parameter_from = -1.0, .parameter_to = 1.0});
    ASSERT_EQ(curve.folds.size(), 1U);
    EXPECT_NEAR(curve.folds[0].state[0], 0.0, 1e-7);
    EXPECT_THAT(branching_parameters(curve), ::testing::UnorderedElementsAre(::testing::DoubleNear(0.0009, 1e-9),
                                                                             ::testing::DoubleNear(0.0016, 1e-9)));
  }
}

TEST(EquilibriumCurve, OfVanDerPolHasItsHopfPointAtZero) {
  const test::VanDerPol system(-0.5, {{"mu"}, {}});
  const EquilibriumCurve curve =
      follow_equilibrium(system, std::vector<double>{0.0, 0.0}, {.parameter_from = -1.0, .parameter_to = 1.0});
  ASSERT_EQ(curve.hopf.size(), 1U);
  EXPECT_TRUE(branch_points(curve).empty());
  EXPECT_NEAR(curve.hopf[0].at.parameter, 0.0, 1e-12);
  EXPECT_NEAR(curve.hopf[0].period, 2.0 * std::numbers::pi, 1e-12);
}

/// Two oscillators with eigenvalues m - m_n +- i w_n, the second of which pushes the first.
class TwoOscillators {
 public:
  static constexpr int dimension = 4;
  static constexpr int quantities = 0;
  static systems::ModelInfo info() {
    return test::described("two_oscillators", "two oscillators, the first pushed by the second", {"x", "u", "y", "v"},
                           {"m", "m1", "m2", "w1", "w2"}, 0.0);
  }
  static systems::Structure structure(const systems::Bound&) { return test::dissipative_structure(dimension); }
  template <class P>
  class With {
   public:
    explicit With(const systems::BoundTo<P>& bound)
        : _m(bound["m"]), _m1(bound["m1"]), _m2(bound["m2"]), _w1(bound["w1"]), _w2(bound["w2"]) {}
    template <class S>
    void field(const S* z, S* f) const {
      f[0] = z[0] * (_m - _m1) - z[1] * _w1 + z[2] * z[2];
      f[1] = z[0] * _w1 + z[1] * (_m - _m1) + z[2] * 0.1;
      f[2] = z[2] * (_m - _m2) - z[3] * _w2;
      f[3] = z[2] * _w2 + z[3] * (_m - _m2) - z[3] * z[3] * z[3];
    }

   private:
    P _m, _m1, _m2, _w1, _w2;
  };
};

// Both within one step of the curve, or at one place: two changes of the product of all sums of eigenvalues cancel.
TEST(EquilibriumCurve, TwoHopfPointsWithinOneStepAreFound) {
  for (const double start : {-0.37, -0.43, -0.5, -0.05})
    for (const auto& [m1, m2] : {std::pair(3.5e-5, 0.04997), std::pair(0.0, 0.0), std::pair(0.01, 0.01 + 1e-7)}) {
      SCOPED_TRACE(fmt::format("{} {}", start, m2));
      systems::Bound bound = systems::bound_to(TwoOscillators::info(),
                                               {{"m", start}, {"m1", m1}, {"m2", m2}, {"w1", 1.0}, {"w2", 1.7}}, {});
      bound.scalars.free = {"m"};
      const auto system = systems::recorded<TwoOscillators>(bound);
      const EquilibriumCurve curve =
          follow_equilibrium(*system, std::vector<double>(4, 0.0), {.parameter_from = -1.0, .parameter_to = 1.0});
      ASSERT_EQ(curve.hopf.size(), 2U);
      EXPECT_NEAR(curve.hopf[0].at.parameter, m1, 1e-12);
      EXPECT_NEAR(curve.hopf[1].at.parameter, m2, 1e-12);
      EXPECT_NEAR(curve.hopf[0].period, 2.0 * std::numbers::pi, 1e-11);
      EXPECT_NEAR(curve.hopf[1].period, 2.0 * std::numbers::pi / 1.7, 1e-11);
    }
}

/// u' = e (m u - v) + w - u, v' = e (u + m v), w' = K (u - w): with w = K u/(K + l) the characteristic equation is
/// (l (1 + 1/(K + l)) - e m) (l - e m) + e^2 = 0, a Hopf point at m = 0 with the period 2 pi/e to 1/K, beside -K.
class BesideAFastDecay {
 public:
  static constexpr int dimension = 3;
  static constexpr int quantities = 0;
  static systems::ModelInfo info() {
    return test::described("beside_a_fast_decay", "a slow oscillation beside a fast decay", {"u", "v", "w"}, {"m"},
                           0.0);
  }
  static systems::Structure structure(const systems::Bound&) { return test::dissipative_structure(dimension); }
  template <class P>
  class With {
   public:
    explicit With(const systems::BoundTo<P>& bound) : _m(bound["m"]) {}
    template <class S>
    void field(const S* z, S* f) const {
      f[0] = (z[0] * _m - z[1]) * 1e-3 + (z[2] - z[0]);
      f[1] = (z[0] + z[1] * _m) * 1e-3;
      f[2] = (z[0] - z[2]) * 1e12;
    }

   private:
    P _m;
  };
};

TEST(EquilibriumCurve, HasAHopfPointBesideAFastDecay) {
  for (const double start : {-0.37, -0.43, 0.05}) {
    systems::Bound bound = systems::bound_to(BesideAFastDecay::info(), {{"m", start}}, {});
    bound.scalars.free = {"m"};
    const EquilibriumCurve curve =
        follow_equilibrium(*systems::recorded<BesideAFastDecay>(bound), std::vector<double>(3, 0.0),
                           {.parameter_from = -1.0, .parameter_to = 1.0});
    ASSERT_EQ(curve.hopf.size(), 1U) << start;
    EXPECT_NEAR(curve.hopf[0].at.parameter, 0.0, 1e-9);
    EXPECT_NEAR(curve.hopf[0].period, 2e3 * std::numbers::pi, 1e-6);
    EXPECT_THAT(branch_points(curve), ::testing::IsEmpty());
    for (const EquilibriumPoint& point : curve.points) EXPECT_FALSE(point.may_branch_before || point.may_pass_before);
  }
}

/// Lotka and Volterra's equations: x' = x (a - y), y' = y (x - 1), a centre at (1, a) for all a.
class LotkaVolterra {
 public:
  static constexpr int dimension = 2;
  static constexpr int quantities = 0;
  static systems::ModelInfo info() { return test::described("lotka", "hares and lynxes", {"x", "y"}, {"a"}); }
  static systems::Structure structure(const systems::Bound&) { return test::dissipative_structure(dimension); }
  template <class P>
  class With {
   public:
    explicit With(const systems::BoundTo<P>& bound) : _a(bound["a"]) {}
    template <class S>
    void field(const S* z, S* f) const {
      f[0] = z[0] * (_a - z[1]);
      f[1] = z[1] * (z[0] - 1.0);
    }

   private:
    P _a;
  };
};

TEST(EquilibriumCurve, OfCentresHasNoHopfPoint) {
  systems::Bound bound = systems::bound_to(LotkaVolterra::info(), {}, {});
  bound.scalars.free = {"a"};
  const auto system = systems::recorded<LotkaVolterra>(bound);
  const EquilibriumCurve curve =
      follow_equilibrium(*system, std::vector<double>{1.0, 1.0}, {.parameter_from = 0.5, .parameter_to = 2.0});
  EXPECT_THAT(curve.hopf, ::testing::IsEmpty());
  EXPECT_TRUE(std::isfinite(curve.stays));
  EXPECT_TRUE(std::isnan(follow_equilibrium(test::LorenzEquations(20.0), std::vector<double>(3, 0.0),
                                            {.parameter_from = 0.0, .parameter_to = 25.0})
                             .stays));
  // Left for its length it says so; far out steps are longer, and its length is none.
  const EquilibriumCurve cut = follow_equilibrium(*system, std::vector<double>{1.0, 1.0},
                                                  {.parameter_from = 0.5, .parameter_to = 2.0, .most_points = 3});
  EXPECT_THAT(cut.are_cut, ::testing::ElementsAre(true, true));
  const EquilibriumCurve far =
      follow_equilibrium(*system, std::vector<double>{1.0, 1.0}, {.parameter_from = 0.5, .parameter_to = 1e5});
  EXPECT_THAT(far.are_cut, ::testing::ElementsAre(false, false));
  EXPECT_LT(far.points.size(), 2000U);
}

TEST(EquilibriumCurve, NeedsAParameterThatMovesAndAnEquilibrium) {
  EXPECT_THROW(static_cast<void>(follow_equilibrium(test::VanDerPol(0.5), std::vector<double>{0.0, 0.0})),
               core::MisuseError);
}

}  // namespace
}  // namespace orbweaver::starts::equilibrium_curve_test
