#pragma once

#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "orbweaver/loop/curve/loop.hpp"
#include "orbweaver/loop/curve/tangent.hpp"
#include "orbweaver/loop/symmetry/subspace.hpp"
#include "orbweaver/systems/system.hpp"

namespace orbweaver::loss {

/// A number that is solved for beside the modes of a loop.
struct Scalar {
  enum class Kind {
    period,     ///< T
    parameter,  ///< a parameter of the system
    unfolding,  ///< the multiple of grad of a conserved quantity that is added to the field; zero at an orbit
  };
  Kind kind = Kind::period;
  std::string parameter{};  ///< its name
  int quantity = 0;         ///< the conserved quantity of the unfolding

  [[nodiscard]] static Scalar period() { return {}; }
  [[nodiscard]] static Scalar of_parameter(std::string name) { return {Kind::parameter, std::move(name), 0}; }
  [[nodiscard]] static Scalar unfolding(int quantity = 0) { return {Kind::unfolding, {}, quantity}; }
  bool operator==(const Scalar&) const = default;
};

/// What is solved for: the coordinates of a perturbation in a subspace, then the scalars: T first, then parameters,
/// then unfoldings. A vector of unknowns u is always relative to a base loop, and to a system: u = 0 is the base.
struct Unknowns {
  loop::Subspace subspace;
  std::vector<Scalar> scalars;

  [[nodiscard]] int size() const { return subspace.size() + static_cast<int>(scalars.size()); }
  [[nodiscard]] bool has_period() const { return !scalars.empty() && scalars.front().kind == Scalar::Kind::period; }
  [[nodiscard]] bool has_parameters() const;
  /// Throws MisuseError for scalars in another order, or twice.
  void validate() const;
  /// base + u, with the parameters that the loop carries (those that move along its families come first among the
  /// scalars); the period of the result may be anything finite, also <= 0 (the loss refuses that).
  [[nodiscard]] loop::Loop moved(const loop::Loop& base, std::span<const double> u) const;
  /// The system with its parameters moved by u. Where none moves it is `base` itself, which must outlive the result.
  [[nodiscard]] std::shared_ptr<const systems::System> moved(const systems::System& base,
                                                             std::span<const double> u) const;
  /// The values that the system has for the parameters among the scalars, in their order and scales.
  [[nodiscard]] std::vector<double> parameters_of(const systems::System& system) const;
  /// The orthogonal projection of `to` - `from` onto the unknowns (same cutoff as the subspace, same time map);
  /// unfoldings do not differ, nor do parameters that the loops do not carry.
  [[nodiscard]] std::vector<double> difference(const loop::Loop& from, const loop::Loop& to) const;
  /// The orthogonal projection of a tangent onto the unknowns, and the tangent that a vector of unknowns is. An
  /// unfolding is no part of it.
  [[nodiscard]] std::vector<double> coordinates_of(const loop::Tangent& tangent) const;
  [[nodiscard]] loop::Tangent tangent_of(std::span<const double> u) const;
  /// dz/d(2 pi t/T) = z'/(2 pi phi') of the loop as a vector of unknowns: the direction of a time shift (scalars 0).
  [[nodiscard]] std::vector<double> time_shift_direction(const loop::Loop& loop) const;
  /// Where that is shorter than this times the loop's rms amplitude, a reversor excludes it: what is left is rounding
  /// (1e-16 of the loop's size, so loops of amplitude 1e-8 and more about a point of order 1 are told right).
  static constexpr double least_time_shift = 1e-8;
};

}  // namespace orbweaver::loss
