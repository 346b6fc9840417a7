#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "command.hpp"
#include "common_options.hpp"
#include "orbweaver/scene/known_keys.hpp"
#include "result_stream.hpp"

namespace orbweaver::drivers {

namespace {

/// Text for roff: backslashes, and hyphens that are minus signs; a line that begins with a dot or quote is text.
std::string roff(const std::string& text) {
  std::string out;
  bool line_begins = true;
  for (const char c : text) {
    if (line_begins && (c == '.' || c == '\'')) out += "\\&";
    if (c == '\\')
      out += "\\e";
    else if (c == '-')
      out += "\\-";
    else
      out += c;
    line_begins = c == '\n';
  }
  return out;
}

/// "-o, --output TEXT", "SCENE".
std::string option_text(const CLI::Option& option) {
  std::vector<std::string> names;
  for (const std::string& name : option.get_snames()) names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
  if (names.empty()) names.push_back(option.get_name(true, false));
  const bool takes_none = option.get_positional() || option.get_expected_max() == 0;
  const std::string type = option.get_type_name();  // with words that stand for others behind it
  return fmt::format("{}{}", fmt::join(names, ", "), takes_none ? "" : " " + type.substr(0, type.find(":value in ")));
}

std::string options_text(const CLI::App& app) {
  std::string text;
  for (const CLI::Option* option : app.get_options())
    text += fmt::format(".TP\n.B {}\n{}\n", roff(option_text(*option)), roff(option->get_description()));
  return text;
}

std::string keys_text() {
  std::string text;
  for (const scene::KnownKey& key : scene::known_keys())
    text += fmt::format(".TP\n.B {}\n{}. Takes {}{}. Default: {}.\n", roff(std::string(key.path)),
                        roff(std::string(key.meaning)), roff(std::string(key.value)),
                        key.unit.empty() ? "" : roff(fmt::format(" ({})", key.unit)), roff(std::string(key.standard)));
  return text;
}

std::string footer_text(const CLI::App& app) {
  const std::string footer = app.get_footer();
  return footer.empty() ? "" : fmt::format(".PP\n.nf\n{}\n.fi\n", roff(footer));
}

std::string manual_text(const CLI::App& program) {
  std::string text = fmt::format(
      ".TH ORBWEAVER 1 \"\" \"{}\" \"User Commands\"\n.SH NAME\norbweaver \\- families of periodic orbits\n.SH "
      "SYNOPSIS\n"
      ".B orbweaver\n.I command\n[options] [\\-\\- options of PETSc, SLEPc and TAO]\n.SH DESCRIPTION\n{}\n.SH "
      "OPTIONS\n{}",
      roff(program.version()), roff(program.get_description()), options_text(program));
  text += ".SH COMMANDS\n";
  for (const CLI::App* command : program.get_subcommands([](const CLI::App*) { return true; }))
    text += fmt::format(".SS {}\n{}\n{}{}", roff(command->get_name()), roff(command->get_description()),
                        options_text(*command), footer_text(*command));
  return text + ".SH SCENES\nThe keys of a scene; [] stands for any entry of a list.\n" + keys_text() +
         ".SH EXIT STATUS\n"
         "0: done. 1: a numerical goal was missed, or what was found contradicts itself. 2: wrong input. 3: the\n"
         "environment failed: a disk, a library, MPI. 4: stopped early, and resumable.\n";
}

/// Text for a cell of a Markdown table.
std::string cell(std::string text) {
  for (auto place = text.find('|'); place != std::string::npos; place = text.find('|', place + 2))
    text.insert(place, "\\");
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

std::string options_table(const CLI::App& app) {
  std::string text = "| option | meaning |\n|---|---|\n";
  for (const CLI::Option* option : app.get_options([](const CLI::Option* o) { return o->get_name() != "--help"; }))
    text += fmt::format("| `{}`{} | {} |\n", cell(option_text(*option)), option->get_required() ? ", required" : "",
                        cell(option->get_description()));
  return text;
}

std::string programs_text(const CLI::App& program) {
  std::string text = fmt::format("## orbweaver\n\nBefore a command.\n\n{}\n", options_table(program));
  for (const CLI::App* command : program.get_subcommands([](const CLI::App*) { return true; })) {
    text += fmt::format("## orbweaver {}\n\n{}.\n\n{}", command->get_name(), command->get_description(),
                        options_table(*command));
    std::string footer = command->get_footer();
    if (footer.starts_with(program.get_footer())) footer.erase(0, program.get_footer().size());
    footer.erase(0, footer.find_first_not_of('\n'));
    if (!footer.empty()) text += "\n    ";
    for (std::size_t n = 0; n < footer.size(); ++n) {
      const bool indent = footer[n] == '\n' && n + 1 < footer.size() && footer[n + 1] != '\n';
      text += indent ? "\n    " : std::string(1, footer[n]);
    }
    text += footer.empty() ? "\n" : "\n\n";
  }
  return text;
}

std::string scene_text() {
  std::string text;
  std::string_view section;
  for (const scene::KnownKey& key : scene::known_keys()) {
    const std::string_view top = key.path.substr(0, key.path.find_first_of(".["));
    if (top != section && key.path != "name")
      text += fmt::format("\n## {}\n\n`{}` is {}: {}{}.\n\n", top, top, key.value, key.meaning,
                          key.standard == "required" ? "; required" : "");
    if (top != section) text += "| key | takes | default | unit | meaning |\n|---|---|---|---|---|\n";
    section = top;
    if (key.path == top && key.path != "name") continue;
    text += fmt::format("| `{}` | {} | {} | {} | {} |\n", key.path, cell(std::string(key.value)),
                        cell(std::string(key.standard)), key.unit, cell(std::string(key.meaning)));
  }
  return text;
}

}  // namespace

Command make_manual_command(CLI::App& program) {
  CLI::App* parser = program.add_subcommand("manual", "Print the manual page, for man, or a reference in Markdown");
  auto what = std::make_shared<std::string>("page");
  parser
      ->add_option("WHAT", *what,
                   "page: all of it, for man; scene: every key of a scene; programs: commands and options")
      ->check(CLI::IsMember({"page", "scene", "programs"}));
  add_examples(*parser, {"orbweaver manual | man -l -", "orbweaver manual scene", "orbweaver manual programs"});
  return {
      parser, [&program, what](const Invocation&) {
        ResultStream out;
        out << (*what == "scene" ? scene_text() : *what == "programs" ? programs_text(program) : manual_text(program));
        out.finish();
        return 0;
      }};
}

}  // namespace orbweaver::drivers
