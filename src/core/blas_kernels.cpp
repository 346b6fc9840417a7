#include "orbweaver/core/blas_kernels.hpp"

#include <cstdlib>
#include <string_view>

#include <dlfcn.h>
#include <unistd.h>

namespace orbweaver::core {

namespace {

constexpr const char* variable = "OPENBLAS_CORETYPE";

template <class Function>
Function* found(const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_DEFAULT, name));
}

bool has_oldest_kernels() {
  const auto core_name = found<char*()>("openblas_get_corename");
  return core_name != nullptr && std::string_view(core_name()) == "Prescott";
}

/// What OpenBLAS does when it is loaded, again: nothing has used it yet.
void choose_kernels_again() {
  const auto forget = found<void()>("gotoblas_dynamic_quit");
  const auto choose = found<void()>("gotoblas_dynamic_init");
  if (forget == nullptr || choose == nullptr) return;
  forget();
  choose();
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
  if (std::getenv(variable) != nullptr || !has_oldest_kernels()) return;
  const char* kernels = fitting_kernels();
  if (kernels == nullptr || setenv(variable, kernels, 0) != 0) return;
  choose_kernels_again();
  if (!has_oldest_kernels()) return;
  execv("/proc/self/exe", argv);  // returns only if it fails, and then the slower kernels still work
}

}  // namespace orbweaver::core
