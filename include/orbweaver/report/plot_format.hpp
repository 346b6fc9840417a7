#pragma once

namespace orbweaver::report {

/// What gnuplot draws: vectors to scale and to print, or a bitmap.
enum class PlotFormat { svg, pdf, png };

}  // namespace orbweaver::report
