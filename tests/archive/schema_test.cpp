#include "orbweaver/archive/schema/schema.hpp"

#include <gmock/gmock.h>

#include <fstream>
#include <sstream>

namespace schema_test {
namespace {

using namespace orbweaver::archive;

/// The section of docs/file_format.md that describes a table.
std::string section_of(const std::string& table) {
  std::ifstream file(ORBWEAVER_SOURCE_DIR "/docs/file_format.md");
  std::stringstream text;
  text << file.rdbuf();
  const std::string all = text.str();
  const std::size_t begin = all.find("\n## /" + table);
  if (begin == std::string::npos) return "";
  return all.substr(begin, all.find("\n## ", begin + 1) - begin);
}

Header sample_header() {
  Header header;
  header.state_names = {"q", "p"};
  header.winding_names = {"n"};
  header.pairs = 1;
  return header;
}

TEST(Schema, EveryColumnIsDescribedInTheFileFormat) {
  const Header header = sample_header();
  for (const TableSpec& table : {families_spec(), orbits_spec(header), crossings_spec(header), sections_spec(header),
                                 loci_spec(header), equilibria_spec(header), findings_spec()}) {
    const std::string section = section_of(table.name);
    for (const ColumnSpec& column : table.columns) {
      EXPECT_THAT(section, ::testing::HasSubstr("`" + column.name + "`")) << "column of /" << table.name;
      EXPECT_STRNE(column.meaning, "") << column.name << " of /" << table.name;
    }
  }
}

TEST(Schema, RowsOfVectorColumnsAreAsWideAsTheHeaderSays) {
  Header header = sample_header();
  const auto width = [&](const std::string& name) {
    for (const ColumnSpec& column : orbits_spec(header).columns)
      if (column.name == name) return column.width();
    return std::size_t{0};
  };
  EXPECT_EQ(width("period"), 1U);
  EXPECT_EQ(width("state"), 2U);
  EXPECT_EQ(width("winding"), 1U);
  EXPECT_EQ(width("stability"), stability_width(header));
  header.symplectic = false;
  EXPECT_EQ(width("stability"), 2U);
  EXPECT_EQ(width("fundamental_stability"), stability_width(header));
}

}  // namespace
}  // namespace schema_test
