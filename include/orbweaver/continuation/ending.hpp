#pragma once

#include <string>
#include <string_view>

#include "orbweaver/core/serialization.hpp"

namespace orbweaver::continuation {

/// Why a branch ended (docs/mathematics.md, "Ends").
enum class EndReason {
  period_limit,     ///< the scene's limit; the last orbit has exactly that period
  energy_limit,     ///< the scene's limit; the last orbit has exactly that energy
  parameter_limit,  ///< the scene's limit; the last orbit has exactly that value of the parameter that moves
  guard_limit,      ///< the scene's limit; the smallest value of a guard over the last orbit is exactly that
  step_limit,
  cutoff_limit,       ///< the next orbit needs more harmonics than the scene allows
  period_divergence,  ///< T grows without bound while the energy (or what moves instead) settles, and double
                      ///< precision or the cutoff ends it
  collision,          ///< the smallest value of a guard fell to nothing, and double precision or the cutoff ends it
  fixed_point,        ///< the amplitude shrank to nothing
  closed_loop,        ///< back at the first orbit
  strong_resonance,   ///< of a locus of torus points: the two multipliers are 1, or -1
  more_symmetry,      ///< of a locus: its orbits come to the family that theirs was born on; beyond lie their images
  stopped,            ///< the observer asked for it
  undecided,          ///< the corrector failed where rounding does not tell an orbit from its neighbours
  failure,            ///< the corrector failed at the smallest step
};

[[nodiscard]] constexpr EndReason last_of(EndReason) { return EndReason::failure; }
[[nodiscard]] std::string_view name_of(EndReason reason);

/// A branch's end in a form to print and to store.
struct Ending {
  EndReason reason = EndReason::failure;
  std::string detail;    ///< numbers that go with it; never empty
  std::string object{};  ///< what the reason is about ("with the smaller body"); empty where it says all

  [[nodiscard]] bool failed() const { return reason == EndReason::failure; }
  /// "period limit (T = 30)", "collision with the smaller body (r2 = 1e-05 at T = 9)".
  [[nodiscard]] std::string text() const;

  static constexpr int wire_version = 2;
  template <class Archive>
  void serialize(Archive& archive, unsigned /*version*/) {
    core::serialize_members(archive, reason, detail, object);
  }
};

}  // namespace orbweaver::continuation
