#include "orbweaver/core/pause.hpp"

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <thread>

#include <fmt/format.h>

#include "orbweaver/core/log/log.hpp"

namespace orbweaver::core {

void pause_point(std::string_view where) {
  static const char* const wanted = std::getenv("ORBWEAVER_PAUSE_AT");
  if (wanted == nullptr || where != wanted) return;
  write_line(stderr, fmt::format("paused at {}", where));
  const char* const seconds = std::getenv("ORBWEAVER_PAUSE_SECONDS");
  std::this_thread::sleep_for(std::chrono::duration<double>(seconds != nullptr ? std::atof(seconds) : 10.0));
}

}  // namespace orbweaver::core
