#pragma once

#include <optional>
#include <utility>

#include "orbweaver/spectrum/floquet.hpp"

namespace orbweaver::bifurcation {

/// The sense in which neighbours of an orbit go around, carried along its family from one orbit to others: of a
/// system's only pair of multipliers by Stability::twist, of one of several in its plane, which turns from orbit to
/// orbit.
class TurningSense {
 public:
  /// That of the pair that goes around one way at one orbit and the other way at the other, both nearer to 1 than to
  /// -1: along one family its index would have had to pass 2 twice. Nothing where none is known to.
  [[nodiscard]] static std::optional<TurningSense> reversed_between(const spectrum::Stability& from,
                                                                    const spectrum::Stability& to);

  /// Whether a pair near 1 has no plane at the other orbit that is told to be its own, though as many are on the unit
  /// circle at both: which sense it has there only a shorter step tells.
  [[nodiscard]] static bool is_untold(const spectrum::Stability& from, const spectrum::Stability& to);

  /// How far they go around at an orbit, on some scale: positive in the sense that was carried there. Nothing where
  /// that is not told, or the index is above 2.
  [[nodiscard]] std::optional<double> at(const spectrum::Stability& orbit) const;
  /// To an orbit where the sense is the same.
  void carry_to(const spectrum::Stability& orbit);

 private:
  explicit TurningSense(double twist) : _twist(twist) {}
  explicit TurningSense(spectrum::Rotation rotation) : _rotation(std::move(rotation)) {}

  double _twist = 0.0;
  std::optional<spectrum::Rotation> _rotation;
};

}  // namespace orbweaver::bifurcation
