// Compiled for any processor (drivers/CMakeLists.txt), since it runs before all that may end by an illegal instruction.
#include "processor.hpp"

#if defined(__x86_64__) && defined(__GNUC__)

#include <cstring>

#include <unistd.h>

namespace orbweaver::drivers {

namespace {

void say(const char* text) { static_cast<void>(!write(STDERR_FILENO, text, std::strlen(text))); }

bool is_here(const char* name) {  // the built-in function takes literals only
  if (std::strcmp(name, "avx") == 0) return __builtin_cpu_supports("avx") != 0;
  if (std::strcmp(name, "avx2") == 0) return __builtin_cpu_supports("avx2") != 0;
  if (std::strcmp(name, "fma") == 0) return __builtin_cpu_supports("fma") != 0;
  if (std::strcmp(name, "bmi2") == 0) return __builtin_cpu_supports("bmi2") != 0;
  return __builtin_cpu_supports("avx512f") != 0;
}

constexpr int environment_failed = 3;  // core::ExitStatus, whose header brings code of its own

void require_extensions() {
  __builtin_cpu_init();
  for (const ProcessorExtension* extension = processor_extensions; extension->name != nullptr; ++extension) {
    if (!extension->compiled_in || is_here(extension->name)) continue;
    say("orbweaver: this program was compiled for processors with ");
    say(extension->name);
    say(", which this one lacks: compile it on this machine, or with -D ORBWEAVER_NATIVE=OFF (docs/building.md)\n");
    _exit(environment_failed);
  }
}

// Before the initialisers of shared libraries: they may find templates of the standard library in the program.
[[gnu::section(".preinit_array"), gnu::used]] void (*const first)() = require_extensions;

}  // namespace

}  // namespace orbweaver::drivers

#endif
