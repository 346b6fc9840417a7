#include "orbweaver/systems/identities.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <numbers>

#include <fmt/format.h>
#include <Eigen/Dense>

#include "orbweaver/core/error.hpp"
#include "orbweaver/numerics/random.hpp"

namespace orbweaver::systems {

namespace {

using Eigen::VectorXd;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double two_pi = 2.0 * std::numbers::pi;
/// Half the digits: rounding was below 1e-12 for every registered system with parameters between 1e-6 and 1e6 times
/// their standard values, and a term with a wrong sign is an error of its share of the field.
constexpr double beyond_rounding = 1.5e-8;
constexpr int states_each = 8;
constexpr std::uint64_t seed = 20240607;

VectorXd field(const System& system, const VectorXd& z) {
  VectorXd f(z.size());
  system.field(1, z.data(), f.data());
  return f;
}

VectorXd vector_of(const std::vector<double>& state) {
  return Eigen::Map<const VectorXd>(state.data(), static_cast<Eigen::Index>(state.size()));
}

double energy(const System& system, const VectorXd& z) {
  return system.conserved(0, {z.data(), static_cast<std::size_t>(z.size())});
}

/// 0 where nothing is compared, as in a system at rest.
double relative(double off, double size) { return off == 0.0 ? 0.0 : off / size; }

/// A state with what is asked of it.
struct Sample {
  VectorXd z;
  VectorXd f;
};

class Identities {
 public:
  Identities(const System& system, const std::vector<std::vector<double>>& states) : _system(system) {
    for (const std::vector<double>& state : states) {
      Sample sample{vector_of(state), {}};
      sample.f = field(system, sample.z);
      if (sample.f.allFinite()) _samples.push_back(std::move(sample));
    }
    _typical.resize(system.dimension());
    for (Eigen::Index i = 0; i < _typical.size(); ++i)
      _typical(i) = median([i](const Sample& at) { return std::abs(at.f(i)); });
    if (system.structure().conservative())
      _typical_energy = median([this](const Sample& at) { return std::abs(energy_at(at)); });
  }

  std::vector<IdentityError> errors() {
    const Structure& structure = _system.structure();
    for (std::size_t k = 0; k < structure.conserved.size(); ++k)
      add(fmt::format("grad Q . f = 0 for the conserved quantity Q = {}", structure.conserved[k]),
          [&](const Sample& at) { return change_of(static_cast<int>(k), at); });
    for (const Symmetry& s : structure.equivariances)
      add_map(s.map, fmt::format("f({0} z) = {0} f(z)", s.name), fmt::format("{} of {} z and z", energy_name(), s.name),
              1.0);
    for (const Symmetry& r : structure.reversors)
      add_map(r.map, fmt::format("f({0} z) = -{0} f(z)", r.name),
              fmt::format("{} of {} z and z", energy_name(), r.name), -1.0);
    if (structure.driven)
      add("the phase of the drive turns steadily", [&](const Sample& at) {
        const Eigen::Index phase = at.f.size() - 1;
        return relative(std::abs(at.f(phase) - _typical(phase)), _typical(phase));
      });
    for (const int angle : structure.angles) {
      AffineMap turn = AffineMap::identity(structure.dimension);
      turn.offset(angle) = two_pi;
      const std::string& name = _system.info().state_names[static_cast<std::size_t>(angle)];
      add_map(turn, fmt::format("the field has the period 2 pi in the angle {}", name),
              fmt::format("{} at {} and {} + 2 pi", energy_name(), name, name), 1.0);
    }
    return std::move(_errors);
  }

 private:
  [[nodiscard]] std::string energy_name() const {
    const Structure& structure = _system.structure();
    return structure.conservative() ? "equal " + structure.conserved.front() : "";
  }
  [[nodiscard]] double energy_at(const Sample& at) const { return energy(_system, at.z); }

  /// Of a size over the samples: a few of them may lie where it vanishes or grows without bound.
  [[nodiscard]] double median(const std::function<double(const Sample&)>& size) const {
    std::vector<double> sizes;
    for (const Sample& at : _samples) sizes.push_back(size(at));
    if (sizes.empty()) return 0.0;
    const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
    std::nth_element(sizes.begin(), middle, sizes.end());
    return *middle;
  }

  void add(std::string identity, const std::function<double(const Sample&)>& error_at) {
    IdentityError worst{std::move(identity), {}, 0.0};
    for (const Sample& at : _samples) {
      const double error = error_at(at);
      if (error <= worst.error) continue;
      worst.state.assign(at.z.begin(), at.z.end());
      worst.error = error;
      if (std::isnan(error)) break;
    }
    _errors.push_back(std::move(worst));
  }

