#pragma once

namespace orbweaver::survey {

/// The version of Orbweaver, as CMake's project() has it.
[[nodiscard]] const char* version();

}  // namespace orbweaver::survey
