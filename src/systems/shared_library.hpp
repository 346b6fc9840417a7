#pragma once

#include <filesystem>

namespace orbweaver::systems {

/// Looks at a file before the dynamic linker does, which maps what the headers say and dies of a file that ends before
/// it. Throws core::InputError that says what is wrong: no shared library, one for another machine, or a torn one.
/// Whether its code is harmless nothing can say: a plugin is trusted as the program itself is.
void require_shared_library(const std::filesystem::path& file);

}  // namespace orbweaver::systems
