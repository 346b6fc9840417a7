#include "orbweaver/starts/natural_scales.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <utility>

#include <Eigen/Eigenvalues>

#include "drive_averaged.hpp"
#include "graded_spectrum.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/core/interruption.hpp"
#include "orbweaver/numerics/decompositions.hpp"
#include "orbweaver/starts/fixed_points.hpp"
#include "orbweaver/systems/scaled_system.hpp"
#include "second_derivatives.hpp"

namespace orbweaver::starts {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Of the largest entry of a balanced matrix, or an eigenvalue's size: what is smaller is rounding, or the square root
/// of it at a Jordan block, and couples or scales nothing.
constexpr double rounding_entry = 1e-10;
constexpr double negligible_eigenvalue = 1e-7;
/// Sweeps of the balancing: it converges within some ten, unless nothing couples one way, where no scale is best.
constexpr int most_sweeps = 200;
constexpr double balanced_to = 1e-9;
/// log2 of the amplitudes between which a field departs from its linearisation, in the system's units: beyond, it is
/// linear. Their steps, and how finely the amplitude is bisected: it is rounded to a power of two.
constexpr double least_amplitude = -60.0;
constexpr double largest_amplitude = 60.0;
constexpr double amplitude_step = 1.0;
constexpr int bisections = 20;
/// A coordinate along which the field departs at more than 2^this times the least amplitude of its component has no
/// say: a weak term that depends on it alone (a magnetic field's on the momenta) would set the scale of all. Not
/// measured.
constexpr double late_departure = 3.0;
/// Of the mean rate: a component whose linear field is slower, as at a branch point, where it vanishes, departs from
/// this. Not measured.
constexpr double least_rate = 1e-4;
/// Grid points at which scales for the search of equilibria are taken, spread over the grid.
constexpr std::size_t most_grid_points = 64;

/// Logarithms (base 2) of the scales that one state lets expect; NaN where it says nothing.
struct LogScales {
  double time = std::numeric_limits<double>::quiet_NaN();
  VectorXd coordinates;
};

/// Geometric means, in logarithms, of what says something.
class Mean {
 public:
  void add(double log) {
    if (!std::isfinite(log)) return;
    _sum += log;
    _count += 1.0;
  }
  [[nodiscard]] bool any() const { return _count > 0.0; }
  [[nodiscard]] double log() const { return _sum / _count; }

 private:
  double _sum = 0.0;
  double _count = 0.0;
};

/// The Jacobian at one state, in balanced coordinates.
class LocalScales {
 public:
  /// Of a driven system the mean over its drive, and what it is the mean of.
  LocalScales(const systems::System& system, VectorXd point, const DriveAveraged* driven)
      : _system(system),
        _driven(driven),
        _point(std::move(point)),
        _first(systems::mixed_coordinates(system.structure())) {}

  /// None where the field is not finite.
  [[nodiscard]] std::optional<LogScales> find() {
    const Index d = _point.size();
    std::optional<MatrixXd> jacobian = jacobian_at(_point);
    if (!jacobian) return std::nullopt;
    if (_driven != nullptr) jacobian = _driven->strength(_point);
    if (!jacobian->allFinite()) return std::nullopt;
    _log = VectorXd::Zero(d);
    balance(jacobian->cwiseAbs2(), false);
    const MatrixXd balanced = without_rounding(in_scales(*jacobian));
    const Index own = _system.structure().driven ? d - 1 : d;  // a drive's phase has no rate of its own
    const double rate = mean_rate(balanced.topLeftCorner(own, own));
    LogScales out;
    out.coordinates = VectorXd::Constant(d, std::numeric_limits<double>::quiet_NaN());
    if (!(rate > 0.0)) return out;
    out.time = -std::log2(rate);
    // What time does forwards and backwards counts alike: fast and slow modes have the same say.
    MatrixXd weights = (balanced / rate).cwiseAbs2();
    const MatrixXd inverse = Eigen::PartialPivLU<MatrixXd>(balanced.topLeftCorner(own, own)).inverse();
    if (_invertible && inverse.allFinite())
      weights.topLeftCorner(own, own) += (without_rounding(inverse) * rate).cwiseAbs2();
    for (Index i = 0; i < d; ++i)  // back in the units
      for (Index l = 0; l < d; ++l) weights(i, l) *= std::exp2(2.0 * (_log(i) - _log(l)));
    for (const int angle : _system.structure().angles) _log(angle) = 0.0;
    balance(weights, true);
    _least_rate = least_rate * rate;
    find_amplitudes(without_rounding(in_scales(*jacobian)), rate, out.coordinates);
    return out;
  }

