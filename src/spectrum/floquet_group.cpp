#include "floquet_group.hpp"

#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>
#include <vector>

namespace orbweaver::spectrum {

namespace {

constexpr double same = 1e-9;

/// One product of generators; its time shift is `shift` / (common denominator).
struct Element {
  int shift;
  Eigen::MatrixXd matrix;
};

bool keeps_energy(const systems::System& system, const std::vector<double>& state, const systems::AffineMap& map) {
  if (!system.structure().conservative()) return true;
  const Eigen::VectorXd z = Eigen::Map<const Eigen::VectorXd>(state.data(), static_cast<Eigen::Index>(state.size()));
  const Eigen::VectorXd image = map(z);
  Eigen::VectorXd here(z.size());
  Eigen::VectorXd there(z.size());
  const std::size_t d = state.size();
  system.conserved_gradient(0, state, {here.data(), d});
  system.conserved_gradient(0, {image.data(), d}, {there.data(), d});
  return (map.matrix.transpose() * there - here).norm() < 1e-6 * here.norm();
}

/// Whether nodes equidistant in s stay such nodes under the element: the time map must share its symmetry.
bool keeps_nodes(const loop::TimeMap& map, const loop::SymmetryElement& element) {
  if (map.is_identity()) return true;
  const double shift = 2.0 * std::numbers::pi * element.shift_numerator / element.shift_denominator;
  const double sign = element.reversing ? -1.0 : 1.0;
  for (double s = 0.3; s < 6.0; s += 0.9)
    if (std::abs(map.phase(shift + sign * s) - shift - sign * map.phase(s)) > same) return false;
  return true;
}

int sum_modulo(int a, int b, int modulus) { return ((a + b) % modulus + modulus) % modulus; }

/// All products of `generators`, up to a number that no declared symmetry group reaches.
std::vector<Element> closure(const std::vector<Element>& generators, int denominator, Eigen::Index d) {
  constexpr std::size_t limit = 96;
  std::vector<Element> group{{0, Eigen::MatrixXd::Identity(d, d)}};
  for (std::size_t n = 0; n < group.size() && group.size() < limit; ++n) {
    for (const Element& generator : generators) {
      const Element product{sum_modulo(group[n].shift, generator.shift, denominator),
                            generator.matrix * group[n].matrix};
      bool known = false;
      for (const Element& element : group)
        known = known || (element.shift == product.shift && (element.matrix - product.matrix).norm() < same);
      if (!known) group.push_back(product);
    }
  }
  return group;
}

Eigen::MatrixXd power(const Eigen::MatrixXd& matrix, int exponent) {
  Eigen::MatrixXd result = Eigen::MatrixXd::Identity(matrix.rows(), matrix.cols());
  for (int n = 0; n < exponent; ++n) result = matrix * result;
  return result;
}

void set_generator(FundamentalGroup& group, int order, const Eigen::MatrixXd& generator) {
  group.order = order;
  group.generator = generator;
  group.inverse = generator.inverse();
  group.around = power(generator, order);
}

}  // namespace

FundamentalGroup fundamental_group(const systems::System& system, const loop::Loop& loop,
                                   const loop::Isotropy& isotropy) {
  const Eigen::Index d = system.dimension();
  const std::vector<double> state = loop::state_at(loop, 0.0);
  FundamentalGroup result;
  std::vector<const loop::SymmetryElement*> shifts;
  int denominator = 1;
  for (const loop::SymmetryElement& element : isotropy) {
    if (!keeps_nodes(loop.time_map, element)) continue;
    if (element.reversing) {
      if (!result.reversor) result.reversor = element;
    } else if (keeps_energy(system, state, element.map)) {
      shifts.push_back(&element);
      denominator = std::lcm(denominator, element.shift_denominator);
    }
  }
  std::vector<Element> generators;
  for (const loop::SymmetryElement* element : shifts) {
    const int shift = element->shift_numerator * (denominator / element->shift_denominator);
    generators.push_back({sum_modulo(shift, 0, denominator), element->map.matrix});
  }
  const std::vector<Element> group = closure(generators, denominator, d);
  int least = denominator;
  for (const Element& element : group)
    if (element.shift > 0) least = std::min(least, element.shift);
  const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(d, d);
  set_generator(result, 1, identity);
  for (const Element& element : group) {
    if (element.shift != least) continue;
    const bool closes = (power(element.matrix, denominator / least) - identity).norm() < same;
    if (result.order == 1 || closes) set_generator(result, denominator / least, element.matrix);
    if (closes) break;
  }
  result.grid_factor = std::lcm(result.order, result.reversor ? result.reversor->shift_denominator : 1);
  return result;
}

}  // namespace orbweaver::spectrum
