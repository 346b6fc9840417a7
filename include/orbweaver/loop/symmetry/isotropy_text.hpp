#pragma once

#include <string>

#include "orbweaver/loop/symmetry/isotropy.hpp"

namespace orbweaver::loop {

/// The isotropy that to_text wrote, with the matrices that `system` declares. Throws InputError where the text is none,
/// or names a symmetry that the system does not declare.
[[nodiscard]] Isotropy isotropy_of(const systems::Structure& system, const std::string& text);

}  // namespace orbweaver::loop