 private:
  [[nodiscard]] std::optional<MatrixXd> jacobian_at(const VectorXd& z) const {
    VectorXd f(z.size());
    RowMajor jacobian(z.size(), z.size());
    _system.field_jacobian(1, z.data(), f.data(), jacobian.data());
    if (!f.allFinite() || !jacobian.allFinite()) return std::nullopt;
    return jacobian;
  }

  [[nodiscard]] MatrixXd in_scales(MatrixXd matrix) const {
    for (Index i = 0; i < matrix.rows(); ++i)
      for (Index l = 0; l < matrix.cols(); ++l)
        if (matrix(i, l) != 0.0) matrix(i, l) *= std::exp2(_log(l) - _log(i));
    return matrix;
  }

  static MatrixXd without_rounding(MatrixXd matrix) {
    const double least = rounding_entry * matrix.cwiseAbs().maxCoeff();
    return (matrix.cwiseAbs().array() < least).select(0.0, matrix);
  }

  /// Geometric mean of the moduli of the eigenvalues that do not vanish. In a dissipative system, if any oscillate, of
  /// those: what decays faster is gone before an oscillation is over.
  [[nodiscard]] double mean_rate(const MatrixXd& balanced) {
    const std::optional<GradedSpectrum> spectrum = graded_spectrum(balanced, false);
    if (!spectrum) return 0.0;
    Mean all;
    Mean oscillating;
    _invertible = true;
    for (Index i = 0; i < spectrum->values.size(); ++i) {
      const double modulus = std::abs(spectrum->values(i));
      if (!(modulus > negligible_eigenvalue * spectrum->sizes(i))) {
        _invertible = false;
        continue;
      }
      all.add(std::log2(modulus));
      if (spectrum->values(i).imag() != 0.0) oscillating.add(std::log2(modulus));
    }
    const Mean& mean = _system.structure().dissipative && oscillating.any() ? oscillating : all;
    return mean.any() ? std::exp2(mean.log()) : 0.0;
  }

  /// Osborne's balancing (1960, doi:10.1145/321043.321048): the scales s that make the sum of weights_il s_l^2/s_i^2
  /// least, equal ones for coordinates that a symmetry mixes, and those of angles as they are if `angles_stay`.
  void balance(const MatrixXd& weights, bool angles_stay) {
    const Index d = _log.size();
    for (int sweep = 0; sweep < most_sweeps; ++sweep) {
      double largest = 0.0;
      for (Index first = 0; first < d; ++first) {
        if (group(first) != first || (angles_stay && has_angle(first))) continue;
        double row = 0.0;
        double column = 0.0;
        for (Index i = 0; i < d; ++i)
          for (Index l = 0; l < d; ++l) {
            if (weights(i, l) == 0.0 || (group(i) == first) == (group(l) == first)) continue;
            (group(i) == first ? row : column) += weights(i, l) * std::exp2(2.0 * (_log(l) - _log(i)));
          }
        if (row == 0.0 || column == 0.0) continue;
        const double change = 0.25 * (std::log2(row) - std::log2(column));
        for (Index i = first; i < d; ++i)
          if (group(i) == first) _log(i) += change;
        largest = std::max(largest, std::abs(change));
      }
      if (largest < balanced_to) return;
    }
  }

