#include "orbweaver/core/blas_kernels.hpp"

#include <cstdlib>
#include <string_view>

#include <dlfcn.h>
#include <unistd.h>

namespace orbweaver::core {

namespace {

constexpr const char* variable = "OPENBLAS_CORETYPE";

bool chose_oldest_kernels() {
  using CoreName = char* (*)();
  const auto core_name = reinterpret_cast<CoreName>(dlsym(RTLD_DEFAULT, "openblas_get_corename"));
  return core_name != nullptr && std::string_view(core_name()) == "Prescott";
}

const char* fitting_kernels() {
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl"))
    return "SkylakeX";
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) return "Haswell";
#endif
  return nullptr;
}

}  // namespace

void prefer_fitting_blas_kernels(char** argv) {
  if (std::getenv(variable) != nullptr || !chose_oldest_kernels()) return;
  const char* kernels = fitting_kernels();
  if (kernels == nullptr || setenv(variable, kernels, 0) != 0) return;
  execv("/proc/self/exe", argv);  // returns only if it fails, and then the slower kernels still work
}

}  // namespace orbweaver::core
