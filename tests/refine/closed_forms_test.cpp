#include <cmath>
#include <map>
#include <numbers>

#include <gmock/gmock.h>

#include "orbweaver/core/error.hpp"
#include "orbweaver/loop/symmetry/isotropy_text.hpp"
#include "orbweaver/refine/orbit.hpp"
#include "orbweaver/systems/registry.hpp"
#include "support/stated_system.hpp"

namespace orbweaver::refine::closed_forms_test {
namespace {

using numerics::Extended;
using numerics::extended_of;
using numerics::WorkingDigits;
using Quantity = HeldValue::Quantity;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

constexpr int checked_digits = 80;  // of the closed forms

Extended pi() { return acos(Extended(-1)); }

/// A guess with the first harmonics alone: a_0, a_1 and b_1 of each coordinate.
Guess guess_of(const std::shared_ptr<const systems::System>& system, double period, std::vector<double> mean,
               const std::vector<double>& cosine, const std::vector<double>& sine, const std::string& isotropy) {
  loop::Loop loop = loop::constant_loop(mean, period, 8);
  for (std::size_t i = 0; i < cosine.size(); ++i) {
    loop.cosine(1, static_cast<int>(i)) = cosine[i];
    loop.sine(1, static_cast<int>(i)) = sine[i];
  }
  return {system, {}, loop, loop::isotropy_of(system->structure(), isotropy)};
}

/// What the number is off, in digits; its bound must hold.
void expect_value(const Number& number, const Extended& exact, int digits, const char* what) {
  const Extended error = abs(Extended(number.value - exact));
  EXPECT_LT(numerics::log10_abs(error), numerics::log10_abs(exact) - digits) << what;
  EXPECT_LE(error, number.error + pow(Extended(10), -checked_digits + 3)) << what;
}

// q = A cos(omega t): T = 2 pi / omega whatever the energy.
TEST(RefineOrbit, FindsThePeriodOfTheHarmonicOscillator) {
  const auto system = systems::make_system("harmonic_oscillator", {{"omega", 0.1}});
  for (const std::string isotropy : {"S@1/2 R@0", "R@0", "S@1/2", ""}) {
    const RefinedOrbit orbit = refine_orbit(guess_of(system, 62.0, {0.0, 0.0}, {1.1, 0.0}, {0.0, -0.11}, isotropy),
                                            {Quantity::energy, "0.005"}, 60);
    const WorkingDigits working(checked_digits);
    expect_value(orbit.period, 20 * pi(), 60, "period");  // omega is the decimal 0.1, not the double next to it
    expect_value(orbit.state[0], Extended(1), 60, "q");
    EXPECT_LT(numerics::log10_abs(orbit.state[1].value), -60.0);
    EXPECT_EQ(orbit.energy->error, 0);
    EXPECT_FALSE(orbit.index.has_value());
    EXPECT_EQ(orbit.reversor, isotropy.find('R') == std::string::npos ? "" : "R");
  }
}

// All of its orbits have one period: that does not pick one.
TEST(RefineOrbit, SaysWhereAPeriodDoesNotPickAnOrbit) {
  const auto system = systems::make_system("harmonic_oscillator");
  const Guess guess = guess_of(system, 2.0 * std::numbers::pi, {0.0, 0.0}, {1.1, 0.0}, {0.0, -1.1}, "S@1/2 R@0");
  // With another period there is the equilibrium alone.
  EXPECT_THAT(
      [&] {
        static_cast<void>(refine_orbit(guess, {Quantity::period, "6.28"}, 20));
      },
      ThrowsMessage<core::NumericalError>(HasSubstr("away from the guess")));
  EXPECT_THAT(
      [&] {
        static_cast<void>(refine_orbit(guess, {Quantity::period, "6.283185307179586"}, 20));
      },
      ThrowsMessage<core::NumericalError>(HasSubstr("not isolated")));
  EXPECT_EQ(better_held(guess), Quantity::energy);
}

// The swinging spring bouncing: T = 2 pi sqrt(m/k), kept by S at every instant.
TEST(RefineOrbit, FindsTheBounceOfTheSpring) {
  const auto system = systems::make_system("swinging_spring");
  const Guess guess =
      guess_of(system, 3.6, {0.0, -1.3, 0.0, 0.0}, {0.0, 0.3, 0.0, 0.0}, {0.0, 0.0, 0.0, -0.5}, "S@0 R@0");
  const RefinedOrbit orbit = refine_orbit(guess, {Quantity::energy, "-1.03"}, 50);
  const WorkingDigits working(checked_digits);
  expect_value(orbit.period, 2 * pi() / sqrt(Extended(3)), 50, "period");
  // k A^2 / 2 = E + m g l + (m g)^2 / (2 k) about y = -(l + m g/k).
  const Extended amplitude = sqrt(2 * (extended_of("-1.03") + 1 + Extended(1) / 6) / 3);
  expect_value(orbit.state[1], -Extended(4) / 3 + amplitude, 50, "y");
  EXPECT_EQ(orbit.state[0].value, 0);
}

/// The arithmetic-geometric mean.
Extended agm(Extended a, Extended b) {
  for (int n = 0; n < 20; ++n) {
    const Extended mean = (a + b) / 2;
    b = sqrt(Extended(a * b));
    a = mean;
  }
  return a;
}

// x = 0 and y'^2 = (2/3) (y - e1) (y - e2) (y - e3): with K by the arithmetic-geometric mean,
// T = 4 sqrt(3/2) K / sqrt(e3 - e1), k^2 = (e2 - e1) / (e3 - e1). At the energy 0.1.
TEST(RefineOrbit, FindsTheStraightOrbitsOfHenonAndHeiles) {
  const auto system = systems::make_system("henon_heiles");
  const WorkingDigits working(checked_digits);
  const auto root_near = [](double start) {
    Extended y(start);
    for (int n = 0; n < 12; ++n) y -= (y * y * y - y * y * 3 / 2 + Extended(3) / 10) / (3 * y * y - 3 * y);
    return y;
  };
  const Extended e1 = root_near(-0.4);
  const Extended e2 = root_near(0.6);
  const Extended e3 = Extended(3) / 2 - e1 - e2;
  const Extended complement = sqrt(Extended((e3 - e2) / (e3 - e1)));
  const Extended period =
      4 * sqrt(Extended(3) / 2) * (pi() / 2 / agm(Extended(1), complement)) / sqrt(Extended(e3 - e1));
  // A rough guess: mean, amplitude and period off by some per cent.
  for (const std::string isotropy : {"S@0 R@0", "R@0"}) {
    const Guess guess =
        guess_of(system, 6.8, {0.0, 0.08, 0.0, 0.0}, {0.0, 0.48, 0.0, 0.0}, {0.0, 0.0, 0.0, -0.44}, isotropy);
    const RefinedOrbit orbit = refine_orbit(guess, {Quantity::energy, "0.1"}, 70);
    expect_value(orbit.period, period, 70, "period");
    expect_value(orbit.state[1], e2, 70, "y");
    ASSERT_TRUE(orbit.index.has_value());
  }
  // The same orbit by its period.
  const Guess guess =
      guess_of(system, 6.8, {0.0, 0.08, 0.0, 0.0}, {0.0, 0.48, 0.0, 0.0}, {0.0, 0.0, 0.0, -0.44}, "S@0 R@0");
  const RefinedOrbit orbit = refine_orbit(guess, {Quantity::period, numerics::decimal_text(period, 75)}, 60);
  expect_value(*orbit.energy, Extended(1) / 10, 60, "energy");
}

// At rest the bounce's index is 2 cos(2 pi sqrt(g/|y|) / sqrt(k/m)), and it is even in the amplitude A:
// (4 k(A) - k(2 A)) / 3 is that to A^4.
TEST(RefineOrbit, FindsTheIndexOfSmallBounces) {
  const auto system = systems::make_system("swinging_spring");
  const WorkingDigits working(checked_digits);
  std::vector<Extended> indices;
  for (const double amplitude : {1e-3, 2e-3}) {
    const Guess guess = guess_of(system, 3.6276, {0.0, -4.0 / 3.0, 0.0, 0.0}, {0.0, amplitude, 0.0, 0.0},
                                 {0.0, 0.0, 0.0, -std::sqrt(3.0) * amplitude}, "S@0 R@0");
    const Extended energy = -Extended(7) / 6 + Extended(3) / 2 * Extended(amplitude) * Extended(amplitude);
    const RefinedOrbit orbit = refine_orbit(guess, {Quantity::energy, numerics::decimal_text(energy, 60)}, 30);
    indices.push_back(orbit.index->value);
  }
  const Extended at_rest = 2 * cos(Extended(2 * pi() * sqrt(Extended(3) / 4) / sqrt(Extended(3))));
  EXPECT_LT(numerics::log10_abs(indices[0] - at_rest), -5.0);
  EXPECT_LT(numerics::log10_abs((4 * indices[0] - indices[1]) / 3 - at_rest), -10.5);
}

// x'' + c x' + a x = F cos(omega t): x = (F/D) (A cos phi + c omega sin phi) with A = a - omega^2, D = A^2 +
// (c omega)^2, and the multipliers exp(-c T/2 +- i T sqrt(a - c^2/4)).
TEST(RefineOrbit, FindsTheAnswerOfADrivenLinearOscillator) {
  for (const bool is_damped : {true, false}) {
    const WorkingDigits working(checked_digits);
    const std::string friction = is_damped ? "0.2" : "0";
    std::map<std::string, double> parameters{
        {"alpha", 2.0}, {"beta", 0.0}, {"drive_amplitude", 0.3}, {"drive_frequency", 0.7}};
    std::vector<std::string> effects{"drive"};
    if (is_damped) {
      parameters["damping"] = 0.2;
      effects.emplace_back("damping");
    }
    const auto system = systems::make_system("duffing", parameters, effects);
    const Extended omega = extended_of("0.7");
    const Extended c = extended_of(friction);
    const Extended detuned = 2 - omega * omega;
    const Extended size = extended_of("0.3") / (detuned * detuned + c * c * omega * omega);
    const Extended period = 2 * pi() / omega;
    const Extended decay = exp(Extended(-c * period / 2));
    const Extended turn = period * sqrt(Extended(2 - c * c / 4));
    // Roughly, and with friction begun elsewhere than at the drive's phase 0.
    const double later = is_damped ? 0.4 : 0.0;
    const double amplitude = 0.2;
    for (const std::string& isotropy :
         is_damped ? std::vector<std::string>{"S@1/2", ""} : std::vector<std::string>{"S@1/2 R@0", "R@0"}) {
      Guess guess =
          guess_of(system, 9.0, {0.0, 0.0, later}, {amplitude * std::cos(later), -0.14 * std::sin(later), 0.0},
                   {-amplitude * std::sin(later), -0.14 * std::cos(later), 0.0}, isotropy);
      guess.loop.winding[2] = 1.0;
      const RefinedOrbit orbit = refine_orbit(guess, {Quantity::parameter, "0.7"}, 50);
      expect_value(orbit.period, period, 50, "period");
      expect_value(orbit.state[0], Extended(size * detuned), 50, "x");
      if (is_damped) expect_value(orbit.state[1], Extended(size * c * omega * omega), 50, "v");
      EXPECT_LT(numerics::log10_abs(orbit.state[2].value), -50.0);
      EXPECT_FALSE(orbit.energy.has_value());
      ASSERT_EQ(orbit.spectrum.size(), 1U);
      ASSERT_TRUE(orbit.spectrum[0].imaginary.has_value());
      expect_value(orbit.spectrum[0].real, Extended(decay * cos(turn)), 49, "real part");
      expect_value(*orbit.spectrum[0].imaginary, Extended(abs(Extended(decay * sin(turn)))), 49, "imaginary part");
    }
  }
}

// Where friction is strong both multipliers are real. A volume shrinks by their product, by which the least, 1e-18, has
// digits of its own: of M(T), whose entries are of size 1, it would have some 35.
TEST(RefineOrbit, FindsTheLeastMultiplierToItsOwnDigits) {
  const WorkingDigits working(checked_digits);
  const auto system = systems::make_system(
      "duffing", {{"alpha", 2.0}, {"beta", 0.0}, {"damping", 5.0}, {"drive_amplitude", 0.3}, {"drive_frequency", 0.7}},
      {"drive", "damping"});
  const double size = 0.3 / (1.51 * 1.51 + 3.5 * 3.5);
  const double even = size * 1.51;
  const double odd = size * 3.5;
  Guess guess = guess_of(system, 9.0, {0.0, 0.0, 0.0}, {even, 0.7 * odd, 0.0}, {odd, -0.7 * even, 0.0}, "S@1/2");
  guess.loop.winding[2] = 1.0;
  const RefinedOrbit orbit = refine_orbit(guess, {Quantity::parameter, "0.7"}, 50);
  const Extended period = 2 * pi() / extended_of("0.7");
  ASSERT_EQ(orbit.spectrum.size(), 2U);
  const Extended root = sqrt(Extended(17));
  expect_value(orbit.spectrum[0].real, exp(Extended(-(5 - root) / 2 * period)), 45, "larger");
  expect_value(orbit.spectrum[1].real, exp(Extended(-(5 + root) / 2 * period)), 45, "least");
}

TEST(RefineOrbit, FindsTheCycleOfVanDerPol) {
  const auto system = systems::make_system("van_der_pol", {{"mu", 1.0}});
  const Guess guess = guess_of(system, 6.6, {0.0, 0.0}, {2.0, 0.0}, {0.0, -2.0}, "S@1/2");
  const RefinedOrbit orbit = refine_orbit(guess, {Quantity::parameter, "1"}, 25);
  const WorkingDigits working(checked_digits);
  // By Taylor series of order 50 in another arithmetic of 45 digits, around until it repeats.
  expect_value(orbit.period, extended_of("6.66328685932313018969968203048232870681"), 25, "period");
  expect_value(orbit.state[0], extended_of("2.00861986087484313650964018836264036620"), 25, "x");
  const RefinedOrbit more = refine_orbit(guess, {Quantity::parameter, "1"}, 45);
  EXPECT_LE(abs(Extended(more.period.value - orbit.period.value)), orbit.period.error);
  EXPECT_LT(numerics::log10_abs(orbit.period.error), -24.0);
  ASSERT_EQ(orbit.spectrum.size(), 1U);
  EXPECT_FALSE(orbit.spectrum[0].imaginary.has_value());
  EXPECT_LE(abs(Extended(more.spectrum[0].real.value - orbit.spectrum[0].real.value)), orbit.spectrum[0].real.error);
  EXPECT_THAT(
      [&] {
        static_cast<void>(refine_orbit(guess, {Quantity::period, "6.66"}, 20));
      },
      ThrowsMessage<core::InputError>(HasSubstr("where nothing is conserved a parameter picks an orbit")));
}

TEST(RefineOrbit, RefusesWhatItCannotDo) {
  const auto system = systems::make_system("harmonic_oscillator");
  const Guess guess = guess_of(system, 6.2, {0.0, 0.0}, {1.1, 0.0}, {0.0, -1.1}, "S@1/2 R@0");
  const auto refined = [&](int digits) { static_cast<void>(refine_orbit(guess, {Quantity::energy, "0.5"}, digits)); };
  EXPECT_THAT([&] { refined(0); }, ThrowsMessage<core::InputError>(HasSubstr("expected 1 to 1000 digits, got 0")));
  EXPECT_THAT([&] { refined(1001); }, ThrowsMessage<core::InputError>(HasSubstr("got 1001")));
  EXPECT_THAT([&] { static_cast<void>(refine_crossing(guess, {archive::CrossingKind::torus}, 20)); },
              ThrowsMessage<core::InputError>(HasSubstr("torus cannot be refined")));
  EXPECT_THAT(
      [&] {
        static_cast<void>(refine_orbit(guess, {Quantity::energy, "half"}, 20));
      },
      ThrowsMessage<core::InputError>(HasSubstr("expected a decimal number such as 9 or -1.25e-3, got `half`")));
  const auto moving =
      systems::make_system("harmonic_oscillator", {}, {}, {{"omega"}, systems::FamilyScalars::Hold::energy});
  const Guess of_many = guess_of(moving, 6.2, {0.0, 0.0}, {1.1, 0.0}, {0.0, -1.1}, "S@1/2 R@0");
  EXPECT_THAT(
      [&] {
        static_cast<void>(refine_orbit(of_many, {Quantity::energy, "0.5"}, 20));
      },
      ThrowsMessage<core::InputError>(HasSubstr("orbits of families in omega cannot be refined")));
}

}  // namespace
}  // namespace orbweaver::refine::closed_forms_test
