#include "orbweaver/core/address_space.hpp"

#include <cmath>
#include <fstream>
#include <limits>
#include <string>

#include <dlfcn.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/resource.h>

#include "orbweaver/core/error.hpp"

namespace orbweaver::core {

namespace {

constexpr double mebibyte = 1 << 20;
constexpr double kibibyte = 1 << 10;
/// What OpenBLAS maps for a thread: its BUFFER_SIZE on x86-64 with several kinds of kernels in it
/// (tests/core/address_space_test.cpp measures it).
constexpr std::size_t blas_buffer = 128U << 20;

double limit_of(__rlimit_resource kind) {
  rlimit limit{};
  if (getrlimit(kind, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return std::numeric_limits<double>::infinity();
  return static_cast<double>(limit.rlim_cur);
}

/// "VmSize", in bytes.
double of_this_process(const std::string& what) {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with(what + ":")) return kibibyte * std::stod(line.substr(what.size() + 1));
  return 0.0;
}

[[noreturn]] void refuse(const AddressSpace& needed) {
  const AddressSpace allowed = space_allowed();
  std::string texts;
  const auto compare = [&](const char* option, double has, double wants) {
    if (has >= wants) return;
    texts += fmt::format("{}`ulimit {} {:.0f}` (KiB) or more, got {:.0f}", texts.empty() ? "" : ", and ", option,
                         std::ceil(wants / kibibyte), has / kibibyte);
  };
  compare("-v", allowed.addresses, needed.addresses);
  compare("-d", allowed.data, needed.data);
  if (texts.empty()) texts = "more memory than this machine gives";
  throw EnvironmentError(
      fmt::format("too little memory for a rank: expected {}; its orbits come on top of that, and "
                  "{:.0f} MiB of it are the buffer of OpenBLAS",
                  texts, static_cast<double>(blas_buffer) / mebibyte));
}

}  // namespace

AddressSpace space_of_a_rank() { return {418.0 * mebibyte, 150.0 * mebibyte}; }

AddressSpace space_allowed() { return {limit_of(RLIMIT_AS), limit_of(RLIMIT_DATA)}; }

void require_space_of_a_rank() {
  const AddressSpace needed = space_of_a_rank();
  const AddressSpace allowed = space_allowed();
  if (allowed.addresses < needed.addresses || allowed.data < needed.data) refuse(needed);
}

void take_blas_buffer() {
  const auto take = reinterpret_cast<void* (*)(int)>(dlsym(RTLD_DEFAULT, "blas_memory_alloc"));
  const auto give_back = reinterpret_cast<void (*)(void*)>(dlsym(RTLD_DEFAULT, "blas_memory_free"));
  if (take == nullptr || give_back == nullptr) return;
  void* const trial = mmap(nullptr, blas_buffer, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (trial == MAP_FAILED)
    refuse({of_this_process("VmSize") + static_cast<double>(blas_buffer),
            of_this_process("VmData") + static_cast<double>(blas_buffer)});
  munmap(trial, blas_buffer);
  give_back(take(0));
}

}  // namespace orbweaver::core
