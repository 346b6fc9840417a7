#pragma once

#include <malloc.h>

#include <fstream>
#include <functional>
#include <limits>
#include <string>

namespace orbweaver::benchmarks {

/// What a piece of work needs above what the process holds, MiB: the peak of its resident memory (Linux).
inline double peak_memory_of(const std::function<void()>& work) {
  const auto resident = [](const char* field) {
    std::ifstream status("/proc/self/status");
    for (std::string line; std::getline(status, line);)
      if (line.starts_with(field)) return std::stod(line.substr(std::string(field).size())) / 1024.0;
    return std::numeric_limits<double>::quiet_NaN();
  };
  malloc_trim(0);
  std::ofstream("/proc/self/clear_refs") << "5";  // the peak is counted from here
  const double before = resident("VmRSS:");
  work();
  return resident("VmHWM:") - before;
}

}  // namespace orbweaver::benchmarks
