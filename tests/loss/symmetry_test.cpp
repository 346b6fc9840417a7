// The flow commutes with a system's symmetries, so the residual of a symmetric loop has them too, its gradient lies in
// the subspace, and its Hessian falls apart into the sectors of signs.
#include <gtest/gtest.h>

#include "loop/samples.hpp"
#include "loss/cases.hpp"
#include "orbweaver/loop/curve/measures.hpp"
#include "orbweaver/loop/grid/fourier.hpp"
#include "orbweaver/loss/dense.hpp"
#include "orbweaver/loss/linearization.hpp"
#include "orbweaver/systems/registry.hpp"
#include "support/stated_system.hpp"

namespace orbweaver::loss::symmetry_test {
namespace {

using loop::Isotropy;
using loop::Subspace;
using test::element_of;

struct Sample {
  std::string system;
  Isotropy isotropy;
  std::vector<double> mean;
  loop::TimeMap map{};
  int cutoff = 6;  // the last harmonics are there for the map's
};

std::vector<Sample> samples() {
  const systems::Structure& pendulum = test::structure_of("double_pendulum");
  const systems::Structure& galaxy = test::structure_of("henon_heiles");
  const std::vector<double> origin(4, 0.0);
  const std::vector<double> inverted{0.0, std::numbers::pi, 0.0, 0.0};
  return {{"double_pendulum", {element_of(pendulum, "S", 1, 2), element_of(pendulum, "R")}, origin},
          {"double_pendulum", {element_of(pendulum, "S", 1, 2), element_of(pendulum, "R")}, inverted},
          {"double_pendulum", {element_of(pendulum, "RS", 1, 2)}, origin},
          {"double_pendulum", {element_of(pendulum, "R")}, {0.4, -1.0, 0.0, 0.0}},
          {"double_pendulum", {element_of(pendulum, "S", 1, 2), element_of(pendulum, "R")}, origin, {1.8, {}}},
          {"henon_heiles", {element_of(galaxy, "C", 1, 3)}, origin},
          {"henon_heiles", {element_of(galaxy, "C", 1, 3)}, origin, {1.0, {0.0, 0.0, 0.0, 0.0, 0.1, -0.05}}, 24},
          {"henon_heiles", {element_of(galaxy, "SC"), element_of(galaxy, "R", 1, 2)}, origin}};
}

loop::Loop symmetric_loop(const Sample& s) {
  loop::Loop out = test::random_loop_in(Subspace(4, 6, s.isotropy), loop::constant_loop(s.mean, 3.3, 6), 71);
  out = loop::with_cutoff(out, s.cutoff);
  out.time_map = s.map;
  return out;
}

// The residual as a loop with the modes of its trigonometric interpolant.
loop::Loop residual_loop(const Linearization& lin) {
  const int cutoff = lin.nodes() / 2 - 1;
  loop::Loop out = loop::constant_loop(std::vector<double>(4, 0.0), lin.period(), cutoff);
  const std::vector<double> nodal = lin.residual();
  lin.grid().analyze(cutoff, lin.dimension(), nodal.data(), out.modes.data());
  return out;
}

TEST(Symmetry, ResidualOfASymmetricLoopHasItsSymmetries) {
  for (const Sample& s : samples()) {
    const auto system = systems::make_system(s.system);
    const loop::Loop residual =
        residual_loop(Linearization(*system, symmetric_loop(s), Linearization::Order::residual));
    ASSERT_GT(loop::mean_distance(residual, loop::constant_loop(std::vector<double>(4, 0.0), 3.3, 1)), 1e-3);
    for (const loop::SymmetryElement& g : s.isotropy) {
      loop::Loop image = loop::transformed(residual, g);
      if (g.reversing)
        for (double& mode : image.modes) mode = -mode;
      EXPECT_LT(loop::mean_distance(image, residual), 1e-14) << s.system << " " << loop::to_text({g});
    }
  }
}

TEST(Symmetry, GradientStaysInTheSubspace) {
  for (const Sample& s : samples()) {
    const auto system = systems::make_system(s.system);
    const loop::Loop loop = symmetric_loop(s);
    const Linearization lin(*system, loop, Linearization::Order::jacobian);
    const Unknowns all{Subspace::unrestricted(4, loop.cutoff), {Scalar::period()}};
    std::vector<double> modes(loop.modes.size(), 0.0);
    const std::vector<double> gradient = lin.gradient(all);
    all.subspace.add_to(std::span(gradient).first(modes.size()), modes);
    const Unknowns own{Subspace(4, loop.cutoff, s.isotropy), {Scalar::period()}};
    const std::vector<double> reduced = lin.gradient(own);
    std::vector<double> back(modes.size(), 0.0);
    own.subspace.add_to(std::span(reduced).first(static_cast<std::size_t>(own.subspace.size())), back);
    ASSERT_GT(test::squared(modes), 1e-6);
    EXPECT_LT(test::distance(modes, back), 1e-13 * std::sqrt(test::squared(modes)))
        << s.system << " " << loop::to_text(s.isotropy);
    EXPECT_NEAR(reduced.back(), gradient.back(), 1e-14);
  }
}

TEST(Symmetry, HessianFallsApartIntoSectors) {
  const Sample s = samples().front();
  const auto system = systems::make_system(s.system);
  const loop::Loop loop = symmetric_loop(s);
  const Linearization lin(*system, loop, Linearization::Order::second);
  const Unknowns all{Subspace::unrestricted(4, loop.cutoff), {}};
  std::vector<Subspace> sectors;
  for (const std::vector<int>& signs : {std::vector<int>{1, 1}, {-1, 1}, {1, -1}, {-1, -1}})
    sectors.emplace_back(4, loop.cutoff, s.isotropy, signs);
  for (const Subspace& from : sectors) {
    const Eigen::VectorXd x = test::unit_direction(from.size(), 72);
    std::vector<double> v(loop.modes.size(), 0.0);
    from.add_to(test::view(x), v);
    std::vector<double> direction(static_cast<std::size_t>(all.size()));
    all.subspace.project(v, direction);
    const std::vector<double> image = lin.apply_hessian(all, direction, Curvature::full);
    std::vector<double> modes(loop.modes.size(), 0.0);
    all.subspace.add_to(image, modes);
    const double size = std::sqrt(test::squared(modes));
    for (const Subspace& to : sectors) {
      std::vector<double> part(static_cast<std::size_t>(to.size()));
      to.project(modes, part);
      const double share = std::sqrt(test::squared(part));
      if (&to == &from)
        EXPECT_NEAR(share, size, 1e-13 * size);
      else
        EXPECT_LT(share, 1e-13 * size);
    }
  }
}

TEST(Symmetry, LossIsTheSameForEveryImage) {
  const auto system = systems::make_system("henon_heiles");
  const loop::Loop loop = test::random_loop(4, 6, 73);
  const double loss = Linearization(*system, loop, Linearization::Order::residual).loss();
  const systems::Structure& galaxy = system->structure();
  for (const char* name : {"C", "CC", "S", "SC", "SCC", "R", "RS", "RSC", "RSCC"}) {
    const loop::Loop image = loop::transformed(loop, element_of(galaxy, name, 1, 5));
    EXPECT_NEAR(Linearization(*system, image, Linearization::Order::residual).loss(), loss, 1e-13 * loss) << name;
  }
}

}  // namespace
}  // namespace orbweaver::loss::symmetry_test