  void add_map(const AffineMap& map, std::string of_field, std::string of_energy, double sign) {
    const Eigen::MatrixXd mixed = map.matrix.cwiseAbs();
    add(std::move(of_field), [&](const Sample& at) {
      const VectorXd off = field(_system, map(at.z)) - sign * (map.matrix * at.f);
      if (!off.allFinite()) return nan;
      const VectorXd sizes = (mixed * at.f.cwiseAbs()).cwiseMax(_typical).cwiseMax(mixed * _typical);
      double error = 0.0;
      for (Eigen::Index i = 0; i < off.size(); ++i) error = std::max(error, relative(std::abs(off(i)), sizes(i)));
      return error;
    });
    if (!_system.structure().conservative()) return;
    add(std::move(of_energy), [&](const Sample& at) {
      const double here = energy_at(at);
      return relative(std::abs(energy(_system, map(at.z)) - here), std::max(std::abs(here), _typical_energy));
    });
  }

  [[nodiscard]] double change_of(int quantity, const Sample& at) const {
    VectorXd gradient(at.z.size());
    const auto d = static_cast<std::size_t>(at.z.size());
    _system.conserved_gradient(quantity, {at.z.data(), d}, {gradient.data(), d});
    return relative(std::abs(gradient.dot(at.f)), gradient.cwiseAbs().dot(at.f.cwiseAbs()));
  }

