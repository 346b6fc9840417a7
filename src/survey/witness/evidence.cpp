#include "evidence.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "tasks/payload/keys.hpp"

namespace orbweaver::survey {

namespace {

/// How far where one family begins may be from the image of where another does, relative to 1 + its size: Newton's
/// method leaves rounding, and Hopf points are located to 1e-12 in parts of a step.
constexpr double same_beginning = 1e-8;

}  // namespace

Evidence::Evidence(const AtlasTree& tree_, std::shared_ptr<const systems::System> system_, const scene::Scene& scene_,
                   WitnessInput input)
    : tree(tree_),
      system(std::move(system_)),
      scene(scene_),
      known(std::move(input)),
      symmetries(loop::SymmetryGroup::of_space(system->structure())),
      index(tree_),
      means(tree_, *system, symmetries) {
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

std::vector<double> Evidence::beginning_of(int row) const {
  const auto hopf = known.beginnings.find(base_of(key(row)));
  if (hopf != known.beginnings.end()) return hopf->second;
  const int equilibrium = equilibrium_of(row);
  return equilibrium < 0 ? std::vector<double>{} : known.equilibria[static_cast<std::size_t>(equilibrium)];
}

bool Evidence::begins_at_image(const systems::AffineMap& map, int row, int other) const {
  const std::vector<double> from = beginning_of(row);
  const std::vector<double> to = beginning_of(other);
  const auto d = static_cast<std::size_t>(map.dimension());
  if (from.size() < d || from.size() != to.size()) return false;
  const Eigen::VectorXd image = map(Eigen::Map<const Eigen::VectorXd>(from.data(), static_cast<Eigen::Index>(d)));
  const double size = Eigen::Map<const Eigen::VectorXd>(to.data(), static_cast<Eigen::Index>(d)).norm();
  // A driven system rests at every phase of its drive: that of the symmetry does not count.
  const std::size_t resting = system->structure().driven ? d - 1 : d;
  double away = distance_between({image.data(), resting}, {to.data(), resting});
  for (std::size_t i = d; i < to.size(); ++i) away = std::fmax(away, std::abs(from[i] - to[i]));
  return away <= same_beginning * (1.0 + size);
}

bool Evidence::begin_at_images(int row, int other) const {
  if (begins_at_image(systems::AffineMap::identity(system->dimension()), row, other)) return false;
  return std::any_of(symmetries.elements().begin(), symmetries.elements().end(),
                     [&](const loop::SymmetryElement& element) { return begins_at_image(element.map, row, other); });
}

}  // namespace orbweaver::survey
