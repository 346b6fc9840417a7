// One forced Duffing equation, x'' + x'/10 + x + x^3 = 0.3 cos(w t), in the ways that a text can say it: one tree.
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "survey/atlas.hpp"

namespace spellings_test {
namespace {

using namespace orbweaver;

struct Spelling {
  std::string name;
  std::string system;
  std::string state = "0.39, 0, 0";
};

const std::string parameters = "parameters: {d: 0.1, F: 0.3, w: 0.5}";

const std::vector<Spelling> spellings{
    {"first order", "{name: s1, equations: {x': v, v': -d*v - x - x^3 + F*cos(w*t)}, " + parameters + "}"},
    {"second order", "{name: s2, velocities: [v], equations: {x'': -d*x' - x - x^3 + F*cos(w*t)}, " + parameters + "}"},
    {"a block", "{name: s3, equations: \"x' = v\\nv' = F*cos(w*t) - d*v - x - x**3\", " + parameters + "}"},
    {"derivatives as quotients",
     "{name: s4, equations: {dx/dt: v, dv/dt: -d*v - x*(1 + x^2) + F*cos(w*t)}, " + parameters + "}"},
    {"a Lagrangian",
     "{name: s5, coordinates: [x], velocities: [v], lagrangian: x'^2/2 - x^2/2 - x^4/4, "
     "forces: {x: -d*x' + F*cos(w*t)}, " +
         parameters + "}"},
    {"a Hamiltonian",
     "{name: s6, coordinates: [x], momenta: [v], hamiltonian: v^2/2 + x^2/2 + x^4/4 - F*x*cos(w*t), "
     "forces: {x: -d*v}, " +
         parameters + "}"},
    {"a drive that is named",
     "{name: s7, equations: {x': v, v': -d*v - x - x^3 + F*cos(phase)}, drive: {frequency: w}, " + parameters + "}"},
    {"definitions and effects",
     "{name: s8, definitions: {spring(s): s + s^3, push: F*cos(w*t)}, equations: {x': v, v': -spring(x)}, "
     "effects: {rub: {equations: {v': -d*v}}, shake: {equations: {v': push}}}, active: [rub, shake], " +
         parameters + "}"},
    {"a pair in place of time",
     "{name: s9, equations: {x': v, v': -d*v - x - x^3 + F*a, a': -w*b + a*(1 - a^2 - b^2), "
     "b': w*a + b*(1 - a^2 - b^2)}, " +
         parameters + "}",
     "0.39, 0, 1, 0"},
};

TEST(Spellings, OfOneEquationHaveOneTree) {
  const core::Communicator comm;
  std::vector<double> expected;
  for (const Spelling& spelling : spellings) {
    SCOPED_TRACE(spelling.name);
    const scene::Scene scene = scene::load(
        ORBWEAVER_SOURCE_DIR "/drivers/scenes/duffing.yaml",
        {"system=" + spelling.system, "continuation.free=w", "limits.parameter=[0.3, 3]",
         "starts={states: [{state: [" + spelling.state + "], period: 12.566370614359172, name: Response}]}"});
    const survey::Summary summary = test::run(comm, scene, "spellings");
    EXPECT_EQ(summary.failures, 0U);
    if (!comm.is_root()) continue;
    const test::Atlas atlas(summary.atlas);
    std::vector<double> found;
    for (std::size_t row = 0; row < atlas.crossings().rows(); ++row) {
      EXPECT_EQ(atlas.crossings().texts("kind")[row], "fold-parameter");
      found.push_back(atlas.crossings().reals("parameter")[row]);
      found.push_back(atlas.crossings().reals("period")[row]);
    }
    EXPECT_EQ(atlas.families().rows(), 1U);
    ASSERT_EQ(found.size(), 4U);
    if (expected.empty()) expected = found;
    for (std::size_t n = 0; n < found.size(); ++n) EXPECT_NEAR(found[n], expected[n], 1e-9 * expected[n]);
  }
}

}  // namespace
}  // namespace spellings_test