  const System& _system;
  std::vector<Sample> _samples;
  VectorXd _typical;  // |f_i|
  double _typical_energy = 0.0;
  std::vector<IdentityError> _errors;
};

/// The largest eigenvalue of a matrix of numbers >= 0, to some percent: the root of a high power's trace. Where that
/// vanishes, or is rounding's, a share of the largest entry.
double fastest_rate(Eigen::MatrixXd sizes) {
  constexpr int squarings = 6;
  const double largest = sizes.maxCoeff();
  if (largest == 0.0) return 0.0;
  double logarithm = 0.0;
  for (int n = 0; n < squarings && sizes.maxCoeff() > 0.0; ++n) {
    const double scale = sizes.maxCoeff();
    sizes /= scale;
    sizes = (sizes * sizes).eval();
    logarithm = 2.0 * (logarithm + std::log(scale));
  }
  const double trace = sizes.trace();
  const double rate = trace > 0.0 ? std::exp((logarithm + std::log(trace)) / (1 << squarings)) : 0.0;
  return std::max(rate, beyond_rounding * largest);
}

double largest_coordinate(const Structure& structure, const std::vector<std::vector<double>>& points) {
  double size = 0.0;
  for (const std::vector<double>& point : points)
    for (std::size_t i = 0; i < point.size(); ++i)
      if (!structure.is_angle(i)) size = std::max(size, std::abs(point[i]));
  return size;
}

/// In the model's own units.
std::string state_text(const System& system, const std::vector<double>& state) {
  std::string text;
  for (std::size_t i = 0; i < state.size(); ++i)
    text += fmt::format("{}{} = {:.6g}", i == 0 ? "" : ", ", system.info().state_names[i],
                        state[i] * system.scales().coordinate(i));
  return text;
}

[[noreturn]] void refuse(const System& system, const std::string& what, const std::vector<double>& state) {
  throw core::InputError(
      fmt::format("the model of system '{}' contradicts its structure: {}, at {}; mend the model before it is surveyed",
                  system.info().name, what, state_text(system, state)));
}

/// All that follows orbits counts on derivatives: what is none there is no fault of an identity.
void require_derivatives(const System& system, const std::vector<std::vector<double>>& states) {
  const auto d = static_cast<Eigen::Index>(system.dimension());
  const std::vector<std::string>& names = system.info().state_names;
  VectorXd f(d);
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> jacobian(d, d);
  for (const std::vector<double>& state : states) {
    if (!field(system, vector_of(state)).allFinite()) continue;
    system.field_jacobian(1, state.data(), f.data(), jacobian.data());
    for (Eigen::Index i = 0; i < d; ++i)
      for (Eigen::Index j = 0; j < d; ++j)
        if (!std::isfinite(jacobian(i, j)))
          refuse(system,
                 fmt::format("the field is finite, and its derivative d f({}) / d {} is {} (a root or a power has none "
                             "at 0)",
                             names[static_cast<std::size_t>(i)], names[static_cast<std::size_t>(j)], jacobian(i, j)),
                 state);
  }
}

void require(const System& system, const IdentityError& found) {
  if (found.error <= beyond_rounding) return;
  refuse(system,
         fmt::format("expected {}, got a relative difference of {:.3g}, where rounding leaves less than {:.2g}",
                     found.identity, found.error, beyond_rounding),
         found.state);
}

}  // namespace

std::vector<IdentityError> identity_errors(const System& system, const std::vector<std::vector<double>>& states) {
  return Identities(system, states).errors();
}

IdentityError pairing_error(const System& system, const std::vector<double>& equilibrium) {
  using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const auto d = static_cast<Eigen::Index>(system.dimension());
  VectorXd f(d);
  Matrix jacobian(d, d);
  system.field_jacobian(1, equilibrium.data(), f.data(), jacobian.data());
  IdentityError worst{"eigenvalues of the Jacobian in pairs +-lambda, since it is symplectic", equilibrium, 0.0};
  if (!jacobian.allFinite()) return {worst.identity, equilibrium, nan};
  const double rate = fastest_rate(jacobian.cwiseAbs());
  Matrix power = jacobian;
  for (Eigen::Index k = 1; k < d; k += 2) {
    const double size = static_cast<double>(d) * std::pow(rate, static_cast<double>(k));
    worst.error = std::max(worst.error, relative(std::abs(power.trace()), size));
    power = (power * jacobian * jacobian).eval();
  }
  return worst;
}

namespace {

/// Reversible fields have paired eigenvalues at their equilibria too: Hamiltonian ones have no divergence anywhere.
bool keeps_volumes(const System& system, const std::vector<std::vector<double>>& equilibria) {
  using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const auto d = static_cast<Eigen::Index>(system.dimension());
  const double size = std::max(1.0, largest_coordinate(system.structure(), equilibria));
  VectorXd f(d);
  Matrix jacobian(d, d);
  for (const std::vector<double>& state : states_around(system.structure(), equilibria, states_each, size)) {
    system.field_jacobian(1, state.data(), f.data(), jacobian.data());
    if (!jacobian.allFinite()) continue;
    if (std::abs(jacobian.trace()) > beyond_rounding * jacobian.cwiseAbs().maxCoeff()) return false;
  }
  return true;
}

}  // namespace

bool may_be_symplectic(const System& system, const std::vector<std::vector<double>>& equilibria) {
  const Structure& structure = system.structure();
  const bool is_told = structure.symplectic || structure.dissipative || structure.driven;
  if (is_told || system.dimension() % 2 != 0 || equilibria.empty()) return false;
  if (!structure.conservative() && !keeps_volumes(system, equilibria)) return false;
  return std::all_of(equilibria.begin(), equilibria.end(), [&](const std::vector<double>& point) {
    return pairing_error(system, point).error <= beyond_rounding;
  });
}

std::vector<std::vector<double>> states_around(const Structure& structure,
                                               const std::vector<std::vector<double>>& points, int count, double size) {
  numerics::Random random(seed);
  std::vector<std::vector<double>> states;
  for (const std::vector<double>& point : points)
    for (int n = 0; n < count; ++n) {
      std::vector<double>& state = states.emplace_back(point);
      for (std::size_t i = 0; i < state.size(); ++i) state[i] += (structure.is_angle(i) ? 1.0 : size) * random();
    }
  return states;
}

void require_identities(const System& system, const std::vector<std::vector<double>>& equilibria,
                        const std::vector<std::vector<double>>& states) {
  const Structure& structure = system.structure();
  std::vector<std::vector<double>> points = equilibria;
  points.insert(points.end(), states.begin(), states.end());
  for (const std::vector<double>& point : points)
    for (std::size_t k = 0; k < structure.guards.size(); ++k) {
      const double value = system.guard(static_cast<int>(k), point);
      if (!(value > 0.0))
        refuse(system, fmt::format("expected the guard {} to be positive, got {:.6g}", structure.guards[k].name, value),
               point);
    }
  require_derivatives(system, points);
  const auto require_as_far_as = [&](double size) {
    const std::vector<std::vector<double>> around = states_around(structure, points, states_each, size);
    require_derivatives(system, around);
    for (const IdentityError& found : identity_errors(system, around)) require(system, found);
  };
  const double size = largest_coordinate(structure, points);
  require_as_far_as(size);
  // Coordinates may be rounding's only; motions of 1 beside far larger coordinates would lose digits.
  if (size < 1.0) require_as_far_as(1.0);
  if (structure.symplectic)
    for (const std::vector<double>& point : equilibria) require(system, pairing_error(system, point));
}

}  // namespace orbweaver::systems
