#pragma once

#include <map>
#include <string>
#include <vector>

#include "orbweaver/systems/description.hpp"

namespace orbweaver::systems {

/// Every parameter of the system and of the effects asked for, by name: what was given, and the standard values for the
/// rest. Throws core::InputError on an unknown or repeated effect, an unknown parameter, one whose effect is not asked
/// for, and a value that is not finite or out of range; the message says what is known or allowed.
[[nodiscard]] std::map<std::string, double> bind_parameters(const Description& description,
                                                            const std::map<std::string, double>& given,
                                                            const std::vector<std::string>& effects);

/// "a, b, c", or "none" where the list is empty.
[[nodiscard]] std::string joined(const std::vector<std::string>& names);

/// "0 < m1 kg", "0 <= friction <= 1": the range of a parameter as a person would write it.
[[nodiscard]] std::string range_text(const Parameter& parameter);

}  // namespace orbweaver::systems
