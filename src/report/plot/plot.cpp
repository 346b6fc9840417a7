#include "orbweaver/report/plot/plot.hpp"

#include <functional>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "gnuplot.hpp"
#include "orbweaver/core/error.hpp"
#include "plot/diagrams.hpp"
#include "plot/figure.hpp"
#include "plot/orbit_pictures.hpp"

namespace orbweaver::report {

namespace {

using Panels = std::function<std::vector<Figure>(const archive::Archive&, const PlotRequest&)>;

Panels alone(Figure (*figure)(const archive::Archive&, const PlotRequest&)) {
  return [figure](const archive::Archive& atlas, const PlotRequest& request) {
    return std::vector<Figure>{figure(atlas, request)};
  };
}

/// What can be drawn: to add one, a line.
const std::vector<std::pair<std::string, Panels>>& pictures() {
  static const std::vector<std::pair<std::string, Panels>> all{
      {"tree", alone(tree_figure)},
      {"energy-period", alone(energy_period_figure)},
      {"stability", alone(stability_figure)},
      {"off-branch", alone(off_branch_figure)},
      {"orbit", orbit_figures},
      {"strobe", strobe_figures},
      {"section", section_figures},
      {"spectrum", spectrum_figures},
  };
  return all;
}

}  // namespace

std::vector<std::string> plot_names() {
  std::vector<std::string> names;
  for (const auto& [name, panels] : pictures()) names.push_back(name);
  return names;
}

PlotFormat plot_format_of(const std::filesystem::path& path) {
  for (const PlotFormat format : {PlotFormat::svg, PlotFormat::pdf, PlotFormat::png})
    if (path.extension() == fmt::format(".{}", ending_of(format))) return format;
  throw core::InputError(
      fmt::format("expected a file that ends in .svg, .pdf or .png, got `{}`", path.filename().string()));
}

std::string plot_script(const archive::Archive& atlas, const PlotRequest& request, const std::string& output) {
  for (const auto& [name, panels] : pictures())
    if (name == request.what) return figure_script(panels(atlas, request), request.style, request.format, output);
  throw core::InputError(fmt::format("expected one of {}, got `{}`", fmt::join(plot_names(), ", "), request.what));
}

std::filesystem::path draw_plot(const archive::Archive& atlas, const PlotRequest& request,
                                const std::filesystem::path& folder) {
  const std::string name = fmt::format("picture.{}", ending_of(request.format));
  if (!run_gnuplot(folder, "picture", plot_script(atlas, request, name)))
    throw core::EnvironmentError(
        "gnuplot is not installed, which draws the pictures: apt-get install gnuplot-nox (docs/dependencies.md)");
  return folder / name;
}

}  // namespace orbweaver::report
