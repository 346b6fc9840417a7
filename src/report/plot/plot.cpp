#include "orbweaver/report/plot/plot.hpp"

#include <algorithm>
#include <functional>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "gnuplot.hpp"
#include "orbweaver/core/error.hpp"
#include "plot/birth_pictures.hpp"
#include "plot/convergence_picture.hpp"
#include "plot/diagrams.hpp"
#include "plot/figure.hpp"
#include "plot/orbit_pictures.hpp"
#include "plot/sweep_picture.hpp"

namespace orbweaver::report {

namespace {

using Panels = std::function<std::vector<Figure>(const archive::Archive&, const PlotRequest&)>;

Panels alone(Figure (*figure)(const archive::Archive&, const PlotRequest&)) {
  return [figure](const archive::Archive& atlas, const PlotRequest& request) {
    return std::vector<Figure>{figure(atlas, request)};
  };
}

struct PictureKind {
  std::string name;
  Panels panels;
  bool of_a_step = false;  ///< a step of the family may be asked for
  bool computes = false;   ///< with PETSc
};

/// What can be drawn: to add one, a line.
const std::vector<PictureKind>& pictures() {
  static const std::vector<PictureKind> all{
      {"tree", alone(tree_figure)},
      {"energy-period", alone(energy_period_figure)},
      {"stability", alone(stability_figure)},
      {"off-branch", alone(off_branch_figure), false, true},
      {"accuracy", alone(accuracy_figure)},
      {"sweep", alone(sweep_figure), false, true},
      {"orbit", orbit_figures, true},
      {"strobe", strobe_figures, true},
      {"birth", birth_figures},
      {"convergence", alone(convergence_figure), true, true},
      {"section", section_figures},
      {"spectrum", spectrum_figures, true},
  };
  return all;
}

}  // namespace

std::vector<std::string> plot_names() {
  std::vector<std::string> names;
  for (const PictureKind& kind : pictures()) names.push_back(kind.name);
  return names;
}

bool plot_computes(const std::string& what) {
  return std::any_of(pictures().begin(), pictures().end(),
                     [&](const PictureKind& kind) { return kind.name == what && kind.computes; });
}

PlotFormat plot_format_of(const std::filesystem::path& path) {
  for (const PlotFormat format : {PlotFormat::svg, PlotFormat::pdf, PlotFormat::png})
    if (path.extension() == fmt::format(".{}", ending_of(format))) return format;
  throw core::InputError(
      fmt::format("expected a file that ends in .svg, .pdf or .png, got `{}`", path.filename().string()));
}

std::string plot_script(const archive::Archive& atlas, const PlotRequest& request, const std::string& output) {
  for (const PictureKind& kind : pictures()) {
    if (kind.name != request.what) continue;
    if (request.step && !kind.of_a_step)
      throw core::InputError(fmt::format("expected no --step for `{}`: it draws whole families", request.what));
    return figure_script(kind.panels(atlas, request), request.style, request.format, output);
  }
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
