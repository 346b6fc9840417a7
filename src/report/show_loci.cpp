#include "show_loci.hpp"

#include <fmt/format.h>

#include "show_crossings.hpp"
#include "show_level.hpp"
#include "text_grid.hpp"

namespace orbweaver::report {

void print_loci(std::ostream& out, const archive::Archive& atlas) {
  const archive::Table& loci = atlas.loci();
  std::vector<std::string> families;
  for (const std::int64_t family : loci.integers("family"))
    families.push_back(atlas.families().texts("name")[static_cast<std::size_t>(family)]);
  const Level level = level_of(atlas);
  TextGrid grid;
  grid.add_column("locus", cells_of(loci.integers("locus")));
  grid.add_column("family", families, false);
  grid.add_column("kind", loci.texts("kind"), false);
  grid.add_column("period", cells_of(loci.reals("period"), "{:.10g}"));
  grid.add_column(level.title, cells_of(loci.reals(level.column), "{:.10g}"));
  grid.add_column("second", loci.texts("second_name"), false);
  grid.add_column("value", cells_of(loci.reals("second_parameter"), "{:.10g}"));
  grid.add_column("note", loci.texts("note"), false);
  grid.print(out);
}

}  // namespace orbweaver::report
