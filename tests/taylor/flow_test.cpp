#include "orbweaver/taylor/flow.hpp"

#include <cmath>
#include <memory>

#include <gtest/gtest.h>

#include "orbweaver/core/error.hpp"
#include "orbweaver/model/evaluate.hpp"
#include "orbweaver/systems/registry.hpp"
#include "orbweaver/systems/system.hpp"

namespace orbweaver::taylor::flow_test {
namespace {

using numerics::Extended;
using numerics::WorkingDigits;

systems::Formulas formulas_of(const std::string& name, const std::map<std::string, double>& parameters = {}) {
  const auto system = systems::make_system(name, parameters);
  return dynamic_cast<const systems::FormulaSystem&>(*system).formulas();
}

template <class Real>
std::vector<Real> parameters_of(const systems::Formulas& formulas) {
  std::vector<Real> values;
  for (const double value : formulas.values) values.push_back(Real(value));
  return values;
}

std::vector<Extended> identity(std::size_t d) {
  std::vector<Extended> matrix(d * d);
  for (std::size_t i = 0; i < d; ++i) matrix[i * d + i] = 1;
  return matrix;
}

// q = cos(omega t), p = -omega sin(omega t).
TEST(Flow, FollowsTheHarmonicOscillatorToAnyNumberOfDigits) {
  const systems::Formulas formulas = formulas_of("harmonic_oscillator", {{"omega", 2.0}});
  for (const int digits : {20, 50, 120}) {
    const WorkingDigits working(digits + 10);
    Flow<Extended> flow(formulas, parameters_of<Extended>(formulas), {.digits = static_cast<double>(digits)});
    std::vector<Extended> state{Extended(1), Extended(0)};
    std::vector<Extended> transitions = identity(2);
    const Extended time = Extended(31) / 10;
    flow.advance(state, transitions, time);
    EXPECT_LT(numerics::log10_abs(state[0] - cos(2 * time)), -digits + 1) << digits;
    EXPECT_LT(numerics::log10_abs(state[1] + 2 * sin(2 * time)), -digits + 1) << digits;
    EXPECT_LT(numerics::log10_abs(transitions[1] - sin(2 * time) / 2), -digits + 1) << digits;
    flow.advance(state, -time);
    EXPECT_LT(numerics::log10_abs(state[0] - 1), -digits + 1) << digits;
  }
}

// One step of order p over h: the error falls by 2^(p + 1) when h is halved.
TEST(Flow, HasTheOrderThatItSays) {
  const WorkingDigits working(60);
  const systems::Formulas formulas = formulas_of("double_pendulum");
  const std::vector<Extended> parameters = parameters_of<Extended>(formulas);
  const std::vector<Extended> start{Extended(1), Extended(0.5), Extended(0.3), Extended(-0.2)};
  Flow<Extended> exact(formulas, parameters, {.digits = 50.0});
  for (const int extra : {0, 3}) {
    double errors[2];
    for (int n = 0; n < 2; ++n) {
      const Extended h = Extended(1) / (20 << n);
      Flow<Extended> flow(formulas, parameters, {.digits = 3.0, .extra_order = extra});  // a step is longer than h
      std::vector<Extended> a = start;
      std::vector<Extended> b = start;
      flow.advance(a, h);
      exact.advance(b, h);
      ASSERT_EQ(flow.steps(), 1);
      errors[n] = numerics::log10_abs(a[2] - b[2]) / std::log10(2.0);
    }
    EXPECT_NEAR(errors[0] - errors[1], 4.0 + extra + 1.0, 0.3) << extra;
  }
}

// Phi(t) against differences of the flow, the energy, and double against extended.
TEST(Flow, CarriesTransitionsAndKeepsTheEnergy) {
  for (const std::string name : {"double_pendulum", "henon_heiles", "swinging_spring", "pcr3bp"}) {
    const systems::Formulas formulas = formulas_of(name);
    const WorkingDigits working(50);
    const std::vector<Extended> parameters = parameters_of<Extended>(formulas);
    const std::vector<Extended> start{Extended(0.3), Extended(-0.4), Extended(0.1), Extended(0.2)};
    Flow<Extended> flow(formulas, parameters, {.digits = 40.0});
    std::vector<Extended> end = start;
    std::vector<Extended> transitions = identity(4);
    flow.advance(end, transitions, Extended(0.7));
    const auto energy = [&](const std::vector<Extended>& z) {
      return model::evaluate<Extended>(formulas.graph, formulas.conserved, z, parameters).front();
    };
    EXPECT_LT(numerics::log10_abs(energy(end) - energy(start)), -38.0) << name;
    const Extended h = numerics::extended_of("1e-12");
    for (std::size_t c = 0; c < 4; ++c) {
      std::vector<Extended> plus = start;
      std::vector<Extended> minus = start;
      plus[c] += h;
      minus[c] -= h;
      flow.advance(plus, Extended(0.7));
      flow.advance(minus, Extended(0.7));
      for (std::size_t i = 0; i < 4; ++i)
        EXPECT_LT(numerics::log10_abs((plus[i] - minus[i]) / (2 * h) - transitions[i * 4 + c]), -19.0) << name;
    }
    std::vector<double> narrow{0.3, -0.4, 0.1, 0.2};
    Flow<double> in_double(formulas, formulas.values, {});
    in_double.advance(narrow, 0.7);
    for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(narrow[i], static_cast<double>(end[i]), 1e-13) << name;
  }
}

// The energy of Henon and Heiles has a third in it, which no double is.
TEST(Flow, ReadsConstantsExactly) {
  const WorkingDigits working(50);
  const systems::Formulas formulas = formulas_of("henon_heiles");
  const std::vector<Extended> z{Extended(0), Extended(1), Extended(0), Extended(0)};
  const Extended energy = model::evaluate<Extended>(formulas.graph, formulas.conserved, z, {}).front();
  EXPECT_LT(numerics::log10_abs(energy - Extended(1) / 6), -49.0);
}

TEST(ManyFlows, EndWhereEachFlowEnds) {
  for (const char* name : {"double_pendulum", "henon_heiles"}) {
    const systems::Formulas formulas = formulas_of(name);
    Flow<double> one(formulas, formulas.values, {});
    ManyFlows many(formulas);
    for (const double time : {5.0, -0.3}) {
      std::vector<std::vector<double>> states;
      for (int n = 0; n < 7; ++n) states.push_back({0.02 * n, 0.1, -0.03 * n, 0.2});  // no full register at the end
      std::vector<std::vector<double>> ends = states;
      many.advance(ends, time);
      for (std::size_t n = 0; n < states.size(); ++n) {
        one.advance(states[n], time);
        for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(ends[n][i], states[n][i], 1e-13) << name << n;
        std::vector<std::vector<double>> alone{
            {0.02 * static_cast<double>(n), 0.1, -0.03 * static_cast<double>(n), 0.2}};
        many.advance(alone, time);
        EXPECT_EQ(alone.front(), ends[n]) << "beside no other states";
      }
    }
  }
}

TEST(ManyFlows, SayWhereThereIsNoSolution) {
  ManyFlows many(formulas_of("pcr3bp", {{"mu", 0.5}}));
  std::vector<std::vector<double>> falls{{0.0, 1.0, 0.0, 0.0}, {0.5 + 1e-3, 0.0, 0.0, 0.0}};
  EXPECT_THROW(many.advance(falls, 1.0), core::NumericalError);
}

TEST(Flow, SaysWhereThereIsNoSolution) {
  const systems::Formulas formulas = formulas_of("pcr3bp", {{"mu", 0.5}});
  Flow<double> flow(formulas, formulas.values, {});
  std::vector<double> falls{0.5 + 1e-3, 0.0, 0.0, 0.0};
  EXPECT_THROW(flow.advance(falls, 1.0), core::NumericalError);
  Flow<double> impatient(formulas, formulas.values, {.most_steps = 2});
  std::vector<double> far{0.0, 1.0, 0.0, 0.0};
  EXPECT_THROW(impatient.advance(far, 10.0), core::NumericalError);
  std::vector<double> wrong(3);
  EXPECT_THROW(flow.advance(wrong, 1.0), core::MisuseError);
}

}  // namespace
}  // namespace orbweaver::taylor::flow_test
