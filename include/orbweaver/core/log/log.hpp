#pragma once

#include <cstdio>
#include <string_view>

namespace orbweaver::core {

enum class LogLevel { debug, info, warning, error, quiet };

/// Sends log lines to stderr, each with its rank when there is more than one. Call once after the session has started.
/// Ranks other than 0 print warnings and errors only, unless the level is debug.
void start_logging(LogLevel level, int rank, int ranks);

/// Log one line; formatting is the caller's (fmt::format). Safe before start_logging (prints warnings and errors).
void log_debug(std::string_view message);
/// Whether log_debug prints, for lines that are costly to make.
[[nodiscard]] bool logs_debug();
void log_info(std::string_view message);
void log_warning(std::string_view message);
void log_error(std::string_view message);

/// Writes a line and flushes; a stream that cannot be written (a closed terminal) is no reason to end a run.
void write_line(std::FILE* stream, std::string_view line) noexcept;

}  // namespace orbweaver::core
