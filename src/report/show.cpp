#include "orbweaver/report/show.hpp"

#include <algorithm>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "notable_equilibria.hpp"
#include "show_crossings.hpp"
#include "show_equilibria.hpp"
#include "show_families.hpp"
#include "show_findings.hpp"
#include "show_head.hpp"
#include "show_level.hpp"
#include "show_loci.hpp"
#include "show_values.hpp"
#include "show_verdicts.hpp"

namespace orbweaver::report {

const archive::Table& shown_table(const archive::Archive& atlas, const std::string& name) {
  if (name == "families") return atlas.families();
  if (name == "orbits") return atlas.orbits();
  if (name == "crossings") return atlas.crossings();
  if (name == "loci") return atlas.loci();
  if (name == "equilibria") return atlas.equilibria();
  if (name == "findings") return atlas.findings();
  throw core::InputError(fmt::format(
      "cannot show '{}': the tables of an atlas are families, orbits, crossings, loci, equilibria and findings", name));
}

namespace {

void print_equilibria_of(std::ostream& out, const archive::Archive& atlas, const Selection& selection) {
  TableView view = view_of(atlas, atlas.equilibria(), selection);
  if (!selection.all_equilibria) {
    const std::vector<std::size_t> notable = notable_equilibria(atlas.equilibria());
    std::erase_if(view.rows, [&](std::size_t row) { return !std::binary_search(notable.begin(), notable.end(), row); });
  }
  if (selection.columns.empty())
    print_equilibria(out, atlas, view.rows);
  else
    print_readable(out, atlas, view);
  print_left_out_equilibria(out, atlas, view.rows.size());
}

}  // namespace

void print_summary(std::ostream& out, const archive::Archive& atlas, const Layout& layout) {
  const archive::Header& header = atlas.header();
  const auto whole_range = [&](const char* column) {
    return range_text(atlas.orbits().reals(column), 0, atlas.orbits().rows());
  };
  const std::uint64_t bytes = atlas.mode_values() * sizeof(double);
  out << fmt::format("{}: {} {}, written by Orbweaver {}\n", atlas.path().string(), archive::atlas_format,
                     archive::format_version, header.orbweaver_version);
  print_head(out, atlas, layout.width);
  out << fmt::format("coordinates  {}\n", fmt::join(header.state_names, ", "));
  out << fmt::format("families     {}\n", atlas.families().rows());
  out << fmt::format("orbits       {}\n", atlas.orbits().rows());
  out << fmt::format("crossings    {}\n", atlas.crossings().rows());
  out << fmt::format("sections     {}\n", atlas.sections().rows());
  if (const auto& loci = atlas.loci().integers("locus"); !loci.empty())
    out << fmt::format("loci         {}, of {} points\n", loci.back() + 1, loci.size());
  if (const auto& equilibria = atlas.equilibria().integers("equilibrium"); !equilibria.empty())
    out << fmt::format("equilibria   {}, with {} points of their curves\n",
                       std::set(equilibria.begin(), equilibria.end()).size(), equilibria.size());
  out << fmt::format("findings     {}\n", atlas.findings().rows());
  if (const std::string verdicts = verdicts_text(atlas, 0, atlas.orbits().rows()); !verdicts.empty())
    out << fmt::format("certificates {}\n", verdicts);
  out << fmt::format("modes        {} values ({:.1f} MB)\n", atlas.mode_values(), static_cast<double>(bytes) / 1e6);
  out << fmt::format("period       {}\n", whole_range("period"));
  const Level level = level_of(atlas);
  out << fmt::format("{:<12} {}\n", level.title, whole_range(level.column));
  if (atlas.families().rows() == 0) return;
  out << '\n';
  print_families(out, atlas, layout);
}

void print_table_head(std::ostream& out, const archive::Archive& atlas, const Layout& layout) {
  print_head(out, atlas, layout.width);
  out << '\n';
}

void print_table(std::ostream& out, const archive::Archive& atlas, const std::string& name, TextFormat format,
                 const Selection& selection, const Layout& layout) {
  const archive::Table& table = shown_table(atlas, name);
  if (format == TextFormat::csv)
    print_csv(out, atlas.header(), view_of(atlas, table, selection));
  else if (format == TextFormat::json)
    print_json(out, view_of(atlas, table, selection));
  else if (name == "crossings" && selection.columns.empty())
    print_crossings(out, atlas, view_of(atlas, table, selection).rows);
  else if (name == "equilibria")
    print_equilibria_of(out, atlas, selection);
  else if (name == "orbits" || !selection.empty()) {
    TableView view = view_of(atlas, table, selection);
    if (selection.columns.empty()) drop_unread_columns(view);
    print_readable(out, atlas, view);
  } else if (name == "families")
    print_families(out, atlas, layout);
  else if (name == "loci")
    print_loci(out, atlas);
  else
    print_findings(out, atlas);
}

}  // namespace orbweaver::report
