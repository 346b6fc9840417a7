#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "orbweaver/archive/read/reader.hpp"
#include "orbweaver/report/plot_format.hpp"

namespace orbweaver::report {

/// A column of a paper (8.6 cm, 8 pt), both of its columns (17.8 cm), or a slide (25.4 cm by 14.3 cm, 18 pt).
enum class PlotStyle { paper, wide, slide };

/// What to draw of an archive.
struct PlotRequest {
  std::string what;                   ///< one of plot_names()
  std::vector<std::string> families;  ///< only these; none: all, where a picture has several
  std::optional<int> step;            ///< of the family, in pictures of one orbit
  PlotStyle style = PlotStyle::paper;
  PlotFormat format = PlotFormat::svg;
};

/// "tree", "energy-period", "stability", "off-branch", "accuracy", "sweep", "orbit", "strobe", "birth", "convergence",
/// "section", "spectrum".
[[nodiscard]] std::vector<std::string> plot_names();
/// Whether a picture of that name computes something anew, for which PETSc must be running (core::Session).
[[nodiscard]] bool plot_computes(const std::string& what);

/// The format that a file's ending asks for. Throws InputError for another ending.
[[nodiscard]] PlotFormat plot_format_of(const std::filesystem::path& path);

/// gnuplot's commands and numbers for a static picture, written into `output` in gnuplot's working folder. All text
/// from the archive is quoted and without markup. Throws InputError for a family or step that is not there, and where
/// the archive has nothing to draw.
[[nodiscard]] std::string plot_script(const archive::Archive& atlas, const PlotRequest& request,
                                      const std::string& output);

/// Has gnuplot draw it in `folder`, which is there: the path of the picture. Throws as plot_script, and
/// EnvironmentError where gnuplot is not installed or fails.
[[nodiscard]] std::filesystem::path draw_plot(const archive::Archive& atlas, const PlotRequest& request,
                                              const std::filesystem::path& folder);

}  // namespace orbweaver::report
