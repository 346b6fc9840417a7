#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace orbweaver::core {

/// How another program is run.
struct ProcessOptions {
  std::filesystem::path folder{};  ///< where; empty: here
  std::filesystem::path input{};   ///< its stdin; empty: nothing
  bool quiet = false;              ///< its stdout and stderr go nowhere
  std::map<std::string, std::string> environment{};  ///< variables that it has instead of this program's
};

/// Runs a program, found along PATH, to its end, with one thread for OpenMP unless told otherwise. Its exit status;
/// none where there is no such program. Throws EnvironmentError where it cannot be started or a signal ends it.
[[nodiscard]] std::optional<int> run_program(const std::vector<std::string>& words, const ProcessOptions& options = {});

}  // namespace orbweaver::core
