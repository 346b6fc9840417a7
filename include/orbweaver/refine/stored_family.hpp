#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "orbweaver/archive/read/reader.hpp"
#include "orbweaver/refine/orbit.hpp"
#include "orbweaver/scene/scene.hpp"
#include "orbweaver/systems/system.hpp"

namespace orbweaver::refine {

/// A family of an archive, as a curve that can be asked for a guess anywhere along it. The archive must outlive it.
class StoredFamily {
 public:
  /// Row `family` of /families. Throws InputError where the scene is not one that this Orbweaver reads.
  StoredFamily(const archive::Archive& atlas, std::size_t family);
  /// That of the name. Throws InputError, naming what is near, where there is none.
  [[nodiscard]] static StoredFamily named(const archive::Archive& atlas, const std::string& name);

  [[nodiscard]] const std::string& name() const { return _name; }
  [[nodiscard]] const std::string& isotropy_text() const { return _isotropy_text; }

  /// A guess, and between which steps of the family it lies (the same one twice: at a stored orbit).
  struct Place {
    Guess guess;
    int first_step = 0;
    int last_step = 0;
  };
  /// Throws InputError where the family has no such step.
  [[nodiscard]] Place at_step(int step) const;
  /// The place with this period, energy or parameter, the first one behind the step `after` if that is given. Throws
  /// InputError where the family has none there, or has several and no step is given, naming them.
  [[nodiscard]] Place with(const HeldValue& value, std::optional<int> after) const;
  /// The orbit that a person names: "T=9" or "E=-0.5", meant exactly, or a step, which is held by what isolates it
  /// better, as it is stored. Of a family in a parameter "mu=10" or a step; then the system of the guess has that
  /// value, and what the family holds, if anything, is held. Throws InputError for another text, and as `with` and
  /// `at_step`.
  struct Named {
    Place place;
    HeldValue held;
    std::vector<std::string> equations;  ///< what holds exactly: "mu = 10", "T = 9"
  };
  [[nodiscard]] Named named_orbit(const std::string& text, std::optional<int> after) const;
  /// Polynomials through the orbits beside it. Throws InputError for a family of less than two orbits, or in a
  /// parameter: between two of its orbits that has no value of its own.
  [[nodiscard]] Place at_arclength(double arclength) const;

  /// The stored period, energy or parameter of a step, as the shortest decimal numbers that read as them.
  [[nodiscard]] std::string stored(HeldValue::Quantity quantity, int step) const;

 private:
  [[nodiscard]] std::size_t index_of(int step) const;
  [[nodiscard]] int step_of(std::size_t orbit) const;
  /// The orbits beside a place: those from `first` to before `end`.
  struct Neighbours {
    std::size_t first;
    std::size_t end;
  };
  [[nodiscard]] Neighbours beside(double arclength) const;
  [[nodiscard]] std::vector<double> values(HeldValue::Quantity quantity) const;
  [[nodiscard]] std::string letter_of(HeldValue::Quantity quantity) const;
  [[nodiscard]] Place placed(double arclength, std::shared_ptr<const systems::System> plain) const;
  [[nodiscard]] Named of_parameter(const std::string& text, std::optional<int> after) const;
  /// The system in the units of its parameters, the one that moves at a value.
  [[nodiscard]] std::shared_ptr<const systems::System> plain_at(double value) const;
  [[nodiscard]] int step_named(const std::string& text, const std::string& expected) const;

  const archive::Archive& _atlas;
  scene::SystemChoice _choice;
  std::shared_ptr<const systems::System> _system;  // in the scales of the survey
  std::shared_ptr<const systems::System> _plain;   // in the units of its parameters
  std::string _parameter;                          // that moves along the family; empty: none
  std::string _name;
  std::string _isotropy_text;
  loop::Isotropy _isotropy;  // at the standard phase
  std::size_t _first_orbit = 0;
  std::vector<double> _arclengths;
};

/// Row `row` of /crossings: where it lies, and what holds there. Throws InputError where there is no such row.
struct StoredCrossing {
  StoredFamily family;
  StoredFamily::Place place;
  CrossingCondition condition;
  double period = 0.0;  ///< as stored
};
[[nodiscard]] StoredCrossing stored_crossing(const archive::Archive& atlas, std::size_t row);

}  // namespace orbweaver::refine
