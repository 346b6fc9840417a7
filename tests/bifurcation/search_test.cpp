// Directions at crossings without reversors, or with those undeclared: found by a search.
#include <algorithm>
#include <tuple>

#include <gmock/gmock.h>

#include "bifurcation/crossings.hpp"
#include "born_orbit.hpp"
#include "orbweaver/bifurcation/directions.hpp"
#include "orbweaver/bifurcation/identity.hpp"
#include "orbweaver/certificate/certificate.hpp"
#include "orbweaver/loop/curve/measures.hpp"
#include "orbweaver/loop/symmetry/standard_phase.hpp"
#include "orbweaver/systems/registry.hpp"
#include "pushed_system.hpp"

namespace orbweaver::bifurcation::search_test {
namespace {

using test::Crossing;

/// A double pendulum that says only some of its symmetries: "S", "S R" or nothing.
std::shared_ptr<const systems::System> declaring(const std::shared_ptr<const systems::System>& system, bool mirror) {
  return std::make_shared<test::Declaring>(
      system, mirror ? system->structure().equivariances : std::vector<systems::Symmetry>{},
      std::vector<systems::Symmetry>{});
}

/// The family of an oscillation about the lower equilibrium, the slowest first.
test::Family family_of(const std::shared_ptr<const systems::System>& system, std::size_t mode_number,
                       double period_limit) {
  const std::vector<double> origin(4, 0.0);
  const starts::NormalMode mode = starts::sweep(*system, origin, {}).modes.at(mode_number);
  return test::family_from(system, {loop::constant_loop(origin, mode.period, 10), mode.direction, mode.isotropy},
                           period_limit);
}

const test::Family& in_phase() {
  static const test::Family family = family_of(test::pendulum(), 0, 10.3);
  return family;
}

/// Where a family of order q of the half map leaves: its orbit m times around.
Crossing crossing_of(const test::Family& family, double index, int times) {
  return test::crossing_at(*family.system, family.with_index(index), family.isotropy, times, 2);
}

/// The largest |part| of the direction along those of `lines`, all started at the same instant.
std::vector<double> overlaps(const loop::Tangent& tangent, const std::vector<std::vector<double>>& lines) {
  std::vector<double> out;
  for (const std::vector<double>& line : lines) {
    double sum = 0.0;
    for (std::size_t n = 0; n < std::min(line.size(), tangent.modes.size()); ++n) sum += tangent.modes[n] * line[n];
    out.push_back(std::abs(sum));
  }
  return out;
}

/// All images of the known directions under the half map and the shifts by a turn of the orbit, in the crossing's own
/// time.
std::vector<std::vector<double>> images(const Crossing& crossing, const std::vector<Direction>& known, int times) {
  std::vector<std::vector<double>> out;
  for (const Direction& direction : known) {
    loop::Loop v = direction.base;
    v.modes = direction.tangent.modes;
    // Find the start of the direction's base on the crossing's.
    for (int p = 0; p < 16 * times; ++p) {
      const double shift = p / (16.0 * times);
      if (loop::mean_distance(loop::time_shifted(direction.base, shift), crossing.base) > 1e-6) continue;
      for (int turn = 0; turn < 2 * times; ++turn)
        out.push_back(loop::time_shifted(v, shift + turn / (2.0 * times)).modes);
      break;
    }
  }
  return out;
}

/// A search without declared reversors finds the directions that the reversors give.
void expect_same_by_search(const test::Family& family, const Crossing& crossing, int times, bool mirror,
                           std::size_t count, const std::string& isotropy) {
  const std::vector<Direction> known =
      directions(*family.system, crossing.base, family.isotropy, crossing.kernel).found;
  const auto fewer = declaring(family.system, mirror);
  const std::vector<Direction> found = directions(*fewer, crossing.base, {}, crossing.kernel).found;
  ASSERT_EQ(found.size(), count);
  // Modes of vectors shifted by half a turn carry the mirror, which changes a sign only.
  const std::vector<std::vector<double>> lines = images(crossing, known, times);
  for (const Direction& direction : found) {
    EXPECT_GT(direction.amplitude, 0.0);
    EXPECT_EQ(loop::to_text(direction.isotropy), isotropy);
    // The tangent is the whole way to an orbit: its part in the kernel is what points along a line.
    const std::vector<double> parts = overlaps(direction.tangent, lines);
    double in_kernel = 0.0;
    for (const loop::Tangent& v : crossing.kernel) {
      const double part = overlaps(direction.tangent, {loop::with_cutoff(v, direction.base.cutoff, 4).modes}).front();
      in_kernel += part * part;
    }
    EXPECT_GT(in_kernel, 0.9);
    EXPECT_GT(*std::max_element(parts.begin(), parts.end()), std::cos(0.02) * std::sqrt(in_kernel));
    EXPECT_EQ(direction.both_sides, known.front().both_sides);
  }
}

/// Another basis of the kernel's plane, and another start of the crossing's orbit.
Crossing seen_otherwise(const Crossing& crossing, double angle, bool reflected, double start) {
  Crossing out{loop::time_shifted(crossing.base, start), {}};
  const double sign = reflected ? -1.0 : 1.0;
  for (const auto& [first, second] :
       {std::pair(std::cos(angle), std::sin(angle)), std::pair(-sign * std::sin(angle), sign * std::cos(angle))}) {
    loop::Loop vector = crossing.base;
    for (std::size_t n = 0; n < vector.modes.size(); ++n)
      vector.modes[n] = first * crossing.kernel[0].modes[n] + second * crossing.kernel[1].modes[n];
    out.kernel.push_back({loop::time_shifted(vector, start).modes, {}});
  }
  return out;
}

/// The part of the direction along the image of a known one that it is nearest to, either way.
double part_along(const loop::Tangent& tangent, const std::vector<std::vector<double>>& lines) {
  double farthest = 0.0;
  for (const std::vector<double>& line : lines) {
    double sum = 0.0;
    for (std::size_t n = 0; n < std::min(line.size(), tangent.modes.size()); ++n) sum += tangent.modes[n] * line[n];
    if (std::abs(sum) > std::abs(farthest)) farthest = sum;
  }
  return farthest;
}

struct Order {
  double m2;
  double index;
  int times;
};

class SeenOtherwise : public testing::TestWithParam<Order> {};

// Kernel vectors are any basis of their plane, and rounding decides which. Which of twins is the first, and which side
// of a single curve is +, does not hang on it, nor on where the crossing's orbit starts.
TEST_P(SeenOtherwise, TwinsAndSidesAreTheSame) {
  const auto& [m2, index, times] = GetParam();
  const auto system = systems::make_system("double_pendulum", {{"m2", m2}});
  const test::Family family = family_of(system, 0, 10.3);
  const Crossing crossing = crossing_of(family, index, times);
  const std::vector<Direction> known = directions(*system, crossing.base, family.isotropy, crossing.kernel).found;
  const auto fewer = declaring(system, true);
  std::vector<int> first;
  for (const auto& [angle, reflected, start] :
       {std::tuple(0.0, false, 0.0), std::tuple(0.7, false, 0.0), std::tuple(1.6, true, 0.0),
        std::tuple(2.9, true, 0.3), std::tuple(4.4, false, 0.8)}) {
    SCOPED_TRACE(angle);
    const Crossing seen = seen_otherwise(crossing, angle, reflected, start);
    const std::vector<Direction> found = directions(*fewer, seen.base, {}, seen.kernel).found;
    ASSERT_EQ(found.size(), known.size());
    loop::Loop back = found.front().base;
    back.modes = found.front().tangent.modes;
    const loop::Tangent tangent{loop::time_shifted(back, -start).modes, {}};
    if (known.size() == 1) {
      // The mirror that belongs to an odd number of half turns changes all signs.
      std::vector<std::vector<double>> lines = images(crossing, known, times);
      for (std::size_t turn = 1; turn < lines.size(); turn += 2)
        for (double& v : lines[turn]) v = -v;
      first.push_back(part_along(tangent, lines) > 0.0 ? 1 : -1);
    } else {
      const double to_first = std::abs(part_along(tangent, images(crossing, {known[0]}, times)));
      const double to_second = std::abs(part_along(tangent, images(crossing, {known[1]}, times)));
      EXPECT_GT(std::abs(to_first - to_second), 0.01);
      first.push_back(to_first > to_second ? 0 : 1);
    }
  }
  EXPECT_THAT(first, testing::Each(first.front()));
}

INSTANTIATE_TEST_SUITE_P(Search, SeenOtherwise,
                         testing::Values(Order{1.0, 0.0, 2}, Order{1.0, 1.0, 3}, Order{0.87, -1.0, 3},
                                         Order{1.0, 2.0 * std::cos(2.0 * std::numbers::pi / 5.0), 5}));

TEST(PushedSystem, KeepsTheEnergyAndChangesTheField) {
  const auto system = systems::make_system("henon_heiles", {}, {});
  const std::vector<double> centre{0.1, 0.0, -0.2, 0.0};
  const PushedSystem still(*system, centre);
  const auto pushed = still.with_parameters({{PushedSystem::push, 0.3}});
  const std::vector<double> z{0.3, -0.1, 0.2, 0.15};
  std::vector<double> f(4), g(4), by_push(4), gradient(4);
  system->field(1, z.data(), f.data());
  pushed->field(1, z.data(), g.data());
  still.parameter_derivatives(PushedSystem::push, 1, z.data(), by_push.data());
  system->conserved_gradient(0, z, gradient);
  double along = 0.0;
  double change = 0.0;
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(g[i], f[i] + 0.3 * by_push[i], 1e-15);
    along += gradient[i] * g[i];
    change += std::abs(by_push[i]);
  }
  EXPECT_NEAR(along, 0.0, 1e-15);
  EXPECT_GT(change, 0.1);
  std::vector<double> unpushed(4);
  still.field(1, z.data(), unpushed.data());
  EXPECT_EQ(unpushed, f);
}

TEST(Search, FindsBothFamiliesOfADoublingPoint) {
  const Crossing crossing = crossing_of(in_phase(), 0.0, 2);
  EXPECT_NEAR(crossing.base.period, 2 * 8.442930704977588, 1e-8);
  expect_same_by_search(in_phase(), crossing, 2, true, 2, "");
}

TEST(Search, FindsTheirImagesTooWhereTheHalfMapIsUnknown) {
  expect_same_by_search(in_phase(), crossing_of(in_phase(), 0.0, 2), 2, false, 4, "");
}

// e^{2 pi i / 6}: six rotations, three turns, the angle fixed by terms of order 4 only.
TEST(Search, FindsBothFamiliesOfOrderSix) {
  const Crossing crossing = crossing_of(in_phase(), 1.0, 3);
  const std::vector<Direction> known =
      directions(*test::pendulum(), crossing.base, in_phase().isotropy, crossing.kernel).found;
  ASSERT_EQ(known.size(), 2u);
  EXPECT_EQ(loop::to_text(known[0].isotropy), "R@0");
  EXPECT_EQ(loop::to_text(known[1].isotropy), "RS@0");
  expect_same_by_search(in_phase(), crossing, 3, true, 2, "");
}

// e^{2 pi i / 5}: one curve, whose sides are different orbits; S and the reversors stay.
TEST(Search, FindsTheOneFamilyOfOrderFive) {
  const Crossing crossing = crossing_of(in_phase(), 2.0 * std::cos(2.0 * std::numbers::pi / 5.0), 5);
  const std::vector<Direction> known =
      directions(*test::pendulum(), crossing.base, in_phase().isotropy, crossing.kernel).found;
  ASSERT_EQ(known.size(), 1u);
  EXPECT_EQ(loop::to_text(known[0].isotropy), "S@1/2 R@0");
  EXPECT_TRUE(known[0].both_sides);
  expect_same_by_search(in_phase(), crossing, 5, true, 1, "S@1/2");
}

// With m2 = 0.87 the slow family begins at an index below -1 and passes it.
TEST(Search, FindsTheOneFamilyOfOrderThree) {
  const auto system = systems::make_system("double_pendulum", {{"m2", 0.87}});
  const test::Family family = family_of(system, 0, 10.0);
  ASSERT_LT(family.index_of(family.orbits.front().loop), -1.0);
  const Crossing crossing = crossing_of(family, -1.0, 3);
  const std::vector<Direction> known = directions(*system, crossing.base, family.isotropy, crossing.kernel).found;
  ASSERT_EQ(known.size(), 1u);
  EXPECT_EQ(loop::to_text(known[0].isotropy), "S@1/2 R@0");
  EXPECT_TRUE(known[0].both_sides);
  expect_same_by_search(family, crossing, 3, true, 1, "S@1/2");
  // The born orbits start where the first coordinate is largest, wherever the crossing's orbit starts.
  Crossing later{loop::time_shifted(crossing.base, 0.5), {}};
  for (const loop::Tangent& v : crossing.kernel) {
    loop::Loop vector = crossing.base;
    vector.modes = v.modes;
    later.kernel.push_back({loop::time_shifted(vector, 0.5).modes, {}});
  }
  EXPECT_LT(loop::state_at(later.base, 0.0)[0], -0.1);
  const std::vector<Direction> again = directions(*system, later.base, family.isotropy, later.kernel).found;
  ASSERT_EQ(again.size(), 1u);
  EXPECT_EQ(loop::to_text(again[0].isotropy), "S@1/2 R@0");
  EXPECT_LT(loop::mean_distance(again[0].base, known[0].base), 1e-9);
}

/// IB: the family that leaves the in-phase one at T = 10.4168. It has S@1/2 and no reversor.
const test::Family& without_reversors() {
  static const test::Family family = [] {
    const test::Family longer = family_of(test::pendulum(), 0, 10.6);
    const loop::Loop orbit = longer.at_period(longer.orbits.back().loop, 10.416773281973249);
    const Crossing crossing = test::crossing_at(*test::pendulum(), orbit, longer.isotropy, 1, 1);
    const Direction start = directions(*test::pendulum(), crossing.base, longer.isotropy, crossing.kernel).found.at(0);
    return test::family_from(test::pendulum(), {start.base, start.tangent, start.isotropy}, 10.6);
  }();
  return family;
}

/// The first orbits of a born family as a survey starts it, at the phases of the archive.
std::vector<continuation::Orbit> first_two(const Direction& direction) {
  loop::Loop step = direction.base;
  step.modes = direction.tangent.modes;
  double square = 0.0;
  for (const double v : loop::state_at(step, 0.0)) square += v * v;
  continuation::Options options;
  options.start_amplitude = direction.amplitude * std::sqrt(square);
  options.step_limit = 2;
  std::vector<continuation::Orbit> orbits =
      test::trace_of(test::pendulum(), {direction.base, direction.tangent, direction.isotropy}, options).orbits;
  for (continuation::Orbit& orbit : orbits)
    orbit.loop = loop::in_standard_phase(test::pendulum()->structure(), orbit.loop, direction.isotropy);
  return orbits;
}

class WithoutReversors : public testing::TestWithParam<int> {};

// To leading order the orbits stand where cos(q angle + const) is largest and smallest: pi/q apart, modulo 2 pi/q.
TEST_P(WithoutReversors, TwoFamiliesOfEvenOrderLeaveHalfAnAngleApart) {
  const int q = GetParam();
  const int times = q / 2;
  const double angle = 2.0 * std::numbers::pi / q;
  const Crossing crossing = crossing_of(without_reversors(), 2.0 * std::cos(angle), times);
  const std::vector<Direction> found =
      directions(*test::pendulum(), crossing.base, without_reversors().isotropy, crossing.kernel).found;
  ASSERT_EQ(found.size(), 2u);
  std::vector<corrector::Result> born;
  for (const Direction& direction : found) {
    EXPECT_EQ(loop::to_text(direction.isotropy), "");
    EXPECT_FALSE(direction.both_sides);
    EXPECT_FALSE(direction.is_hidden);
    born.push_back(born_orbit(*test::pendulum(), direction.base, direction.tangent, {}, direction.amplitude));
    ASSERT_TRUE(born.back().converged()) << born.back().detail;
    EXPECT_LT(certificate::certify(*test::pendulum(), born.back().loop).closure, 1e-9);
    // A quarter further out the direction is still the same: an angle that nothing fixes would drift.
    const corrector::Result further =
        born_orbit(*test::pendulum(), direction.base, direction.tangent, {}, 1.25 * direction.amplitude);
    ASSERT_TRUE(further.converged()) << further.detail;
    for (const loop::Tangent& v : crossing.kernel) {
      double near = 0.0;
      double far = 0.0;
      for (std::size_t n = 0; n < v.modes.size(); ++n) {
        near += v.modes[n] * (born.back().loop.modes[n] - crossing.base.modes[n]) / direction.amplitude;
        far += v.modes[n] * (further.loop.modes[n] - crossing.base.modes[n]) / (1.25 * direction.amplitude);
      }
      EXPECT_NEAR(near, far, 0.1 * angle);
    }
  }
  loop::Loop v = crossing.base;
  v.modes = found[1].tangent.modes;
  std::vector<std::vector<double>> images;
  for (int turn = 0; turn < q; ++turn) images.push_back(loop::time_shifted(v, turn / static_cast<double>(q)).modes);
  const std::vector<double> parts = overlaps(found[0].tangent, images);
  EXPECT_NEAR(std::acos(*std::max_element(parts.begin(), parts.end())), 0.5 * angle, 0.1 * angle);
  EXPECT_FALSE(loop::find_map(test::pendulum()->structure(), born[0].loop, born[1].loop, 1e-3, q).has_value());

  // So weakly is the angle held that Newton's method may go from a point near the first orbit of the one to that of the
  // other (with the phases of the archive it does, for q = 8). They are not one family for that.
  for (const std::size_t one : {0U, 1U}) {
    const std::vector<continuation::Orbit> orbits = first_two(found[one]);
    const continuation::Orbit other = first_two(found[1 - one])[0];
    const Comparison same = same_family(*test::pendulum(), orbits[0], orbits[1], {}, other);
    EXPECT_FALSE(same.same) << same.distance << " at " << same.position;
    const Comparison own = same_family(*test::pendulum(), orbits[0], orbits[1], {}, orbits[0]);
    EXPECT_TRUE(own.same) << own.detail;
  }
}

INSTANTIATE_TEST_SUITE_P(Search, WithoutReversors, testing::Values(6, 8));

// The orbits to the two sides lie opposite to each other in the kernel, and both beside it in the same direction.
TEST(Search, KnowsTheWaysToBothSidesWhereTheOrderIsOdd) {
  const Crossing crossing = crossing_of(without_reversors(), 2.0 * std::cos(2.0 * std::numbers::pi / 5.0), 5);
  const std::vector<Direction> found =
      directions(*test::pendulum(), crossing.base, without_reversors().isotropy, crossing.kernel).found;
  ASSERT_EQ(found.size(), 1u);
  const Direction& direction = found[0];
  EXPECT_TRUE(direction.both_sides);
  ASSERT_FALSE(direction.opposite.empty());
  Eigen::MatrixXd inside(2, 2);
  Eigen::Vector2d of_period;
  std::vector<loop::Loop> orbits;
  for (const int side : {1, -1}) {
    const loop::Tangent way = direction.way(side);
    for (std::size_t n = 0; n < 2; ++n) {
      const loop::Tangent v = loop::with_cutoff(crossing.kernel[n], direction.base.cutoff, direction.base.dimension);
      inside(static_cast<Eigen::Index>(n), side > 0 ? 0 : 1) =
          std::inner_product(v.modes.begin(), v.modes.end(), way.modes.begin(), 0.0);
    }
    of_period(side > 0 ? 0 : 1) = way.period();
    const corrector::Result born =
        born_orbit(*test::pendulum(), direction.base, way, direction.isotropy, direction.amplitude);
    ASSERT_TRUE(born.converged()) << born.detail;
    EXPECT_LT(loop::mean_distance(born.loop, loop::moved(direction.base, way, direction.amplitude)),
              1e-6 * direction.amplitude);
    orbits.push_back(born.loop);
  }
  EXPECT_NEAR(inside.col(0).normalized().dot(inside.col(1).normalized()), -1.0, 1e-6);
  EXPECT_GT(of_period(0) * of_period(1), 0.0);
  EXPECT_FALSE(loop::find_map(test::pendulum()->structure(), orbits[0], orbits[1], 1e-3, 10).has_value());
}

// On OB, from the out-phase family at T = 6.1475, the terms that fix the angle are weak: solves stall nearby.
TEST(Search, GoesFurtherOutWhereTheAngleIsHardlyFixed) {
  const test::Family family = family_of(test::pendulum(), 1, 6.3);
  const Crossing branch_point = test::crossing_at(*test::pendulum(), family.with_index(2.0), family.isotropy, 1, 1);
  EXPECT_NEAR(branch_point.base.period, 6.1475153497, 1e-8);
  const Direction start =
      directions(*test::pendulum(), branch_point.base, family.isotropy, branch_point.kernel).found.at(0);
  EXPECT_EQ(loop::to_text(start.isotropy), "S@1/2");
  const test::Family born = test::family_from(test::pendulum(), {start.base, start.tangent, start.isotropy}, 6.148);
  const Crossing crossing = crossing_of(born, 1.0, 3);
  const std::vector<Direction> found =
      directions(*test::pendulum(), crossing.base, born.isotropy, crossing.kernel).found;
  ASSERT_EQ(found.size(), 2u);
  for (const Direction& direction : found) {
    EXPECT_GT(direction.amplitude, 0.05);
    EXPECT_FALSE(direction.both_sides);
    const corrector::Result orbit =
        born_orbit(*test::pendulum(), direction.base, direction.tangent, direction.isotropy, direction.amplitude);
    ASSERT_TRUE(orbit.converged()) << orbit.detail;
    EXPECT_LT(certificate::certify(*test::pendulum(), orbit.loop).closure, 1e-9);
  }
}

}  // namespace
}  // namespace orbweaver::bifurcation::search_test
