#include "evidence.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "orbweaver/loop/symmetry/symmetry_group.hpp"
#include "tasks/payload/keys.hpp"

namespace orbweaver::survey {

namespace {

/// How far an equilibrium may be from the image of another, relative to 1 + its size: Newton's method leaves rounding.
constexpr double same_equilibrium = 1e-8;

}  // namespace

Evidence::Evidence(const AtlasTree& tree_, std::shared_ptr<const systems::System> system_, const scene::Scene& scene_,
                   WitnessInput input)
    : tree(tree_), system(std::move(system_)), scene(scene_), known(std::move(input)), index(tree_) {
  const auto to_row = [&](int& crossing) {
    if (crossing >= 0) crossing = known.crossing_rows[static_cast<std::size_t>(crossing)];
  };
  for (CrossingEvidence& crossing : known.tree.crossings) to_row(crossing.crossing);
  for (EndEvidence& end : known.tree.ends) {
    to_row(end.crossing);
    for (int& nearby : end.nearby) to_row(nearby);
  }
  for (const FailureEvidence& failure : known.tree.failures) failed.insert(row_of(failure.family));
}

Severity Evidence::severity_about(int row) const {
  if (known.stopped_early) return Severity::cut;
  return failed.contains(row) ? Severity::undecided : Severity::contradiction;
}

int Evidence::row_of(const std::string& key) const {
  const auto found = std::lower_bound(known.family_keys.begin(), known.family_keys.end(), key);
  if (found == known.family_keys.end() || *found != key) return -1;
  return static_cast<int>(found - known.family_keys.begin());
}

int Evidence::equilibrium_of(int row) const {
  const int equilibrium = equilibrium_index(key(row));
  return equilibrium < static_cast<int>(known.equilibria.size()) ? equilibrium : -1;
}

double Evidence::distance_between(std::span<const double> point, std::span<const double> other) const {
  double largest = 0.0;
  for (std::size_t i = 0; i < point.size(); ++i) {
    double away = point[i] - other[i];
    if (system->structure().is_angle(i)) away = std::remainder(away, 2.0 * std::numbers::pi);
    largest = std::fmax(largest, std::abs(away));
  }
  return largest;
}

bool Evidence::is_image_by(const systems::AffineMap& map, int equilibrium, int other) const {
  const std::vector<double>& from = known.equilibria[static_cast<std::size_t>(equilibrium)];
  const std::vector<double>& to = known.equilibria[static_cast<std::size_t>(other)];
  const Eigen::VectorXd image =
      map(Eigen::Map<const Eigen::VectorXd>(from.data(), static_cast<Eigen::Index>(from.size())));
  const double size = Eigen::Map<const Eigen::VectorXd>(to.data(), static_cast<Eigen::Index>(to.size())).norm();
  return distance_between({image.data(), to.size()}, to) <= same_equilibrium * (1.0 + size);
}

bool Evidence::are_images(int equilibrium, int other) const {
  if (equilibrium < 0 || other < 0 || equilibrium == other) return false;
  const loop::SymmetryGroup group = loop::SymmetryGroup::of_space(system->structure());
  return std::any_of(group.elements().begin(), group.elements().end(), [&](const loop::SymmetryElement& element) {
    return is_image_by(element.map, equilibrium, other);
  });
}

}  // namespace orbweaver::survey
