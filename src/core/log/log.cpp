#include "orbweaver/core/log/log.hpp"

#include <memory>
#include <string>

#include <fmt/format.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include "orbweaver/core/styled.hpp"
#include "orbweaver/core/terminal.hpp"
#include "orbweaver/core/text.hpp"

namespace orbweaver::core {

namespace {

spdlog::level::level_enum to_spdlog(LogLevel level) {
  switch (level) {
    case LogLevel::debug: return spdlog::level::debug;
    case LogLevel::info: return spdlog::level::info;
    case LogLevel::warning: return spdlog::level::warn;
    case LogLevel::error: return spdlog::level::err;
    case LogLevel::quiet: return spdlog::level::off;
  }
  return spdlog::level::info;
}

spdlog::logger& logger() {
  static const std::shared_ptr<spdlog::logger> instance = [] {
    auto made = std::make_shared<spdlog::logger>("orbweaver", std::make_shared<spdlog::sinks::stderr_sink_st>());
    made->set_pattern("orbweaver: %v");
    made->set_level(spdlog::level::warn);
    return made;
  }();
  return *instance;
}

}  // namespace

void start_logging(LogLevel level, int rank, int ranks) {
  spdlog::logger& log = logger();
  const bool silent_rank = rank != 0 && level == LogLevel::info;
  log.set_level(silent_rank ? spdlog::level::warn : to_spdlog(level));
  log.set_pattern(ranks > 1 ? fmt::format("orbweaver[{}]: %v", rank) : std::string("orbweaver: %v"));
}

void write_line(std::FILE* stream, std::string_view line) noexcept {
  std::fwrite(line.data(), 1, line.size(), stream);
  std::fputc('\n', stream);
  std::fflush(stream);
}

bool logs_debug() { return logger().should_log(spdlog::level::debug); }
void log_debug(std::string_view message) {
  if (logs_debug()) logger().debug(printable_lines(message));
}
void log_info(std::string_view message) { logger().info(printable_lines(message)); }
void log_warning(std::string_view message) {
  logger().warn(styled(Style::warning, printable_lines(message), terminal_of(STDERR_FILENO).colours));
}
void log_error(std::string_view message) {
  logger().error(styled(Style::bad, printable_lines(message), terminal_of(STDERR_FILENO).colours));
}

}  // namespace orbweaver::core
