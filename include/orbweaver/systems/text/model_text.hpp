#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "orbweaver/document/field.hpp"
#include "orbweaver/model/formula.hpp"
#include "orbweaver/systems/model_info.hpp"
#include "orbweaver/systems/structure.hpp"

namespace orbweaver::systems {

/// `for i = 1..n`: what stands below it holds for each index.
struct IndexLoop {
  std::string index;
  model::PlacedFormula first;
  model::PlacedFormula last;
};

/// A line of a model below its loops, the outermost first.
struct IndexedLine {
  std::vector<IndexLoop> loops;
  std::string name;
  std::vector<model::Formula> index;
  std::vector<std::string> arguments;  ///< of a definition
  int order = 0;                       ///< of an equation: 1 of x', 2 of x''
  model::PlacedFormula formula;
};

/// Names, x[1..n] being as many as n says.
struct NameRange {
  std::string name;
  std::optional<IndexLoop> range;
  std::string place;
};

/// A parameter with a value, or one that is an expression of others.
struct ParameterText {
  Parameter parameter;
  bool is_whole = false;  ///< a size, which decides how many coordinates there are
};

/// What a model or one of its effects says of the motion. An effect's are added to the model's.
struct TermsText {
  std::vector<ParameterText> parameters;
  std::vector<IndexedLine> definitions;
  std::vector<IndexedLine> added;  ///< to definitions of the model
  std::optional<model::PlacedFormula> hamiltonian;
  std::optional<model::PlacedFormula> lagrangian;
  std::vector<IndexedLine> equations;
  std::vector<IndexedLine> forces;  ///< beside a Lagrangian or a Hamiltonian, one a coordinate
  std::vector<std::pair<Guard, model::PlacedFormula>> guards;
  std::optional<model::PlacedFormula> frequency;  ///< of the drive whose phase the terms use
};

struct EffectText {
  std::string name;
  std::string meaning;
  TermsText terms;
  std::vector<NameRange> no_angles;
};

/// A symmetry or a reversor, coordinate by coordinate; what is left out stays.
struct SymmetryText {
  std::string name;
  bool reverses = false;
  bool if_it_holds = false;  ///< left out where it does not hold, for values of the parameters that a scene gives
  std::vector<IndexedLine> images;
  std::string place;
};

/// A model as it is written, parsed, and nothing looked up (docs/models.md).
struct ModelText {
  std::string name;
  std::string title;
  std::string meaning;
  std::string place;
  std::vector<NameRange> coordinates;
  std::vector<NameRange> velocities;
  std::vector<NameRange> momenta;
  std::vector<NameRange> angles;
  std::map<std::string, std::string> windings;  ///< names of winding numbers, of angles
  TermsText terms;
  std::vector<std::pair<std::string, model::PlacedFormula>> conserved;
  std::optional<model::PlacedFormula> action;  ///< p dq/dt, where equations are given
  std::vector<SymmetryText> symmetries;
  struct EndsText {
    std::string name;
    bool cyclic = false;
    std::vector<std::pair<model::PlacedFormula, model::PlacedFormula>> beyond;  ///< index, value
  };
  std::vector<EndsText> ends;
  std::vector<EffectText> effects;
};

/// Keys that a model has beside those of a scene's system.
[[nodiscard]] const std::vector<std::string>& model_keys();

/// Reads the map of a model; `also` names keys that others read. Throws core::InputError with place, what was expected,
/// what came and what to do.
[[nodiscard]] ModelText read_model(const document::Field& field, const std::vector<std::string>& also = {});

}  // namespace orbweaver::systems
