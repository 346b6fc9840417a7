#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "orbweaver/prove/proof.hpp"

namespace orbweaver::prove {

inline constexpr const char* proofs_format = "orbweaver-proofs";
inline constexpr int proofs_version = 1;

/// A file of proofs (docs/file_format.md, "Proofs"), each with all that it can be checked from. Whole or not there.
/// Throws EnvironmentError if it cannot be written.
void write_proofs(const std::filesystem::path& path, const std::vector<Proof>& proofs);

/// Throws InputError for a file that is none, or changed. What it claims is not checked: `check` does that.
[[nodiscard]] std::vector<Proof> read_proofs(const std::filesystem::path& path);

/// Whether the file says that it is one.
[[nodiscard]] bool is_proofs_file(const std::filesystem::path& path);

}  // namespace orbweaver::prove
