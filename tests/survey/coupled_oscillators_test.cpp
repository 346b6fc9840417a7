// Two self-excited oscillators, of which one pulls at the other: the first one's cycle doubles its period twice along
// the other's excitation.
#include <array>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "orbweaver/systems/recorded_model.hpp"
#include "support/described.hpp"
#include "survey/atlas.hpp"
#include "survey/same_tree.hpp"
#include "survey/scenes.hpp"

namespace coupled_oscillators_test {

using namespace orbweaver;

class CoupledOscillators {
 public:
  static constexpr int dimension = 4;
  static constexpr int quantities = 0;

  static systems::ModelInfo info() {
    return test::described("coupled_oscillators", "two self-excited oscillators", {"x", "y", "vx", "vy"},
                           {"m", "n", "w", "k", "q", "g"});
  }

  static systems::Structure structure(const systems::Bound&) {
    systems::Structure structure = test::dissipative_structure(dimension);
    const Eigen::Matrix4d mirror = Eigen::Vector4d(-1, 1, -1, 1).asDiagonal();
    structure.equivariances = {{"S", mirror}};
    return structure;
  }

  template <class P>
  class With {
   public:
    explicit With(const systems::BoundTo<P>& bound)
        : _m(bound["m"]), _n(bound["n"]), _w(bound["w"]), _k(bound["k"]), _q(bound["q"]), _g(bound["g"]) {}

    template <class S>
    void field(const S* z, S* f) const {
      const S x = z[0], y = z[1], vx = z[2], vy = z[3];
      f[0] = vx;
      f[1] = vy;
      f[2] = vx * (-x * x - y * y * _q + _m) - x - x * x * x * _g - x * y * _k;
      f[3] = vy * (-y * y - x * x * _q + _n) - y * _w * _w - x * x * _k;
    }

   private:
    P _m, _n, _w, _k, _q, _g;
  };
};

namespace {

test::Atlas atlas_with(const std::string& key) {
  systems::add_recorded<CoupledOscillators>();
  const core::Communicator comm;
  const scene::Scene scene =
      scene::load(ORBWEAVER_SOURCE_DIR "/drivers/scenes/van_der_pol.yaml",
                  {"system={name: coupled_oscillators, parameters: {m: 0.2, n: -0.3, w: 2.05, k: 0.5, q: 0.7, g: 0.2}}",
                   "starts={fixed_points: {grid: [[0], [0], [0], [0]]}}", "continuation.free=n", "survey.depth=2",
                   "survey.subharmonics=3", "limits.parameter=[-1, 2]", "limits.period=30", "compute.stability=true",
                   "continuation." + key});
  const survey::Summary summary = test::run(comm, scene, "coupled_oscillators");
  EXPECT_EQ(summary.failures, 0U) << testing::PrintToString(summary.failed_tasks);
  for (const survey::FindingSummary& line : summary.findings)
    EXPECT_EQ(line.severity, survey::Severity::cut) << line.text;
  return test::Atlas(summary.atlas);
}

// Beside its second fold D1 comes near D2. A step in which a multiplier passes 1, where the parameter does not turn and
// no orbit between has that multiplier, has gone over; so has one that was foreseen badly, and has no curve between its
// ends.
TEST(CoupledOscillators, StepsDoNotGoOverToTheOtherDoubling) {
  const test::Atlas usual = atlas_with("start=0.0087");
  const std::string first = "Equilibrium 1, Hopf point 1 D1";
  EXPECT_TRUE(usual.crossing(first, "fold-parameter", 6.04999234).has_value());
  EXPECT_TRUE(usual.crossing(first, "torus", 5.88402134).has_value());
  EXPECT_EQ(usual.crossings().rows(), 8U);
  for (const std::string key : {"start=0.0436", "step=0.1", "step=0.25"}) {
    SCOPED_TRACE(key);
    test::expect_same_tree(usual, atlas_with(key));
  }
}

}  // namespace
}  // namespace coupled_oscillators_test
