#include "gnuplot.hpp"

#include <optional>

#include <fmt/format.h>

#include "orbweaver/core/error.hpp"
#include "orbweaver/core/posix_file.hpp"
#include "orbweaver/core/process.hpp"
#include "orbweaver/core/text.hpp"

namespace orbweaver::report {

std::string gnuplot_text(std::string_view text) {
  std::string out = "'";
  for (const char c : core::printable(text)) out += c == '\'' ? std::string("''") : std::string(1, c);
  return out + "'";
}

std::string_view ending_of(PlotFormat format) {
  switch (format) {
    case PlotFormat::svg: return "svg";
    case PlotFormat::pdf: return "pdf";
    case PlotFormat::png: return "png";
  }
  return "";
}

bool run_gnuplot(const std::filesystem::path& folder, const std::string& name, const std::string& script) {
  const std::filesystem::path path = name + ".gnuplot";
  core::write_file(folder / path, {script});
  // Without a locale, as in containers, gnuplot says that it cannot write the degree sign.
  const std::optional<int> status =
      core::run_program({"gnuplot", path.string()}, {.folder = folder, .environment = {{"LC_ALL", "C.UTF-8"}}});
  if (!status) return false;
  if (*status != 0)
    throw core::EnvironmentError(fmt::format("gnuplot could not draw {}; its messages are above", path.string()));
  return true;
}

}  // namespace orbweaver::report
