#include "orbweaver/systems/plugins.hpp"

#include <algorithm>
#include <deque>
#include <fstream>
#include <span>

#include <dlfcn.h>
#include <fmt/format.h>

#include "orbweaver/core/command_line.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/core/file_hash.hpp"
#include "orbweaver/core/input_file.hpp"
#include "orbweaver/core/text.hpp"
#include "orbweaver/systems/model/plugin_table.hpp"
#include "registry_lines.hpp"
#include "shared_library.hpp"

namespace orbweaver::systems {

namespace {

std::deque<Plugin>& plugins() {
  static std::deque<Plugin> loaded;  // references to its members stay
  return loaded;
}

[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& text) {
  throw core::InputError(fmt::format("the plugin '{}': {}", file.string(), text));
}

constexpr std::size_t longest_echo = 60;

bool is_hash(const std::string& text) {
  constexpr std::size_t digits = 40;  // of SHA-1
  return text.size() == digits && text.find_first_not_of("0123456789abcdef") == std::string::npos;
}

constexpr std::string_view build_again = "build it again with this program's `orbweaver build-system`";

// A library stays loaded also where it is refused: nothing of it is used.
void* opened(const std::filesystem::path& file, int mode) {
  void* library = dlopen(file.c_str(), mode | RTLD_LOCAL);
  if (library == nullptr) refuse(file, fmt::format("cannot be loaded ({}); {}", dlerror(), build_again));
  return library;
}

const PluginTable& table_of(const std::filesystem::path& file) {
  try {
    require_shared_library(file);
  } catch (const core::InputError& error) {
    refuse(file, fmt::format("cannot be loaded ({}); {}", error.what(), build_again));
  }
  // Lazily first, so that a plugin for another version says so before a symbol of that version is missed.
  void* library = opened(file, RTLD_LAZY);
  const auto* table = static_cast<const PluginTable*>(dlsym(library, "orbweaver_plugin"));
  if (table == nullptr)
    refuse(file,
           "it has no symbol `orbweaver_plugin`: its source ends with ORBWEAVER_SYSTEMS(Model), and "
           "`orbweaver build-system` compiles it");
  if (table->abi != plugin_abi)
    refuse(file, fmt::format("it is of ABI version {}, this program of {}; {}", table->abi, plugin_abi, build_again));
  if (table->size != sizeof(PluginTable))
    refuse(file,
           fmt::format("its table has {} bytes, this program's {}; {}", table->size, sizeof(PluginTable), build_again));
  if (table->layout != plugin_layout)
    refuse(file, fmt::format("it was built against version {}, with other types, a different compiler or for another "
                             "processor; {}",
                             table->version, build_again));
  opened(file, RTLD_NOW);
  if (table->line_count == 0 || table->lines == nullptr) refuse(file, "it brings no system");
  return *table;
}

}  // namespace

const Plugin& load_plugin(const std::filesystem::path& file) {
  if (const std::string problem = core::input_problem(file); !problem.empty()) refuse(file, "it " + problem);
  const std::filesystem::path path = std::filesystem::canonical(file);
  for (const Plugin& plugin : plugins())
    if (plugin.file == path) return plugin;
  const PluginTable& table = table_of(path);
  Plugin plugin{path, table.source, core::file_hash({path}), {}};
  if (!plugin.source.empty() && !is_hash(plugin.source))
    refuse(file, fmt::format("its source has the hash `{}`, which is none; {}",
                             core::shortened(core::printable(plugin.source), longest_echo), build_again));
  if (plugin.source.empty()) plugin.source = plugin.build;
  const std::span lines(table.lines, table.line_count);
  for (const RegistryLine& line : lines) plugin.models.push_back(line.info().name);
  try {
    add_registry_lines(lines);
  } catch (const core::InputError& error) {
    refuse(file, error.what());
  }
  core::name_plugin_in_commands(path);
  return plugins().emplace_back(std::move(plugin));
}

std::string name_with_plugin(const std::string& system) {
  for (const Plugin& plugin : plugins())
    if (std::find(plugin.models.begin(), plugin.models.end(), system) != plugin.models.end())
      return fmt::format("'{}' ({})", system, plugin.file.string());
  return fmt::format("'{}'", system);
}

const Plugin* find_plugin(const std::string& source) {
  for (const Plugin& plugin : plugins())
    if (plugin.source == source) return &plugin;
  return nullptr;
}

std::vector<const Plugin*> loaded_plugins() {
  std::vector<const Plugin*> all;
  for (const Plugin& plugin : plugins()) all.push_back(&plugin);
  return all;
}

}  // namespace orbweaver::systems
