#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace orbweaver::systems {

/// A shared library that brings systems, loaded into this process for good.
struct Plugin {
  std::filesystem::path file;
  std::string source;               ///< 40 hexadecimal digits: SHA-1 of its source, or of the file where it has none
  std::string build;                ///< the same of the file
  std::vector<std::string> models;  ///< names of its systems, the first one first
};

/// "'mine' (/home/me/mine.so)" of a system that a loaded plugin brings, "'duffing'" of one of the program.
[[nodiscard]] std::string name_with_plugin(const std::string& system);

/// Loads a plugin, once, and adds its systems to the registry. Throws core::InputError that names the file: where it
/// cannot be read, is none, was built for another version, compiler or processor, lacks a symbol, or brings a system or
/// a combination of effects that there is already.
const Plugin& load_plugin(const std::filesystem::path& file);

/// The loaded plugin of that source; nullptr where there is none.
[[nodiscard]] const Plugin* find_plugin(const std::string& source);

/// All loaded plugins, in their order.
[[nodiscard]] std::vector<const Plugin*> loaded_plugins();

}  // namespace orbweaver::systems
