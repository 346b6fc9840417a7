#pragma once

#include <string>

namespace orbweaver::drivers {

/// Seconds of "5400", "90:00" or "1:30:00", as batch systems write times. Throws InputError for anything else, and for
/// times that are not above zero.
[[nodiscard]] double seconds_of(const std::string& text);

}  // namespace orbweaver::drivers
