#pragma once

#include <string>

#include "correction.hpp"
#include "orbweaver/core/output_file.hpp"
#include "orbweaver/refine/shoot.hpp"
#include "setting.hpp"
#include "true_orbit.hpp"

namespace orbweaver::cost {

/// AUTO-07p on the same orbit: its program, made of the system's formulas and compiled in a folder of its own (which
/// goes with the object), whole loop, Gauss collocation with four points a mesh interval. A conservative family has
/// one parameter mu more, the multiple of grad H in the field; the free parameters are T and mu.
class AutoProgram {
 public:
  /// Why there is none: AUTO-07p or gfortran missing (AUTO_DIR, else /usr/lib/auto-07p), an orbit that its period does
  /// not pick; empty: none.
  [[nodiscard]] static std::string obstacle(const TrueOrbit& truth);

  /// Throws EnvironmentError where it cannot be compiled.
  AutoProgram(const Setting& setting, const Directed& guess);
  AutoProgram(const AutoProgram&) = delete;
  AutoProgram& operator=(const AutoProgram&) = delete;

  /// Writes a guess and constants for so many mesh intervals. `tolerance`: of Newton's method, relative.
  void prepare(int intervals, double tolerance) const;
  /// Runs it: a process that corrects the guess, by one step along the family of next to no length. False where it
  /// fails.
  [[nodiscard]] bool run() const;
  /// What the last run found: the states at the ends of its mesh intervals. Throws NumericalError where it found
  /// nothing.
  [[nodiscard]] refine::ShotOrbit found() const;

  static constexpr int points = 4;

 private:
  const Setting& _setting;
  Directed _guess;
  core::TemporaryFolder _folder;
};

}  // namespace orbweaver::cost
