#include <cstring>

#include <dlfcn.h>

#include "fuzz/kinds.hpp"
#include "orbweaver/core/text.hpp"
#include "registry_lines.hpp"
#include "shared_library.hpp"

namespace orbweaver::fuzz {

namespace {

const std::vector<std::string> elf_words{
    "\x7f"
    "ELF",
    std::string(8, '\0'), std::string(8, '\xff'), ".dynamic"};
const std::vector<std::string> name_words{"\x1b[31m", "\xff", "\xc2\x9b", "é", std::string(1, '\0'), "\t", "x", "<>"};

void require_that_it_loads(const std::filesystem::path& file) {
  void* library = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) throw WrongReading{std::string("the dynamic linker refuses what was taken: ") + dlerror()};
  using Answer = int (*)();
  const auto answer = reinterpret_cast<Answer>(dlsym(library, "answer"));
  const bool is_right = answer != nullptr && answer() == 42;
  dlclose(library);
  if (!is_right) throw WrongReading{"another library was loaded"};
}

}  // namespace

Kind plugins(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / "plugin.so";
  const std::string whole = bytes_of(ORBWEAVER_FUZZ_LIBRARY);
  return {[whole](Mutator& mutator) {
            return mutator.below(2) == 0 ? whole.substr(0, mutator.below(whole.size() + 1))
                                         : mutator.changed(whole, elf_words);
          },
          [file, whole](const std::string& bytes) {
            write_bytes(file, bytes);
            systems::require_shared_library(file);
            // What is changed and whole is as good as its code: that is not run here.
            if (whole.starts_with(bytes)) require_that_it_loads(file);
          }};
}

Kind descriptions() {
  return {[](Mutator& mutator) {
            std::string text = "my_system\nMy system\nwhat moves\nq\np\nk\n1/s\nstiffness";
            return mutator.below(3) == 0 ? text : mutator.changed(text, name_words);
          },
          [](const std::string& text) {
            std::vector<std::string> words{""};
            for (const char c : text)
              if (c == '\n')
                words.emplace_back();
              else
                words.back() += c;
            words.resize(8);
            systems::ModelInfo info;
            info.name = words[0];
            info.title = words[1];
            info.meaning = words[2];
            info.state_names = {words[3], words[4]};
            info.winding_names = {words[3], ""};
            info.parameters = {{words[5], 1.0, 0.0, 2.0, false, words[6], words[7]}};
            info.effects = {{words[5], words[2], info.parameters}};
            systems::require_description(info);
            for (const std::string& word : words)
              if (core::printable(word) != word) throw WrongReading{"a description that cannot be shown"};
          }};
}

}  // namespace orbweaver::fuzz
