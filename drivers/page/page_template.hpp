#pragma once

#include <string>
#include <string_view>

namespace orbweaver::drivers {

/// The built page without data (report::write_page); empty where this program was built without it. Its source is made
/// by drivers/page/embed.cmake.
[[nodiscard]] std::string_view page_template();

/// What was missing when the program was built, and what to do; empty if nothing was.
[[nodiscard]] std::string missing_page_reason();

}  // namespace orbweaver::drivers
