#include "orbweaver/core/command_line.hpp"

#include <algorithm>
#include <cctype>
#include <string_view>

namespace orbweaver::core {

namespace {

std::vector<std::string>& plugins_in_commands() {
  static std::vector<std::string> files;
  return files;
}

}  // namespace

std::string shell_word(const std::string& text) {
  const bool is_plain = std::all_of(text.begin(), text.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 || std::string_view("_./=:+,-@%").find(static_cast<char>(c)) != std::string_view::npos;
  });
  if (is_plain && !text.empty()) return text;
  std::string word = "'";
  for (const char c : text) word += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return word + "'";
}

std::string command_line(const std::vector<std::string>& words) {
  std::string line = "orbweaver";
  for (const std::string& word : words) line += " " + shell_word(word);
  return line;
}

std::string archive_command_line(const std::vector<std::string>& words) {
  std::vector<std::string> all = words;
  for (const std::string& file : plugins_in_commands()) all.insert(all.end(), {"--plugin", file});
  return command_line(all);
}

bool names_plugins_in_commands() { return !plugins_in_commands().empty(); }

void name_plugin_in_commands(const std::filesystem::path& file) { plugins_in_commands().push_back(file.string()); }

}  // namespace orbweaver::core
