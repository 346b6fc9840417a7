#pragma once

#include <string_view>

namespace orbweaver::core {

/// A place where tests may kill the program: if the environment variable ORBWEAVER_PAUSE_AT is `where`, says so on
/// stderr and waits for ORBWEAVER_PAUSE_SECONDS (default 10). Otherwise does nothing.
void pause_point(std::string_view where);

}  // namespace orbweaver::core
