#include <fstream>
#include <sstream>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "orbweaver/document/document.hpp"
#include "orbweaver/systems/registry.hpp"
#include "orbweaver/systems/system.hpp"
#include "orbweaver/systems/text/graph_system.hpp"
#include "orbweaver/numerics/random.hpp"

namespace orbweaver::systems::shipped_texts_test {
namespace {

ModelText text_of(const std::string& name) {
  const std::string file = fmt::format("{}/drivers/systems/{}.yaml", ORBWEAVER_SOURCE_DIR, name);
  std::ifstream in(file);
  std::stringstream all;
  all << in.rdbuf();
  const document::Source source(file, {});
  return read_model(document::Field(source, document::parse_document(all.str(), file, true), "", 1));
}

void expect_near(const std::vector<double>& a, const std::vector<double>& b, const std::string& what) {
  ASSERT_EQ(a.size(), b.size());
  double size = 0.0;
  for (const double x : b) size = std::max(size, std::abs(x));
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(a[i], b[i], 1e-13 * (1.0 + size)) << what << " " << i;
}

void compare(const std::string& name, const std::map<std::string, double>& values,
             const std::vector<std::string>& effects) {
  SCOPED_TRACE(fmt::format("{} with {} effects", name, effects.size()));
  const auto old = make_system(name, values, effects);
  const ModelText text = text_of(name);
  std::map<std::string, double> bound = old->parameters();
  const auto own = system_of(build_model(text, bound, effects), bound);
  const Structure& s = own->structure();
  const Structure& t = old->structure();
  EXPECT_EQ(s.dimension, t.dimension);
  EXPECT_EQ(s.angles, t.angles);
  EXPECT_EQ(s.conserved, t.conserved);
  EXPECT_EQ(s.guard_names(), t.guard_names());
  EXPECT_EQ(s.symplectic, t.symplectic);
  EXPECT_EQ(s.driven, t.driven);
  EXPECT_EQ(s.dissipative, t.dissipative);
  EXPECT_EQ(s.decays, t.decays);
  EXPECT_EQ(own->info().state_names, old->info().state_names);
  EXPECT_EQ(own->info().winding_names, old->info().winding_names);
  for (const auto& [a, b] : {std::pair{&s.equivariances, &t.equivariances}, {&s.reversors, &t.reversors}}) {
    std::string names, others;
    for (const Symmetry& one : *a) names += one.name + " ";
    for (const Symmetry& one : *b) others += one.name + " ";
    EXPECT_EQ(names, others);
    for (std::size_t n = 0; n < std::min(a->size(), b->size()); ++n)
      EXPECT_TRUE((*a)[n].map.is_same((*b)[n].map, t.angles)) << (*a)[n].name;
  }
  const auto d = static_cast<std::size_t>(t.dimension);
  constexpr std::size_t nodes = 70;
  numerics::Random random(3);
  std::vector<double> z(d * nodes), w(d * nodes);
  for (double& x : z) x = 1.5 * random();
  for (double& x : w) x = random();
  std::vector<double> f(d * nodes), g(d * nodes), a(d * d * nodes), b(d * d * nodes);
  own->field(nodes, z.data(), f.data());
  old->field(nodes, z.data(), g.data());
  expect_near(f, g, "field");
  own->field_jacobian(nodes, z.data(), f.data(), a.data());
  old->field_jacobian(nodes, z.data(), g.data(), b.data());
  expect_near(a, b, "jacobian");
  own->second_derivatives(nodes, z.data(), w.data(), a.data());
  old->second_derivatives(nodes, z.data(), w.data(), b.data());
  expect_near(a, b, "second");
  for (const auto& [parameter, value] : old->parameters()) {
    if (parameter == "links") continue;
    own->parameter_derivatives(parameter, nodes, z.data(), f.data());
    old->parameter_derivatives(parameter, nodes, z.data(), g.data());
    expect_near(f, g, parameter);
  }
  for (int k = 0; k < static_cast<int>(t.conserved.size()); ++k) {
    own->conserved_gradients(k, nodes, z.data(), f.data());
    old->conserved_gradients(k, nodes, z.data(), g.data());
    expect_near(f, g, "gradient");
    std::vector<double> state;
    for (std::size_t i = 0; i < d; ++i) state.push_back(z[i * nodes]);
    EXPECT_NEAR(own->conserved(k, state), old->conserved(k, state), 1e-12);
    EXPECT_NEAR(own->action_density(state), old->action_density(state), 1e-12);
  }
}

TEST(ShippedTexts, AreTheCompiledSystems) {
  for (const std::string& name : system_names())
    for (const std::vector<std::string>& effects : built_effects(name)) compare(name, {}, effects);
  compare("pcr3bp", {{"mu", 0.5}}, {});
  compare("cr3bp", {{"mu", 0.5}}, {});
  compare("three_bodies", {{"L", 0.3}}, {});
  compare("three_bodies", {{"m1", 0.3}}, {});
  compare("pendulum_chain", {{"links", 1}}, {});
  compare("pendulum_chain", {{"links", 10}}, {});
  compare("double_pendulum", {{"pivot_direction", 90.0}}, {"damping", "pivot_drive"});
  compare("double_pendulum", {{"rest1", 0.1}}, {"torsion_springs"});
}

}  // namespace
}  // namespace orbweaver::systems::shipped_texts_test
