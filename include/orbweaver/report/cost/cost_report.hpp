#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "orbweaver/cost/table.hpp"
#include "orbweaver/report/plot_format.hpp"

namespace orbweaver::report {

/// The table as text: its title, a grid, its remarks.
[[nodiscard]] std::string table_text(const cost::Table& table);

/// As CSV (RFC 4180): heads "time_s" (blanks as underscores, the unit last), numbers with all of their digits, empty
/// where there is none.
[[nodiscard]] std::string table_csv(const cost::Table& table);

/// A picture: its file name without ending, and the script that makes gnuplot draw it, the numbers in it. One each
/// panel.
struct Picture {
  std::string name;
  std::string script;
};
[[nodiscard]] std::vector<Picture> pictures_of(const cost::Table& table, PlotFormat format);

/// Writes a script beside the picture that it draws, into `folder`, and has gnuplot draw it. False where there is no
/// gnuplot. Throws EnvironmentError where files cannot be written or gnuplot fails.
bool draw(const std::filesystem::path& folder, const Picture& picture);

}  // namespace orbweaver::report