  [[nodiscard]] Index group(Index i) const { return static_cast<Index>(_first[static_cast<std::size_t>(i)]); }

  [[nodiscard]] bool has_angle(Index first) const {
    for (Index i = first; i < _log.size(); ++i)
      if (group(i) == first && _system.structure().is_angle(static_cast<std::size_t>(i))) return true;
    return false;
  }

  /// For each coordinate the first of those that the linear field, or a symmetry, couples to it.
  [[nodiscard]] std::vector<Index> components(const MatrixXd& balanced) const {
    const Index d = balanced.rows();
    std::vector<Index> label;
    for (Index i = 0; i < d; ++i) label.push_back(group(i));
    for (bool settled = false; !settled;) {
      settled = true;
      for (Index i = 0; i < d; ++i)
        for (Index l = 0; l < d; ++l) {
          Index& a = label[static_cast<std::size_t>(i)];
          Index& b = label[static_cast<std::size_t>(l)];
          if (a == b || (balanced(i, l) == 0.0 && group(i) != group(l))) continue;
          a = b = std::min(a, b);
          settled = false;
        }
    }
    return label;
  }

  /// Scales of the components that have an angle as balanced, those of the others by where the field is no more linear,
  /// or where it is so everywhere, by how far its drive pushes it.
  void find_amplitudes(const MatrixXd& balanced, double rate, VectorXd& scales) {
    const Index d = _log.size();
    const std::vector<Index> label = components(balanced);
    const auto in = [&](Index i, Index component) { return label[static_cast<std::size_t>(i)] == component; };
    std::vector<bool> by_angle(static_cast<std::size_t>(d), false);
    for (const int angle : _system.structure().angles)
      by_angle[static_cast<std::size_t>(label[static_cast<std::size_t>(angle)])] = true;
    for (Index component = 0; component < d; ++component) {  // the geometric mean of a component's scales is 1
      if (!in(component, component) || by_angle[static_cast<std::size_t>(component)]) continue;
      double sum = 0.0;
      double count = 0.0;
      for (Index i = component; i < d; ++i)
        if (in(i, component)) {
          sum += _log(i);
          count += 1.0;
        }
      for (Index i = component; i < d; ++i)
        if (in(i, component)) _log(i) -= sum / count;
    }
    for (Index component = 0; component < d; ++component) {
      if (!in(component, component)) continue;
      double amplitude = 0.0;
      if (!by_angle[static_cast<std::size_t>(component)]) {
        std::vector<double> departs;
        for (Index i = component; i < d; ++i)
          if (in(i, component)) departs.push_back(departs_at(i, balanced, label));
        const double soonest = *std::min_element(departs.begin(), departs.end());
        double sum = 0.0;
        double count = 0.0;
        for (const double there : departs) {
          if (!std::isfinite(there) || there > soonest + late_departure) continue;
          sum += there;
          count += 1.0;
        }
        amplitude = sum / count;  // not a number where nothing departs
        if (count == 0.0) amplitude = std::log2(pushed([&](Index i) { return in(i, component); }) / rate);
      }
      for (Index i = component; i < d; ++i)
        if (in(i, component)) scales(i) = _log(i) + amplitude;
    }
  }

  /// How far a drive takes the field from its mean, over the coordinates of a component as balanced; not a number
  /// without a drive, or with one of no strength.
  template <class In>
  [[nodiscard]] double pushed(const In& in) const {
    if (_driven == nullptr) return std::numeric_limits<double>::quiet_NaN();
    const VectorXd departure = _driven->departure(_point);
    double square = 0.0;
    for (Index i = 0; i < departure.size(); ++i)
      if (in(i)) square += std::pow(departure(i) * std::exp2(-_log(i)), 2);
    return square > 0.0 ? std::sqrt(square) : std::numeric_limits<double>::quiet_NaN();
  }

