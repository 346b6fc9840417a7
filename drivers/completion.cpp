#include <algorithm>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "command.hpp"
#include "result_stream.hpp"

namespace orbweaver::drivers {

namespace {

std::vector<const CLI::App*> commands_of(const CLI::App& program) {
  return program.get_subcommands([](const CLI::App*) { return true; });
}

/// -o and --output, each in a word.
std::vector<std::string> words_of(const CLI::Option& option) {
  std::vector<std::string> words;
  for (const std::string& name : option.get_snames()) words.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) words.push_back("--" + name);
  return words;
}

std::string joined_words(const CLI::App& command) {
  std::vector<std::string> words;
  for (const CLI::Option* option : command.get_options())
    for (const std::string& word : words_of(*option)) words.push_back(word);
  return fmt::format("{}", fmt::join(words, " "));
}

std::string quoted(std::string text) {  // for a shell, in single quotes
  for (std::size_t at = 0; (at = text.find('\'', at)) != std::string::npos; at += 4) text.replace(at, 1, "'\\''");
  return "'" + text + "'";
}

/// Options of the command behind a `-`, else files. The command may stand behind `--ranks N`.
std::string bash_text(const CLI::App& program) {
  std::vector<std::string> names;
  std::string cases;
  for (const CLI::App* command : commands_of(program)) {
    names.push_back(command->get_name());
    cases += fmt::format("    {}) options={} ;;\n", command->get_name(), quoted(joined_words(*command)));
  }
  return fmt::format(
      "_orbweaver() {{\n"
      "  local word=${{COMP_WORDS[COMP_CWORD]}} options={} at=1\n"
      "  [[ ${{COMP_WORDS[1]}} == --ranks && $COMP_CWORD -gt 2 ]] && at=3\n"
      "  [[ $COMP_CWORD -gt $at ]] && case ${{COMP_WORDS[at]}} in\n{}  esac\n"
      "  if [[ $COMP_CWORD -eq $at || $word == -* ]]; then\n"
      "    COMPREPLY=($(compgen -W \"$options\" -- \"$word\"))\n"
      "  else\n"
      "    COMPREPLY=($(compgen -f -- \"$word\"))\n"
      "  fi\n"
      "}}\n"
      "complete -o filenames -F _orbweaver orbweaver\n",
      quoted(fmt::format("{} {}", fmt::join(names, " "), joined_words(program))), cases);
}

/// 'WORD:what it does', as _describe of zsh takes it.
std::string described(const std::string& word, const std::string& text) {
  return quoted(fmt::format("{}:{}", word, text.substr(0, text.find('\n'))));
}

std::string described_options(const CLI::App& app) {
  std::string text;
  for (const CLI::Option* option : app.get_options())
    for (const std::string& word : words_of(*option)) text += " " + described(word, option->get_description());
  return text;
}

/// As bash_text, with descriptions. Works sourced, and as the file _orbweaver on zsh's fpath.
std::string zsh_text(const CLI::App& program) {
  std::string commands;
  std::string cases;
  for (const CLI::App* command : commands_of(program)) {
    commands += "    " + described(command->get_name(), command->get_description()) + "\n";
    cases += fmt::format("    {}) options=({}) ;;\n", command->get_name(), described_options(*command));
  }
  return fmt::format(
      "#compdef orbweaver\n"
      "_orbweaver() {{\n"
      "  local at=2\n"
      "  local -a commands options\n"
      "  commands=(\n{}  )\n"
      "  options=({})\n"
      "  [[ ${{words[2]}} == --ranks && $CURRENT -gt 3 ]] && at=4\n"
      "  (( CURRENT > at )) && case ${{words[at]}} in\n{}  esac\n"
      "  if [[ $PREFIX == -* ]]; then\n"
      "    _describe -o option options\n"
      "  elif (( CURRENT == at )); then\n"
      "    _describe command commands\n"
      "  else\n"
      "    _files\n"
      "  fi\n"
      "}}\n"
      "if [[ ${{funcstack[1]}} == _orbweaver ]]; then _orbweaver \"$@\"; else compdef _orbweaver orbweaver; fi\n",
      commands, described_options(program), cases);
}

std::string fish_text(const CLI::App& program) {
  std::string text;
  const auto add_options = [&](const CLI::App& app, const std::string& condition) {
    for (const CLI::Option* option : app.get_options()) {
      if (option->get_snames().empty() && option->get_lnames().empty()) continue;
      text += fmt::format("complete -c orbweaver -n {}", quoted(condition));
      for (const std::string& name : option->get_snames()) text += " -s " + name;
      for (const std::string& name : option->get_lnames()) text += " -l " + name;
      text += fmt::format("{} -d {}\n", option->get_expected_max() > 0 ? " -r" : "", quoted(option->get_description()));
    }
  };
  add_options(program, "__fish_use_subcommand");
  for (const CLI::App* command : commands_of(program)) {
    text += fmt::format("complete -c orbweaver -n __fish_use_subcommand -f -a {} -d {}\n", command->get_name(),
                        quoted(command->get_description()));
    add_options(*command, "__fish_seen_subcommand_from " + command->get_name());
  }
  return text;
}

int print_completion(const CLI::App& program, const std::string& shell) {
  ResultStream out;
  out << (shell == "fish" ? fish_text(program) : shell == "zsh" ? zsh_text(program) : bash_text(program));
  out.finish();
  return 0;
}

}  // namespace

Command make_completion_command(CLI::App& program) {
  CLI::App* parser = program.add_subcommand("completion", "Print a script that completes orbweaver's words in a shell");
  auto shell = std::make_shared<std::string>();
  parser->add_option("SHELL", *shell, "bash, zsh or fish")->required()->check(CLI::IsMember({"bash", "zsh", "fish"}));
  parser->footer("Example, in ~/.bashrc:\n  source <(orbweaver completion bash)");
  return {parser, [shell, &program](const Invocation&) { return print_completion(program, *shell); }};
}

}  // namespace orbweaver::drivers
