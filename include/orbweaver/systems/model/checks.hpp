#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "orbweaver/systems/model/bound.hpp"
#include "orbweaver/systems/model_info.hpp"
#include "orbweaver/systems/structure.hpp"

namespace orbweaver::systems {

/// Throws core::InputError where a name or a meaning cannot be shown as it is: empty, of more than a line, with control
/// characters or bytes that are no UTF-8, or longer than names are.
void require_description(const ModelInfo& info);

/// The effects asked for, and every parameter of the system and of them by name: what was given, and the standard
/// values for the rest. Throws core::InputError on an unknown or repeated effect, an unknown parameter, one whose
/// effect is not asked for (free ones too), and a value that is not finite or out of range; the message says what is
/// known or allowed.
[[nodiscard]] Bound bound_to(const ModelInfo& info, const std::map<std::string, double>& given,
                             const std::vector<std::string>& effects, const FamilyScalars& scalars = {});

/// Throws StructureError unless the structure fits its model: as many names as coordinates, angles that are coordinates
/// and have names for their windings, no more conserved quantities than functions for them, symmetries of the state's
/// dimension and of finite order with names of their own, and nothing symplectic that cannot be so.
void check(const Structure& structure, const ModelInfo& info, int dimension, int quantities);
/// Throws StructureError if the structure of a model without a function for them names guards.
void check_without_guards(const Structure& structure);

/// Throws StructureError if the structure of a model without an action density names an energy.
void check_without_action_density(const Structure& structure);

/// Of a function `conserved<k>` of a model, at a state: the field and the function's gradient (`dimension` numbers
/// each).
using FunctionAt = std::function<void(int k, const double* z, double* field, double* gradient)>;
/// Throws StructureError if the field keeps one of the model's `quantities` functions that the structure does not name,
/// though it says neither `dissipative` nor `driven`: its families would be followed as those of a system without it.
void check_unnamed(const Structure& structure, int quantities, const FunctionAt& at);

/// "a, b, c", or "none" where the list is empty.
[[nodiscard]] std::string joined(const std::vector<std::string>& names);

/// "0 < m1 kg", "0 <= friction <= 1": the range of a parameter as a person would write it.
[[nodiscard]] std::string range_text(const Parameter& parameter);

}  // namespace orbweaver::systems