  /// log2 of the amplitude along coordinate i at which the linear field of a component, averaged on the way there, has
  /// changed by as much as it is; the smaller one of both ways. Infinite where it does not.
  [[nodiscard]] double departs_at(Index i, const MatrixXd& balanced, const std::vector<Index>& label) const {
    double least = std::numeric_limits<double>::infinity();
    for (const double sign : {1.0, -1.0}) {
      const auto departs = [&](double amplitude) {
        return departure(i, sign * std::exp2(amplitude + _log(i)), balanced, label);
      };
      double upper = least_amplitude;
      while (upper <= largest_amplitude && !departs(upper)) upper += amplitude_step;
      if (upper > largest_amplitude) continue;
      double lower = upper - amplitude_step;
      for (int n = 0; n < bisections; ++n) (departs(0.5 * (lower + upper)) ? upper : lower) = 0.5 * (lower + upper);
      least = std::min(least, upper);
    }
    return least;
  }

  /// The largest singular value.
  static double norm(const MatrixXd& matrix) {
    const MatrixXd squares = matrix.transpose() * matrix;
    return std::sqrt(Eigen::SelfAdjointEigenSolver<MatrixXd>(squares, Eigen::EigenvaluesOnly).eigenvalues().maxCoeff());
  }

  [[nodiscard]] bool departure(Index i, double moved, const MatrixXd& balanced, const std::vector<Index>& label) const {
    core::interruption_point();
    VectorXd z = _point;
    z(i) = _point(i) + 0.5 * moved;
    const std::optional<MatrixXd> middle = jacobian_at(z);
    z(i) = _point(i) + moved;
    const std::optional<MatrixXd> end = jacobian_at(z);
    if (!middle || !end) return true;
    // Simpson's rule, in which the change at the point itself is none.
    const MatrixXd change = (4.0 * (in_scales(*middle) - balanced) + (in_scales(*end) - balanced)) / 6.0;
    for (Index component = 0; component < z.size(); ++component) {
      std::vector<Index> members;
      for (Index l = 0; l < z.size(); ++l)
        if (label[static_cast<std::size_t>(l)] == component) members.push_back(l);
      if (members.empty()) continue;
      const MatrixXd block = change(members, members);
      if (!_linear_norms.contains(component)) _linear_norms[component] = norm(balanced(members, members));
      const double linear = std::max(_linear_norms[component], _least_rate);
      // The sum of squares bounds the norm from both sides, and decides far from where they are equal.
      const double bound = block.norm();
      if (bound < linear) continue;
      if (bound >= linear * std::sqrt(static_cast<double>(members.size())) || norm(block) >= linear) return true;
    }
    return false;
  }

