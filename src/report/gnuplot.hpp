#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <string_view>

#include "orbweaver/report/plot_format.hpp"

namespace orbweaver::report {

/// Text in gnuplot's single quotes, where nothing in it is a command; control characters and bytes that are not UTF-8
/// are escaped. For terminals or labels without markup (`noenhanced`).
[[nodiscard]] std::string gnuplot_text(std::string_view text);

/// "svg".
[[nodiscard]] std::string_view ending_of(PlotFormat format);

/// Colours that stay apart in print and for most who see few colours (Okabe and Ito 2008).
inline constexpr std::array<const char*, 8> plot_colours{"#0072B2", "#D55E00", "#009E73", "#CC79A7",
                                                         "#E69F00", "#56B4E9", "#000000", "#999999"};

/// Writes FOLDER/NAME.gnuplot, which makes its files in the folder from wherever it is run, and has gnuplot run it.
/// False where there is no gnuplot. Throws EnvironmentError where the file cannot be written or gnuplot fails.
bool run_gnuplot(const std::filesystem::path& folder, const std::string& name, const std::string& script);

}  // namespace orbweaver::report
