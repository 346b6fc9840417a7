#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "command.hpp"
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

std::string options_text(const CLI::App& app) {
  std::string text;
  for (const CLI::Option* option : app.get_options()) {
    std::vector<std::string> names;
    for (const std::string& name : option->get_snames()) names.push_back("-" + name);
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    if (names.empty()) names.push_back(option->get_name(true, false));
    const std::string value =
        option->get_positional() || option->get_expected_max() == 0 ? "" : " " + option->get_type_name();
    text += fmt::format(".TP\n.B {}\n{}\n", roff(fmt::format("{}{}", fmt::join(names, ", "), value)),
                        roff(option->get_description()));
  }
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
  return text +
         ".SH EXIT STATUS\n"
         "0: done. 1: a numerical goal was missed, or what was found contradicts itself. 2: wrong input. 3: the\n"
         "environment failed: a disk, a library, MPI. 4: stopped early, and resumable.\n";
}

}  // namespace

Command make_manual_command(CLI::App& program) {
  CLI::App* parser = program.add_subcommand("manual", "Print the manual page, for man");
  parser->footer("Example:\n  orbweaver manual | man -l -");
  return {parser, [&program](const Invocation&) {
            ResultStream out;
            out << manual_text(program);
            out.finish();
            return 0;
          }};
}

}  // namespace orbweaver::drivers