  const systems::System& _system;
  const DriveAveraged* _driven;
  VectorXd _point;
  std::vector<std::size_t> _first;
  VectorXd _log;
  double _least_rate = 0.0;
  bool _invertible = false;
  mutable std::map<Index, double> _linear_norms;  // of the components of the linear field, by the first of each
};

double nearest_power(double log) { return std::exp2(std::round(log)); }

/// log2 of the scale of conserved quantity k: the geometric mean of the eigenvalues of its second derivatives in the
/// scales of the coordinates; NaN where they vanish.
double log_quantity(const systems::System& system, int k, const VectorXd& point, const systems::Scales& scales) {
  const VectorXd in_scales = Eigen::Map<const VectorXd>(scales.coordinates.data(), point.size());
  const MatrixXd second = in_scales.asDiagonal() * second_derivatives(system, k, point, difference_step * in_scales) *
                          in_scales.asDiagonal();
  if (!second.allFinite()) return std::numeric_limits<double>::quiet_NaN();
  const VectorXd moduli = Eigen::JacobiSVD<MatrixXd>(second).singularValues();
  double sum = 0.0;
  double count = 0.0;
  for (const double modulus : moduli)
    if (modulus > negligible_eigenvalue * moduli(0)) {
      sum += std::log2(modulus);
      count += 1.0;
    }
  return sum / count;
}

systems::Scales scales_at(const systems::System& system, const std::vector<VectorXd>& states,
                          const DriveAveraged* driven) {
  const auto d = static_cast<std::size_t>(system.dimension());
  Mean time;
  // Families grow out of the neighbourhood of their equilibrium: the widest one serves all.
  VectorXd widest = VectorXd::Constant(static_cast<Index>(d), -std::numeric_limits<double>::infinity());
  for (const VectorXd& state : states) {
    const std::optional<LogScales> local = LocalScales(system, state, driven).find();
    if (!local) continue;
    time.add(local->time);
    for (Index i = 0; i < widest.size(); ++i)
      if (local->coordinates(i) > widest(i)) widest(i) = local->coordinates(i);
  }
  if (!time.any() || !widest.allFinite()) return {};
  systems::Scales scales;
  scales.time = nearest_power(time.log());
  for (const double coordinate : widest) scales.coordinates.push_back(nearest_power(coordinate));
  for (std::size_t k = 0; k < system.structure().conserved.size(); ++k) {
    Mean quantity;
    for (const VectorXd& state : states) quantity.add(log_quantity(system, static_cast<int>(k), state, scales));
    scales.conserved.push_back(quantity.any() ? nearest_power(quantity.log()) : 1.0);
  }
  return scales;
}

std::vector<VectorXd> grid_points(std::size_t d, const std::vector<std::vector<double>>& grid) {
  std::size_t count = 1;
  for (const std::vector<double>& values : grid) count *= std::max<std::size_t>(values.size(), 1);
  const std::size_t stride = (count + most_grid_points - 1) / most_grid_points;
  std::vector<VectorXd> points;
  for (std::size_t n = 0; n < count; n += stride) {
    VectorXd z = VectorXd::Zero(static_cast<Index>(d));
    std::size_t rest = n;
    for (std::size_t i = 0; i < grid.size(); ++i) {
      if (grid[i].empty()) continue;
      z(static_cast<Index>(i)) = grid[i][rest % grid[i].size()];
      rest /= grid[i].size();
    }
    points.push_back(std::move(z));
  }
  return points;
}

std::vector<std::vector<double>> grid_in_scales(std::vector<std::vector<double>> grid, const systems::Scales& scales) {
  for (std::size_t i = 0; i < grid.size(); ++i)
    for (double& value : grid[i]) value /= scales.coordinate(i);
  return grid;
}

}  // namespace

systems::Scales natural_scales(const systems::System& system, const std::vector<std::vector<double>>& grid) {
  const auto d = static_cast<std::size_t>(system.dimension());
  core::require(grid.size() <= d, "more grid lists than coordinates");
  // A view of the system, which outlives this call.
  const std::shared_ptr<const systems::System> view(std::shared_ptr<const systems::System>(), &system);
  // With the drive's mean in its place, a driven system rests whatever the drive's strength.
  const auto driven = system.structure().driven ? std::make_unique<const DriveAveraged>(view) : nullptr;
  const std::shared_ptr<const systems::System> steady = driven ? driven->mean() : view;
  // Newton's method bounds its steps: what it finds must not depend on units either.
  const systems::Scales rough = scales_at(*steady, grid_points(d, grid), driven.get());
  std::vector<VectorXd> equilibria;
  for (const std::vector<double>& point :
       find_fixed_points(*systems::scaled(steady, rough), grid_in_scales(grid, rough))) {
    VectorXd z(static_cast<Index>(d));
    for (std::size_t i = 0; i < d; ++i) z(static_cast<Index>(i)) = point[i] * rough.coordinate(i);
    equilibria.push_back(std::move(z));
  }
  // A torque that no rest withstands: what its neighbourhood is like, the points of the grid say as well.
  return driven && equilibria.empty() ? rough : scales_at(*steady, equilibria, driven.get());
}

}  // namespace orbweaver::starts
