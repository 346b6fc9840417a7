#include <cstddef>
#include <cstdint>
#include <string>

#include "orbweaver/core/error.hpp"
#include "orbweaver/scene/scene.hpp"

/// Scenes, led by what of the reader they reach; libfuzzer.sh builds it.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  try {
    (void)orbweaver::scene::parse(std::string(reinterpret_cast<const char*>(bytes), size), "fuzz.yaml");
  } catch (const orbweaver::core::InputError&) {
  }
  return 0;
}
