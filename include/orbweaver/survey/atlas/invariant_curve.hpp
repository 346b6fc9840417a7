#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace orbweaver::survey {

/// Numbers of an orbit that neither a symmetry of the system nor a time shift changes. The level is the energy, or the
/// parameter where one moves along the families; beside it the energy counts as another number.
enum class Invariant : std::size_t { period, level, action, energy, trace };
inline constexpr std::array all_invariants{Invariant::period, Invariant::level, Invariant::action, Invariant::energy,
                                           Invariant::trace};

/// Of one orbit; NaN: not known. `trace`: asinh of half the sum of the stability values, so that it is smooth along a
/// family and unstable orbits do not drown the others.
struct Invariants {
  using Numbers = std::array<double, all_invariants.size()>;
  Numbers values{};
  Numbers scale{};  ///< what relative deviations refer to
  Numbers floor{};  ///< deviations between two computations of the same orbit

  [[nodiscard]] double value(Invariant i) const { return values[static_cast<std::size_t>(i)]; }
  [[nodiscard]] double scale_of(Invariant i) const { return scale[static_cast<std::size_t>(i)]; }
  [[nodiscard]] double floor_of(Invariant i) const { return floor[static_cast<std::size_t>(i)]; }
};

/// Where an orbit lies beside a curve.
struct CurveFit {
  double excess = 0.0;  ///< largest deviation in parts of what is allowed; infinite: nowhere beside it
  Invariant worst = Invariant::period;
  double deviation = 0.0;   ///< of `worst`, relative to its scale
  double allowed = 0.0;     ///< the same
  std::size_t segment = 0;  ///< between nodes segment and segment + 1
  bool measured = false;    ///< at a place where deviations of the size of the floor would show

  [[nodiscard]] bool fits() const { return excess <= 1.0; }
};

/// The curve through a family's orbits in the space of invariants.
///
/// Beside each two neighbours the one among period, level and energy that changes most is the variable; the others
/// are interpolated by polynomials through up to six orbits among which it is monotone. The error is taken for the
/// largest difference to polynomials of one or two orbits fewer. No arclength is used: chords between orbits that lie
/// elsewhere add up to another one.
class InvariantCurve {
 public:
  InvariantCurve() = default;
  explicit InvariantCurve(std::vector<Invariants> points) : _points(std::move(points)) {}

  [[nodiscard]] const std::vector<Invariants>& points() const { return _points; }

  /// The best place for `x` up to `distance` segments from `hint`, or anywhere.
  [[nodiscard]] CurveFit fit_near(const Invariants& x, std::size_t hint, std::size_t distance) const;
  [[nodiscard]] CurveFit fit_anywhere(const Invariants& x) const;

 private:
  [[nodiscard]] CurveFit fit_beside(const Invariants& x, std::size_t segment) const;
  [[nodiscard]] CurveFit fit_at_point(const Invariants& x) const;

  std::vector<Invariants> _points;
};

/// All orbits of another family, in their order. Each is looked for ever further from the one before; how often all is
/// searched in vain is limited, so that the cost is linear in the number of orbits.
[[nodiscard]] std::vector<CurveFit> fit_all(const InvariantCurve& curve, const std::vector<Invariants>& orbits);

/// "action".
[[nodiscard]] const char* name_of(Invariant invariant);

}  // namespace orbweaver::survey
