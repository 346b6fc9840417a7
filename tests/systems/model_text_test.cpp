#include "orbweaver/systems/text/model_text.hpp"

#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "orbweaver/core/error.hpp"
#include "orbweaver/systems/system.hpp"
#include "support/text_model.hpp"

namespace orbweaver::systems::model_text_test {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

const auto read = test::read_model_text;

std::shared_ptr<const System> made(const std::string& text, const std::vector<std::string>& effects = {},
                                   const std::map<std::string, double>& values = {}) {
  return test::text_system(text, effects, values);
}

std::string refusal(const std::string& text, const std::vector<std::string>& effects = {}) {
  try {
    static_cast<void>(made(text, effects));
  } catch (const core::InputError& error) {
    return error.what();
  }
  return "accepted";
}

std::vector<double> field(const System& system, const std::vector<double>& z) {
  std::vector<double> f(z.size());
  system.field(1, z.data(), f.data());
  return f;
}

std::vector<std::string> names(const std::vector<Symmetry>& symmetries) {
  std::vector<std::string> all;
  for (const Symmetry& symmetry : symmetries) all.push_back(symmetry.name);
  return all;
}

TEST(ModelText, EquationsAreTheField) {
  const auto system = made("{equations: {x': sigma*(y - x), y': -x*y^2 + 2^-1}, parameters: {sigma: 10}}");
  EXPECT_THAT(system->info().state_names, ElementsAre("x", "y"));
  EXPECT_THAT(field(*system, {1.0, 3.0}), ElementsAre(20.0, -8.5));
  EXPECT_TRUE(system->structure().dissipative);
  EXPECT_FALSE(system->structure().symplectic);
}

TEST(ModelText, ABlockSaysTheSame) {
  const auto system = made("equations: |\n  x' = v   # a comment\n  dv/dt = -x\n");
  EXPECT_THAT(field(*system, {1.0, 3.0}), ElementsAre(3.0, -1.0));
  EXPECT_THAT(refusal("equations: |\n  x' = v\n  v' = -xx\n"),
              AllOf(HasSubstr("model.yaml:3: equations: column 3"), HasSubstr("got `xx`")));
}

TEST(ModelText, AnEnergyIsAHamiltonians) {
  const auto system = made("{coordinates: [q], momenta: [p], hamiltonian: (p^2 + w^2*q^2)/2, parameters: {w: 2}}");
  EXPECT_THAT(field(*system, {1.0, 3.0}), ElementsAre(3.0, -4.0));
  EXPECT_THAT(system->structure().conserved, ElementsAre("energy"));
  EXPECT_TRUE(system->structure().symplectic);
  EXPECT_EQ(system->conserved(0, std::vector<double>{1.0, 3.0}), 6.5);
  EXPECT_EQ(system->action_density(std::vector<double>{1.0, 3.0}), 9.0);
}

// A bead on a parabola: the mass depends on the place.
TEST(ModelText, ALagrangianIsSolvedForItsAccelerations) {
  const auto system = made("{coordinates: [x], velocities: [v], lagrangian: x'^2*(1 + 4*x^2)/2 - x^2}");
  const double x = 0.7, v = 1.3;
  EXPECT_NEAR(field(*system, {x, v})[1], (-2.0 * x - 4.0 * x * v * v) / (1.0 + 4.0 * x * x), 1e-15);
  EXPECT_FALSE(system->structure().dissipative);
  EXPECT_TRUE(system->structure().symplectic);
}

TEST(ModelText, ForcesThatDoNoWorkKeepTheEnergy) {
  const char* const text =
      "{coordinates: [x, y], lagrangian: (x'^2 + y'^2)/2 - x^2 - 2*y^2, forces: {x: b*y', y: -b*x' - d*y'}, "
      "parameters: {b: 1, d: 0}}";
  EXPECT_THAT(made(text)->structure().conserved, ElementsAre("energy"));
  EXPECT_TRUE(made(text, {}, {{"d", 0.1}})->structure().conserved.empty());
  EXPECT_TRUE(made(text, {}, {{"d", 0.1}})->structure().decays);
}

TEST(ModelText, TimeBecomesThePhaseOfADrive) {
  const std::string body = "x': v, v': \"-x - x^3 + F*cos(w*t) + cos(2*w*t - 1)\"";
  const auto system = made("{equations: {" + body + "}, parameters: {w: 3, F: 0.5}}");
  EXPECT_TRUE(system->structure().driven);
  EXPECT_THAT(system->info().state_names, ElementsAre("x", "v", "phase"));
  EXPECT_THAT(system->structure().angles, ElementsAre(2));
  const std::vector<double> f = field(*system, {0.0, 0.0, 0.4});
  EXPECT_NEAR(f[1], 0.5 * std::cos(0.4) + std::cos(0.8 - 1.0), 1e-15);
  EXPECT_EQ(f[2], 3.0);
  // With their greatest common divisor.
  EXPECT_EQ(field(*made("equations: {x': \"-x + sin(6*t) + cos(4*t)\"}"), {0.0, 0.0})[1], 2.0);
  EXPECT_EQ(field(*made("equations: {x': \"-x + sin(-t/2)\"}"), {0.0, 0.0})[1], 0.5);
  EXPECT_THAT(refusal("equations: {x': \"-x + sin(t) + cos(sqrt(2)*t)\"}"), HasSubstr("rational multiples"));
  EXPECT_THAT(refusal("equations: {x': -x + t}"), HasSubstr("time outside of sines and cosines"));
  EXPECT_THAT(refusal("equations: {x': sin(x*t)}"), HasSubstr("time multiplied by something that moves"));
}

TEST(ModelText, DefinitionsMoveWithWhatTheyAreMadeOf) {
  const auto system = made("{equations: {x': b*x}, parameters: {a: 3, b: 2*a}}");
  EXPECT_EQ(field(*system, {1.0})[0], 6.0);
  const double z = 2.0;
  double slope = 0.0;
  system->parameter_derivatives("a", 1, &z, &slope);
  EXPECT_EQ(slope, 4.0);
  EXPECT_THAT(refusal("{equations: {x': b}, definitions: {b: c, c: b}}"), HasSubstr("circles, got b -> c -> b"));
  const auto with_arguments = made("{equations: {x': \"f(x, 2)\"}, definitions: {\"f(u, n)\": u*n + x}}");
  EXPECT_EQ(field(*with_arguments, {5.0})[0], 15.0);
}

TEST(ModelText, IndicesMakeChainsAndRings) {
  const auto ring = made(
      "sizes: {n: 4}\ncoordinates: x[1..n]\nends: {x: cyclic}\nequations:\n  for i = 1..n:\n    x[i]': x[i+1] - "
      "x[i-1]\n");
  EXPECT_THAT(ring->info().state_names, ElementsAre("x1", "x2", "x3", "x4"));
  EXPECT_THAT(field(*ring, {1.0, 2.0, 4.0, 8.0}), ElementsAre(-6.0, 3.0, 6.0, -3.0));
  const auto chain = made(
      "sizes: {n: 3}\ncoordinates: x[1..n]\nends: {x: {0: 5, n+1: \"x[n]\"}}\nequations:\n  for i = 1..n:\n"
      "    x[i]': x[i+1] + x[i-1] + sum(j = 1..n, j*x[j])\n");
  EXPECT_THAT(field(*chain, {1.0, 2.0, 3.0}), ElementsAre(21.0, 18.0, 19.0));
  EXPECT_EQ(
      made("sizes: {n: 3}\ncoordinates: x[1..n]\nequations:\n  for i = 1..n:\n    x[i]': -x[i]\n", {}, {{"n", 7.0}})
          ->dimension(),
      7);
}

TEST(ModelText, NumbersAreExactAndGrammarIsNotGuessed) {
  EXPECT_EQ(field(*made("equations: {x': 0.1 - 1/10}"), {0.0})[0], 0.0);
  EXPECT_EQ(field(*made("equations: {x': -x^2}"), {3.0})[0], -9.0);
  EXPECT_EQ(field(*made("equations: {x': 2*-x}"), {3.0})[0], -6.0);
  EXPECT_EQ(field(*made("equations: {x': x^-2 + x**2}"), {2.0})[0], 4.25);
  EXPECT_THAT(refusal("equations: {x': 2x}"), HasSubstr("products are written with `*`, as in 2*x"));
  EXPECT_THAT(refusal("equations: {x': x^2^3}"), HasSubstr("(a^b)^c or a^(b^c)"));
  EXPECT_THAT(refusal("equations: {x': x (3)}"), AllOf(HasSubstr("column 1"), HasSubstr("x*(...)")));
  EXPECT_THAT(refusal("equations: {x': sinn(x)}"), HasSubstr("did you mean `sin`?"));
  EXPECT_THAT(refusal("equations: {x': \"max(x, 0)\"}"), HasSubstr("derivatives everywhere, got `max`"));
  EXPECT_THAT(refusal("equations: {x': x +}"), HasSubstr("expected a number, a name or `(`, got the end"));
  EXPECT_THAT(refusal("{equations: {x': x}, parameters: {sin: 1}}"), HasSubstr("which is a function"));
  EXPECT_THAT(refusal("{equations: {x: y}}"), HasSubstr("maps, delays and algebraic equations are not done"));
  EXPECT_THAT(refusal("{equation: {x': y}}"), HasSubstr("did you mean `equations`?"));
  EXPECT_THAT(refusal(fmt::format("equations: {{x': {}x{}}}", std::string(300, '('), std::string(300, ')'))),
              HasSubstr("at most 200 levels"));
}

TEST(ModelText, SymmetriesAreHeldAgainstTheField) {
  const char* const text =
      "{coordinates: [x, y], momenta: [px, py], hamiltonian: (px^2 + py^2 + x^2 + y^2)/2 + x^2*y - k*y^3/3, "
      "parameters: {k: 1}, symmetries: {S: {x: -x, px: -px}}, reversors: {R: {px: -px, py: -py}}}";
  const auto system = made(text);
  EXPECT_THAT(names(system->structure().equivariances), ElementsAre("S"));
  EXPECT_THAT(names(system->structure().reversors), ElementsAre("R"));
  EXPECT_THAT(refusal("{equations: {x': y, y': x^2}, symmetries: {S: {x: -x, y: -y}}}"),
              HasSubstr("expected that the field keeps `S`, got one that does not"));
  EXPECT_THAT(refusal("{equations: {x': y, y': -x}, symmetries: {S: {x: x^2}}}"), HasSubstr("an affine map"));
  EXPECT_THAT(refusal("{equations: {x': y, y': -x}, conserved: {energy: x^2 + y^4}}"),
              HasSubstr("expected that the field keeps `energy`"));
}

// What an effect could do costs nothing where it is off.
TEST(ModelText, AnEffectThatIsOffLeavesNoNodes) {
  const std::string ideal = "coordinates: [x], lagrangian: x'^2/2 - k*x^2/2, parameters: {k: 1}";
  const std::string effects =
      ", effects: {friction: {parameters: {d: {value: 0.1, range: [0, 1]}}, forces: {x: -d*x'}}, cubic: {parameters: "
      "{b: 2}, lagrangian: "
      "-b*x^4/4}}";
  const BuiltModel plain = build_model(read("{" + ideal + "}"), {}, {});
  const BuiltModel able = build_model(read("{" + ideal + effects + "}"), {}, {});
  EXPECT_EQ(plain.graph.size(), able.graph.size());
  EXPECT_EQ(plain.field, able.field);
  const auto both = made("{" + ideal + effects + "}", {"friction", "cubic"});
  EXPECT_NEAR(field(*both, {0.5, 2.0})[1], -0.5 - 0.2 - 0.25, 1e-15);
  EXPECT_TRUE(both->structure().decays);
  EXPECT_EQ(both->info().title, "model with friction, cubic");
}

TEST(ModelText, GuardsAndAnglesAreNamed) {
  const auto system = made(
      "{coordinates: {th: {angle: true}, r: }, velocities: [w, u], lagrangian: (r'^2 + r^2*th'^2)/2 + r*cos(th) + 1/r, "
      "guards: {r: {value: r, body: the centre}}}");
  EXPECT_THAT(system->structure().angles, ElementsAre(0));
  EXPECT_THAT(system->winding_names(), ElementsAre("n_th"));
  EXPECT_EQ(system->guard(0, std::vector<double>{0.0, 0.25, 0.0, 0.0}), 0.25);
  EXPECT_EQ(system->structure().guards.front().body, "the centre");
}

}  // namespace
}  // namespace orbweaver::systems::model_text_test
