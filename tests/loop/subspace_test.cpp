#include "orbweaver/loop/symmetry/subspace.hpp"

#include <set>
#include <string>
#include <utility>

#include <gtest/gtest.h>
#include <Eigen/Dense>

#include "loop/samples.hpp"
#include "orbweaver/core/error.hpp"
#include "support/stated_system.hpp"

namespace orbweaver::loop::subspace_test {
namespace {

using test::element_of;
using test::random_values;

const systems::Structure& pendulum() { return test::structure_of("double_pendulum"); }
const systems::Structure& galaxy() { return test::structure_of("henon_heiles"); }

// Basis vectors as columns over all modes.
Eigen::MatrixXd basis_matrix(const Subspace& subspace) {
  Eigen::MatrixXd basis = Eigen::MatrixXd::Zero((2 * subspace.cutoff() + 1) * subspace.dimension(), subspace.size());
  for (int n = 0; n < subspace.size(); ++n)
    for (const Subspace::Entry& e : subspace.basis(n))
      basis(e.row * subspace.dimension() + e.coordinate, n) += e.weight;
  return basis;
}

// What an element does to all modes, column by column.
Eigen::MatrixXd action_matrix(const SymmetryElement& element, int dimension, int cutoff) {
  Loop loop = constant_loop(std::vector<double>(static_cast<std::size_t>(dimension), 0.0), 1.0, cutoff);
  const auto size = static_cast<Eigen::Index>(loop.modes.size());
  Eigen::MatrixXd action(size, size);
  for (Eigen::Index n = 0; n < size; ++n) {
    std::fill(loop.modes.begin(), loop.modes.end(), 0.0);
    loop.modes[static_cast<std::size_t>(n)] = 1.0;
    const Loop image = transformed(loop, element);
    action.col(n) = Eigen::Map<const Eigen::VectorXd>(image.modes.data(), size);
  }
  return action;
}

// Mean over the group that the elements generate: the projector onto what all of them leave alone.
Eigen::MatrixXd group_average(const Isotropy& isotropy, int dimension, int cutoff) {
  const Eigen::Index size = (2 * cutoff + 1) * dimension;
  std::vector<Eigen::MatrixXd> group{Eigen::MatrixXd::Identity(size, size)};
  for (std::size_t n = 0; n < group.size(); ++n)
    for (const SymmetryElement& g : isotropy) {
      const Eigen::MatrixXd product = action_matrix(g, dimension, cutoff) * group[n];
      const bool known = std::any_of(group.begin(), group.end(),
                                     [&](const Eigen::MatrixXd& m) { return (m - product).norm() < 1e-9; });
      if (!known) group.push_back(product);
    }
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(size, size);
  for (const Eigen::MatrixXd& m : group) sum += m;
  return sum / static_cast<double>(group.size());
}

struct Sample {
  std::string name;
  Isotropy isotropy;
};

std::vector<Sample> samples() {
  return {{"none", {}},
          {"paper", {element_of(pendulum(), "S", 1, 2), element_of(pendulum(), "R")}},
          {"antiperiodic", {element_of(pendulum(), "S", 1, 2)}},
          {"brake", {element_of(pendulum(), "R")}},
          {"shifted_reversor", {element_of(pendulum(), "RS", 1, 3)}},
          {"rotation", {element_of(galaxy(), "C", 1, 3)}},
          {"rotation_backwards", {element_of(galaxy(), "C", 2, 3), element_of(galaxy(), "RS")}},
          {"mirror", {element_of(galaxy(), "S", 1, 2), element_of(galaxy(), "R", 1, 4)}},
          {"slanted_mirror", {element_of(galaxy(), "SC"), element_of(galaxy(), "R")}}};
}

TEST(Subspace, UnrestrictedHasEveryModeOnItsOwn) {
  const Subspace all = Subspace::unrestricted(3, 4);
  ASSERT_EQ(all.size(), 3 * 9);
  std::set<std::pair<int, int>> seen;
  for (int n = 0; n < all.size(); ++n) {
    ASSERT_EQ(all.basis(n).size(), 1u);
    EXPECT_EQ(all.basis(n).front().weight, 1.0);
    seen.insert({all.basis(n).front().row, all.basis(n).front().coordinate});
  }
  EXPECT_EQ(seen.size(), 27u);
}

// Paper, section II D: cosines of the angles and sines of the velocities; section III B: odd harmonics only.
TEST(Subspace, PaperSubspaceIsAQuarterOfAllModes) {
  constexpr int cutoff = 9;
  const Subspace subspace(4, cutoff, {element_of(pendulum(), "S", 1, 2), element_of(pendulum(), "R")});
  std::set<std::pair<int, int>> expected;
  for (int k = 1; k <= cutoff; k += 2) {
    for (const int angle : {0, 1}) expected.insert({2 * k - 1, angle});
    for (const int velocity : {2, 3}) expected.insert({2 * k, velocity});
  }
  std::set<std::pair<int, int>> found;
  for (int n = 0; n < subspace.size(); ++n) {
    ASSERT_EQ(subspace.basis(n).size(), 1u);
    const Subspace::Entry& e = subspace.basis(n).front();
    EXPECT_EQ(e.weight, 1.0);
    EXPECT_EQ(subspace.harmonic(n) % 2, 1);
    found.insert({e.row, e.coordinate});
  }
  EXPECT_EQ(found, expected);
  EXPECT_EQ(subspace.size(), 4 * 5);
}

TEST(Subspace, BasesAreOrthonormal) {
  for (const Sample& s : samples()) {
    const Eigen::MatrixXd b = basis_matrix(Subspace(4, 7, s.isotropy));
    EXPECT_LT((b.transpose() * b - Eigen::MatrixXd::Identity(b.cols(), b.cols())).norm(), 1e-13) << s.name;
  }
}

TEST(Subspace, ProjectorIsTheMeanOverTheGroup) {
  for (const Sample& s : samples()) {
    const Eigen::MatrixXd b = basis_matrix(Subspace(4, 7, s.isotropy));
    const Eigen::MatrixXd projector = b * b.transpose();
    const Eigen::MatrixXd expected = group_average(s.isotropy, 4, 7);
    EXPECT_LT((projector - expected).norm(), 1e-12) << s.name;
    EXPECT_LT((projector * projector - projector).norm(), 1e-13) << s.name;
    EXPECT_NEAR(expected.trace(), static_cast<double>(b.cols()), 1e-9) << s.name;
  }
}

TEST(Subspace, BasisVectorsKeepToOneHarmonicInOrder) {
  for (const Sample& s : samples()) {
    const Subspace subspace(4, 7, s.isotropy);
    int last = 0;
    for (int n = 0; n < subspace.size(); ++n) {
      const int k = subspace.harmonic(n);
      EXPECT_GE(k, last) << s.name;
      for (const Subspace::Entry& e : subspace.basis(n)) EXPECT_EQ((e.row + 1) / 2, k) << s.name;
      last = k;
    }
  }
}

TEST(Subspace, RotationByAThirdHasTheCountOfItsRepresentation) {
  // At k = 0 mod 3 a third turn would have to fix the modes, and fixes none; at every other k four of eight remain.
  const Subspace subspace(4, 8, {element_of(galaxy(), "C", 1, 3)});
  std::vector<int> count(9, 0);
  for (int n = 0; n < subspace.size(); ++n) ++count[static_cast<std::size_t>(subspace.harmonic(n))];
  EXPECT_EQ(count, (std::vector<int>{0, 4, 4, 0, 4, 4, 0, 4, 4}));
}

TEST(Subspace, LoopsInItHaveTheSymmetryAtEveryTime) {
  const Isotropy isotropy{element_of(galaxy(), "C", 1, 3)};
  const Subspace subspace(4, 8, isotropy);
  const Loop loop = test::random_loop_in(subspace, constant_loop(std::vector<double>(4, 0.0), 3.0, 8), 31);
  const Eigen::MatrixXd& c = isotropy.front().map.matrix;
  for (const double t : {0.0, 0.37, 1.9, 2.71}) {
    const std::vector<double> now = state_at(loop, t);
    const std::vector<double> later = state_at(loop, t + loop.period / 3.0);
    const Eigen::VectorXd turned = c * Eigen::Map<const Eigen::VectorXd>(now.data(), 4);
    EXPECT_LT((turned - Eigen::Map<const Eigen::VectorXd>(later.data(), 4)).norm(), 1e-13);
  }
  const Loop brake = test::random_loop_in(Subspace(4, 8, {element_of(pendulum(), "R", 1, 4)}),
                                          constant_loop(std::vector<double>{0.2, -0.4, 0.0, 0.0}, 2.0, 8), 32);
  for (const double t : {0.0, 0.37, 1.9}) {
    const std::vector<double> mirrored = state_at(brake, brake.period / 4.0 - t);
    const std::vector<double> now = state_at(brake, t);
    EXPECT_LT(test::distance(mirrored, std::vector<double>{now[0], now[1], -now[2], -now[3]}), 1e-13);
  }
}

TEST(Subspace, SignSectorsAreComplementary) {
  const std::vector<Isotropy> groups{{element_of(pendulum(), "S", 1, 2), element_of(pendulum(), "R")},
                                     {element_of(pendulum(), "RS", 1, 2)},
                                     {element_of(galaxy(), "S", 1, 2), element_of(galaxy(), "R")},
                                     {element_of(galaxy(), "SC", 1, 2)}};
  for (const Isotropy& isotropy : groups) {
    std::vector<Eigen::MatrixXd> sectors;
    Eigen::Index total = 0;
    for (unsigned pattern = 0; pattern < (1u << isotropy.size()); ++pattern) {
      std::vector<int> signs;
      for (std::size_t n = 0; n < isotropy.size(); ++n) signs.push_back((pattern >> n & 1u) == 0u ? 1 : -1);
      sectors.push_back(basis_matrix(Subspace(4, 6, isotropy, signs)));
      total += sectors.back().cols();
      for (std::size_t n = 0; n < isotropy.size(); ++n) {
        const Eigen::MatrixXd& b = sectors.back();
        EXPECT_LT((action_matrix(isotropy[n], 4, 6) * b - signs[n] * b).norm(), 1e-12) << to_text(isotropy);
      }
    }
    EXPECT_EQ(total, 4 * 13) << to_text(isotropy);
    for (std::size_t a = 0; a < sectors.size(); ++a)
      for (std::size_t b = 0; b < a; ++b)
        EXPECT_LT((sectors[a].transpose() * sectors[b]).norm(), 1e-12) << to_text(isotropy);
  }
}

TEST(Subspace, PositiveSignsAreTheSubspaceItself) {
  const Isotropy isotropy{element_of(pendulum(), "S", 1, 2), element_of(pendulum(), "R")};
  EXPECT_EQ(basis_matrix(Subspace(4, 5, isotropy, std::vector<int>{1, 1})), basis_matrix(Subspace(4, 5, isotropy)));
}

// dz/ds of loops with g z = z has g w = w for equivariances, g w = -w for reversors.
TEST(Subspace, ImageHoldsTheDerivativesOfItsLoops) {
  for (const Sample& s : samples()) {
    const Subspace subspace(4, 7, s.isotropy);
    const Subspace image = subspace.image();
    const Eigen::MatrixXd b = basis_matrix(image);
    for (const SymmetryElement& g : s.isotropy)
      EXPECT_LT((action_matrix(g, 4, 7) * b - (g.reversing ? -1.0 : 1.0) * b).norm(), 1e-12) << s.name;
    const Loop loop = test::random_loop_in(subspace, constant_loop(std::vector<double>(4, 0.0), 1.0, 7), 35);
    Loop slope = loop;
    for (int i = 0; i < 4; ++i) slope.cosine(0, i) = 0.0;
    for (int k = 1; k <= 7; ++k)
      for (int i = 0; i < 4; ++i) {
        slope.cosine(k, i) = k * loop.sine(k, i);
        slope.sine(k, i) = -k * loop.cosine(k, i);
      }
    const Eigen::Map<const Eigen::VectorXd> modes(slope.modes.data(), 4 * 15);
    ASSERT_GT(modes.norm(), 0.1) << s.name;
    EXPECT_LT((b * (b.transpose() * modes) - modes).norm(), 1e-13 * modes.norm()) << s.name;
    EXPECT_EQ(basis_matrix(image.image()), basis_matrix(subspace)) << s.name;
  }
}

TEST(Subspace, ImageOfASectorFlipsItsSignsToo) {
  const Isotropy isotropy{element_of(pendulum(), "S", 1, 2), element_of(pendulum(), "R")};
  const Subspace image = Subspace(4, 5, isotropy, std::vector<int>{-1, -1}).image();
  EXPECT_EQ(basis_matrix(image), basis_matrix(Subspace(4, 5, isotropy, std::vector<int>{-1, 1})));
}

TEST(Subspace, CoordinatesAndModesAreTwoViewsOfOneVector) {
  const Subspace subspace(4, 7, {element_of(galaxy(), "C", 1, 3), element_of(galaxy(), "RS")});
  const Eigen::MatrixXd b = basis_matrix(subspace);
  const std::vector<double> x = random_values(static_cast<std::size_t>(subspace.size()), 33);
  std::vector<double> modes(4 * 15, 1.0);
  subspace.add_to(x, modes);
  const Eigen::VectorXd expected =
      b * Eigen::Map<const Eigen::VectorXd>(x.data(), subspace.size()) + Eigen::VectorXd::Ones(60);
  EXPECT_LT((Eigen::Map<const Eigen::VectorXd>(modes.data(), 60) - expected).norm(), 1e-14);
  const std::vector<double> any = random_values(60, 34);
  std::vector<double> coordinates(x.size());
  subspace.project(any, coordinates);
  const Eigen::VectorXd projected = b.transpose() * Eigen::Map<const Eigen::VectorXd>(any.data(), 60);
  EXPECT_LT((Eigen::Map<const Eigen::VectorXd>(coordinates.data(), subspace.size()) - projected).norm(), 1e-14);
}

TEST(SubspaceMisuse, IsRefused) {
  const SymmetryElement s = element_of(pendulum(), "S", 1, 2);
  EXPECT_THROW(Subspace(0, 3, {}), core::MisuseError);
  EXPECT_THROW(Subspace(4, 0, {}), core::MisuseError);
  EXPECT_THROW(Subspace(2, 3, {s}), core::MisuseError) << "another dimension";
  EXPECT_THROW(Subspace(4, 3, {s}, std::vector<int>{1, 1}), core::MisuseError) << "a sign too many";
  const Subspace subspace(4, 3, {s});
  std::vector<double> coordinates(static_cast<std::size_t>(subspace.size()));
  std::vector<double> too_few(coordinates.size() - 1);
  std::vector<double> modes(4 * 7);
  std::vector<double> short_modes(4 * 5);
  EXPECT_NO_THROW(subspace.add_to(coordinates, modes));
  EXPECT_THROW(subspace.add_to(too_few, modes), core::MisuseError);
  EXPECT_THROW(subspace.project(modes, too_few), core::MisuseError);
  EXPECT_THROW(subspace.add_to(coordinates, short_modes), core::MisuseError) << "modes of another cutoff";
  EXPECT_THROW(subspace.project(short_modes, coordinates), core::MisuseError) << "modes of another cutoff";
}

}  // namespace
}  // namespace orbweaver::loop::subspace_test
