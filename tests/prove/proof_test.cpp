#include "orbweaver/prove/proof.hpp"

#include <cmath>
#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>

#include "ball.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/loop/symmetry/isotropy_text.hpp"
#include "orbweaver/prove/proof_file.hpp"
#include "orbweaver/systems/registry.hpp"

namespace orbweaver::prove::proof_test {
namespace {

using numerics::Extended;
using numerics::extended_of;
using numerics::WorkingDigits;
using refine::Guess;
using refine::HeldValue;
using Quantity = HeldValue::Quantity;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::ThrowsMessage;

/// A guess with the first harmonics alone: a_0, a_1 and b_1 of each coordinate.
Guess guess_of(const std::string& system, const std::map<std::string, double>& parameters, double period,
               const std::vector<double>& mean, const std::vector<double>& cosine, const std::vector<double>& sine,
               const std::string& isotropy) {
  loop::Loop loop = loop::constant_loop(mean, period, 8);
  for (std::size_t i = 0; i < cosine.size(); ++i) {
    loop.cosine(1, static_cast<int>(i)) = cosine[i];
    loop.sine(1, static_cast<int>(i)) = sine[i];
  }
  const auto made = systems::make_system(system, parameters);
  return {made, made->scales(), loop, loop::isotropy_of(made->structure(), isotropy)};
}

Guess oscillator(const std::string& isotropy) {
  return guess_of("harmonic_oscillator", {{"omega", 0.1}}, 62.0, {0.0, 0.0}, {1.1, 0.0}, {0.0, -0.11}, isotropy);
}

Guess straight(const std::string& isotropy) {
  return guess_of("henon_heiles", {}, 6.8, {0.0, 0.08, 0.0, 0.0}, {0.0, 0.48, 0.0, 0.0}, {0.0, 0.0, 0.0, -0.44},
                  isotropy);
}

const HeldValue energy_01{Quantity::energy, "0.1"};

Statement straight_statement() { return statement_about("Straight", {}, straight("S@0 R@0"), energy_01, 20); }

// Its period is 2 pi / omega at every energy, omega being the decimal 0.1 and not the double next to it.
TEST(Prove, EnclosesThePeriodOfTheHarmonicOscillator) {
  const WorkingDigits digits(60);
  const Extended exact = 20 * acos(Extended(-1));
  const Extended of_the_double = 2 * acos(Extended(-1)) / Extended(0.1);
  for (const std::string isotropy : {"S@1/2 R@0", "R@0", "S@1/2", ""}) {
    const HeldValue held{Quantity::energy, "0.005"};
    const Proof proof = prove(statement_about("Swing", {}, oscillator(isotropy), held, 30));
    EXPECT_TRUE(proof.period.contains(exact)) << isotropy << ' ' << proof.period.text();
    EXPECT_FALSE(proof.period.contains(of_the_double)) << isotropy;
    EXPECT_LT(proof.period.radius(), 1e-28) << isotropy;
    EXPECT_TRUE(proof.state[0].contains(Extended(1))) << isotropy;
    EXPECT_LT(std::abs(proof.state[1].upper()), 1e-30) << isotropy;  // a section goes through what was refined
    EXPECT_EQ(proof.stability, Stability::none);
    EXPECT_GT(proof.radius, 1e-4) << isotropy;
    EXPECT_LT(proof.distance, proof.radius);
    EXPECT_THAT(proof.isolated_by, HasSubstr(isotropy.find('R') == std::string::npos ? "section" : "fixed sets"));
  }
}

// Another method, to 50 digits, with and without reversor, and by its period.
TEST(Prove, HoldsTheRefinedOrbit) {
  const refine::RefinedOrbit refined = refine_orbit(straight("S@0 R@0"), energy_01, 50);
  for (const std::string isotropy : {"S@0 R@0", "R@0"}) {
    const Proof proof = prove(statement_about("Straight", {}, straight(isotropy), energy_01, 30));
    EXPECT_TRUE(proof.period.contains(refined.period.value)) << isotropy;
    EXPECT_LT(proof.period.radius(), 1e-28);
    EXPECT_TRUE(proof.index->contains(refined.index->value)) << isotropy;
    EXPECT_LT(proof.index->radius(), 1e-24);
    EXPECT_EQ(proof.stability, Stability::elliptic);
    ASSERT_EQ(proof.multiplier.size(), 2U);
    for (std::size_t n : {0U, 1U}) EXPECT_TRUE(proof.multiplier[n].contains(refined.multipliers[n].value)) << n;
    for (std::size_t i = 0; i < 4; ++i)
      EXPECT_TRUE(proof.state[i].contains(refined.state[i].value)) << isotropy << ' ' << i;
  }
  const WorkingDigits digits(60);
  const HeldValue by_period{Quantity::period, numerics::decimal_text(refined.period.value, 50)};
  const Proof proof = prove(statement_about("Straight", {}, straight("S@0 R@0"), by_period, 30));
  EXPECT_TRUE(proof.energy.contains(extended_of("0.1")));
  EXPECT_TRUE(proof.period.contains(refined.period.value));
}

// Around the origin, x + i y near e^(i t): entries sqrt(3)/2 of the symmetry, p = 3. And on a section.
TEST(Prove, HoldsAnOrbitWithTheSymmetryOfATriangle) {
  constexpr double a = 0.316;
  const std::vector<double> none(4, 0.0);
  for (const std::string isotropy : {"C@1/3 RS@0", "C@1/3", ""}) {
    const Guess guess = isotropy.find('R') == std::string::npos
                            ? guess_of("henon_heiles", {}, 6.1, none, {a, 0, 0, a}, {0, a, -a, 0}, isotropy)
                            : guess_of("henon_heiles", {}, 6.1, none, {0, a, -a, 0}, {-a, 0, 0, -a}, isotropy);
    const refine::RefinedOrbit refined = refine_orbit(guess, energy_01, 50);
    const Proof proof = prove(statement_about("Loop", {}, guess, energy_01, 30));
    EXPECT_EQ(proof.order, isotropy.empty() ? 1 : 3);
    EXPECT_TRUE(proof.period.contains(refined.period.value)) << isotropy;
    EXPECT_LT(proof.period.radius(), 1e-27) << isotropy;
    EXPECT_TRUE(proof.fundamental_index->contains(refined.fundamental_index->value)) << isotropy;
    EXPECT_TRUE(proof.index->contains(refined.index->value)) << isotropy;
    EXPECT_EQ(proof.stability, Stability::elliptic);
    EXPECT_TRUE(proof.multiplier[0].contains(refined.multipliers[0].value)) << isotropy;
    EXPECT_TRUE(proof.multiplier[1].contains(refined.multipliers[1].value)) << isotropy;
  }
}

TEST(Prove, FailsAboutAWrongCentre) {
  const Statement right = straight_statement();
  const Proof proof = prove(right);
  for (std::size_t n = 0; n < right.centre.size(); ++n) {
    Statement wrong = right;
    const WorkingBits working(right.bits);
    wrong.centre[n] = (Ball::of_exact_text(right.centre[n]) + Ball(3e-2)).exact_text();
    EXPECT_THROW(static_cast<void>(prove(wrong)), NotProven) << n;
    EXPECT_THROW(static_cast<void>(prove(wrong, 1e-3)), NotProven) << n;
    // A little beside it the same orbit is found, which is said to be so far away.
    wrong.centre[n] = (Ball::of_exact_text(right.centre[n]) + Ball(1e-9)).exact_text();
    const Proof beside = prove(wrong);
    EXPECT_GE(beside.distance, 1e-9 * (1.0 - 1e-6)) << n;
    EXPECT_TRUE(beside.period.contains(proof.period)) << n;
    for (std::size_t i = 0; i < 4; ++i) EXPECT_TRUE(beside.state[i].contains(proof.state[i])) << n << ' ' << i;
  }
}

TEST(Prove, DoesNotTakeAnotherOrbitsCentre) {
  Statement other = straight_statement();
  other.held.decimal = "0.11";
  EXPECT_THROW(static_cast<void>(prove(other)), NotProven);
}

// The origin solves the equations at any period.
TEST(Prove, DoesNotTakeAnEquilibriumForAnOrbit) {
  Statement rest = statement_about("Straight", {}, straight("R@0"), {Quantity::period, "6.8"}, 20);
  for (std::string& x : rest.centre) x = Ball(0.0).exact_text();
  EXPECT_THAT([&] { static_cast<void>(prove(rest)); }, ThrowsMessage<NotProven>(HasSubstr("equilibrium")));
}

// In a radius that holds more than is known nothing is proven, and false claims are found.
TEST(Check, FindsWhatDoesNotFollow) {
  const Proof proof = prove(straight_statement());
  EXPECT_THAT(check(proof), IsEmpty());
  const auto changed = [&](const auto& change) {
    Proof copy = proof;
    change(copy);
    return check(copy);
  };
  EXPECT_THAT(changed([](Proof& p) { p.stability = Stability::hyperbolic; }),
              ElementsAre(HasSubstr("the stability hyperbolic does not follow")));
  EXPECT_THAT(changed([](Proof& p) { p.radius = 0.5; }), ElementsAre(HasSubstr("")));
  EXPECT_THAT(changed([](Proof& p) { p.radius *= 1e-30; }), ElementsAre(HasSubstr("a radius of")));
  EXPECT_THAT(changed([](Proof& p) { p.distance *= 0.5; }), ElementsAre(HasSubstr("the distance")));
  EXPECT_THAT(changed([](Proof& p) { p.order = 2; }), ElementsAre(HasSubstr("the order")));
  EXPECT_THAT(changed([](Proof& p) { p.isolated_by = "a vote"; }), ElementsAre(HasSubstr("isolation by a vote")));
  EXPECT_THAT(changed([](Proof& p) { p.fundamental_index.reset(); }), ElementsAre(HasSubstr("the index of the fund")));
  // Each enclosure moved by a tenth of its radius, and beyond 2.
  const WorkingBits working(200);
  const auto moved = [](const Enclosure& enclosure) {
    const Ball ball = Ball::of_exact_text(enclosure.exact);
    return Enclosure{(ball + Ball(0.1) * ball.radius() + Ball(1e-60)).exact_text()};
  };
  EXPECT_THAT(changed([&](Proof& p) { p.period = moved(p.period); }), ElementsAre(HasSubstr("the period in")));
  EXPECT_THAT(changed([&](Proof& p) { p.energy = moved(p.energy); }), ElementsAre(HasSubstr("the energy in")));
  EXPECT_THAT(changed([&](Proof& p) { p.state[1] = moved(p.state[1]); }), ElementsAre(HasSubstr("coordinate 1")));
  EXPECT_THAT(changed([&](Proof& p) { p.index = Enclosure{Ball(2.5).exact_text()}; }),
              ElementsAre(HasSubstr("the index in 2.5")));
  EXPECT_THAT(changed([&](Proof& p) { p.multiplier[1] = moved(p.multiplier[1]); }),
              ElementsAre(HasSubstr("the multiplier")));
  // What is wider holds all the same.
  EXPECT_THAT(changed([&](Proof& p) {
                p.index = Enclosure{Ball::of_exact_text(p.index->exact).widened(Ball(1e-3)).exact_text()};
              }),
              IsEmpty());
}

TEST(Prove, RefusesStatementsThatMakeNoSense) {
  EXPECT_THROW(static_cast<void>(statement_about("S", {}, straight("R@0"), energy_01, 0)), core::InputError);
  const Statement right = straight_statement();
  Statement wrong = right;
  wrong.centre.pop_back();
  EXPECT_THAT([&] { static_cast<void>(prove(wrong)); }, ThrowsMessage<core::InputError>(HasSubstr("unknowns")));
  wrong = right;
  wrong.bits = 1L << 40;  // which no memory has
  EXPECT_THAT([&] { static_cast<void>(prove(wrong)); }, ThrowsMessage<core::InputError>(HasSubstr("bits")));
  wrong = right;
  wrong.start.pop_back();
  EXPECT_THAT([&] { static_cast<void>(prove(wrong)); }, ThrowsMessage<core::InputError>(HasSubstr("does not fit")));
  wrong = statement_about("Swing", {}, oscillator("R@0"), {Quantity::energy, "0.005"}, 10);
  wrong.parameters.front().second = "0.1000000000000000001";
  EXPECT_THAT([&] { static_cast<void>(prove(wrong)); },
              ThrowsMessage<core::InputError>(HasSubstr("not what it is computed with")));
  wrong = right;
  wrong.system = "nowhere";
  EXPECT_THROW(static_cast<void>(prove(wrong)), core::InputError);
  wrong = right;
  wrong.centre[0] = "half";
  EXPECT_THROW(static_cast<void>(prove(wrong)), core::InputError);
}

TEST(ProofFile, GivesBackWhatWasWritten) {
  const std::filesystem::path path = "proofs.h5";
  const std::vector<Proof> proofs{prove(straight_statement()),
                                  prove(statement_about("Swing", {}, oscillator(""), {Quantity::energy, "0.005"}, 15))};
  write_proofs(path, proofs);
  EXPECT_TRUE(is_proofs_file(path));
  const std::vector<Proof> again = read_proofs(path);
  ASSERT_EQ(again.size(), 2U);
  for (const Proof& proof : again) EXPECT_THAT(check(proof), IsEmpty()) << proof.statement.family;
  EXPECT_EQ(again[0].radius, proofs[0].radius);
  EXPECT_EQ(again[0].statement.state_names, proofs[0].statement.state_names);
  EXPECT_EQ(again[1].statement.parameters, proofs[1].statement.parameters);
  EXPECT_FALSE(again[1].index.has_value());
  EXPECT_EQ(again[0].multiplier[1].exact, proofs[0].multiplier[1].exact);
  // The same proofs, the same bytes; one byte changed is found.
  const auto bytes = [](const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(in), {});
  };
  const std::string whole = bytes(path);
  write_proofs(path, again);
  EXPECT_EQ(bytes(path), whole);
  std::string changed = whole;
  const std::size_t place = changed.find(proofs[1].period.exact);
  ASSERT_NE(place, std::string::npos);
  changed[place] = changed[place] == '7' ? '8' : '7';
  std::ofstream(path, std::ios::binary) << changed;
  EXPECT_THAT([&] { static_cast<void>(read_proofs(path)); },
              ThrowsMessage<core::InputError>(HasSubstr("has a changed row 1 of /proofs")));
  std::ofstream(path, std::ios::binary) << "no proofs";
  EXPECT_FALSE(is_proofs_file(path));
  EXPECT_THROW(static_cast<void>(read_proofs(path)), core::InputError);
  std::filesystem::remove(path);
  EXPECT_THAT([&] { static_cast<void>(read_proofs(path)); },
              ThrowsMessage<core::InputError>(HasSubstr("does not exist")));
}

}  // namespace
}  // namespace orbweaver::prove::proof_test
