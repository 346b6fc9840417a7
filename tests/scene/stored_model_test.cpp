// A scene and the text of its model, as an archive has them beside each other.
#include <filesystem>
#include <fstream>
#include <string>

#include <gmock/gmock.h>

#include "orbweaver/core/error.hpp"
#include "orbweaver/scene/differences.hpp"
#include "orbweaver/scene/scene.hpp"
#include "orbweaver/systems/registry.hpp"

namespace stored_model_test {
namespace {

using namespace orbweaver;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::ThrowsMessage;

std::string model_with(const std::string& k) {
  return "# a spring\nname: spring\ncoordinates: [x]\nmomenta: [p]\nhamiltonian: p^2/2 + " + k +
         "*x^2/2 + x^4/4\nparameters: {k: 1}\n";
}

scene::Scene loaded(const std::string& model, const std::vector<std::string>& overrides = {}) {
  std::ofstream("spring.yaml") << model;
  std::ofstream("scene.yaml") << "system: {model_file: spring.yaml, parameters: {k: 2}}\nstarts: {}\n";
  return scene::load("scene.yaml", overrides);
}

double force_at_one(const scene::Scene& scene) {
  const std::vector<double> z{1.0, 0.0};
  std::vector<double> f(2);
  scene::bound_system(scene.system)->field(1, z.data(), f.data());
  return f[1];
}

TEST(StoredModel, StandsBesideTheSceneAsItWasWritten) {
  const scene::Scene written = loaded(model_with("k"));
  EXPECT_EQ(written.text, "system: {model_file: spring.yaml, parameters: {k: 2}}\nstarts: {}\n");
  EXPECT_EQ(written.model, model_with("k"));
  std::filesystem::remove("spring.yaml");
  const scene::Scene stored = scene::parse(written.text, "atlas.h5", {}, written.model);
  EXPECT_EQ(force_at_one(stored), -3.0);
  EXPECT_THAT(differences(written, stored), IsEmpty());
  EXPECT_THAT([&] { static_cast<void>(scene::parse(written.text, "atlas.h5")); },
              ThrowsMessage<core::InputError>(HasSubstr("atlas.h5:1: system.model_file: expected the model's text")));
}

TEST(StoredModel, ThatIsAnotherIsADifference) {
  const scene::Scene before = loaded(model_with("k"));
  const scene::Scene now = loaded(model_with("3*k"));
  const auto found = differences(before, now);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found.front().key, "system.hamiltonian");
  EXPECT_EQ(found.front().change, scene::Change::other);
}

TEST(StoredModel, OfTheProgramIsItsOwnText) {
  const std::string text = "system: {name: lorenz}\nstarts: {}\ncontinuation: {free: rho}\n";
  const scene::Scene now = scene::parse(text, "now.yaml");
  EXPECT_EQ(now.model, systems::system_text("lorenz"));
  // One that an older or newer program has otherwise is taken as the archive has it, and only there.
  std::string other = now.model;
  const std::string sigma = "sigma*(y - x)";
  other.replace(other.find(sigma), sigma.size(), "sigma*(x - y)");
  const scene::Scene stored = scene::parse(text, "atlas.h5", {}, other);
  const auto rate = [](const scene::Scene& scene) {
    const std::vector<double> z{1.0, 2.0, 3.0};
    std::vector<double> f(3);
    scene::bound_system(scene.system)->field(1, z.data(), f.data());
    return f[0];
  };
  EXPECT_EQ(rate(stored), -rate(now));
  EXPECT_EQ(rate(scene::parse(text, "now.yaml")), rate(now));
}

TEST(StoredModel, OfASceneWithEquationsIsItsSystem) {
  const scene::Scene scene = scene::parse(
      "system: {name: spring, parameters: {k: 1}, equations: {\"x''\": -k*x - x^3}}\nstarts: {}\ncontinuation: {free: "
      "k}\n",
      "s.yaml");
  EXPECT_THAT(scene.model, HasSubstr("-k*x - x^3"));
  EXPECT_NO_THROW(static_cast<void>(systems::read_model_text(scene.model, "model")));
}

}  // namespace
}  // namespace stored_model_test
