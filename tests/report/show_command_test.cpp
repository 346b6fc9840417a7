#include <gmock/gmock.h>

#include <sys/wait.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <sstream>

#include "archive/sample.hpp"
#include "orbweaver/core/text.hpp"
#include "orbweaver/report/show.hpp"

namespace show_command_test {
namespace {

using namespace orbweaver;
using ::testing::HasSubstr;

struct Outcome {
  int status = -1;
  std::string out;
};

Outcome run_show(const std::string& arguments) {
  const std::string command = "LC_ALL=C " + std::string(ORBWEAVER_PROGRAM) + " 2>&1 show " + arguments;
  std::FILE* pipe = popen(command.c_str(), "r");
  Outcome outcome;
  for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe)) outcome.out += static_cast<char>(c);
  outcome.status = WEXITSTATUS(pclose(pipe));
  return outcome;
}

class ShowCommand : public ::testing::Test {
 protected:
  void SetUp() override {
    atlas = test::write_sample_atlas(test::fresh_folder("atlas"), test::sample_header(),
                                     test::sample_records(test::sample_header()))
                .string();
  }
  std::string atlas;
};

TEST_F(ShowCommand, PrintsWhatTheArchiveLayerFormats) {
  const archive::Archive read(atlas);
  for (const std::string table : {"families", "orbits", "crossings", "loci", "equilibria", "findings"}) {
    for (const auto& [option, format] :
         {std::pair{"", report::TextFormat::readable}, std::pair{" --csv", report::TextFormat::csv},
          std::pair{" --json", report::TextFormat::json}}) {
      std::ostringstream expected;
      if (format == report::TextFormat::readable) report::print_table_head(expected, read);
      report::print_table(expected, read, table, format);
      const Outcome outcome = run_show(atlas + ' ' + table + option);
      EXPECT_EQ(outcome.status, 0);
      EXPECT_EQ(outcome.out, expected.str());
    }
  }
  std::ostringstream summary;
  report::print_summary(summary, read);
  EXPECT_EQ(run_show(atlas).out, summary.str());
}

TEST_F(ShowCommand, WrongInputExitsWithTwo) {
  EXPECT_EQ(run_show("").status, 2);
  EXPECT_EQ(run_show(atlas + " modes").status, 2);
  EXPECT_EQ(run_show(atlas + " --csv").status, 2);
  EXPECT_EQ(run_show(atlas + " orbits --csv --json").status, 2);
  const Outcome missing = run_show("none.h5 families");
  EXPECT_EQ(missing.status, 2);
  EXPECT_THAT(missing.out, HasSubstr("'none.h5' does not exist"));
}

// As an archive from elsewhere, without checksums, may have them: the writer refuses bytes that are not UTF-8.
TEST_F(ShowCommand, StoredNamesAreEscaped) {
  const auto header = test::sample_header();
  archive::Records records = test::sample_records(header);
  records.families[0].name = "Odd\x1b[31m\xC2\x9B@@";
  const std::filesystem::path odd = test::write_sample_atlas(test::fresh_folder("odd"), header, records);
  test::remove_checksums(odd);
  std::string bytes = (std::ostringstream() << std::ifstream(odd, std::ios::binary).rdbuf()).str();
  for (std::size_t at = bytes.find("@@"); at != std::string::npos; at = bytes.find("@@", at))
    bytes[at] = bytes[at + 1] = '\xFF';
  std::ofstream(odd, std::ios::binary) << bytes;
  for (const std::string arguments : {"", " families", " families --csv", " families --json", " crossings"}) {
    const Outcome outcome = run_show(odd.string() + arguments);
    EXPECT_EQ(outcome.status, 0);
    EXPECT_THAT(outcome.out, HasSubstr(arguments.ends_with("json") ? "Odd\\u001b[31m\\u009b\\ufffd\\ufffd"
                                                                   : "Odd\\x1b[31m\\xc2\\x9b\\xff\\xff"));
    EXPECT_EQ(core::printable_lines(outcome.out), outcome.out) << "nothing is left to be escaped";
  }
}

TEST_F(ShowCommand, AFullOutputIsAnEnvironmentFailure) {
  const Outcome outcome = run_show(atlas + " orbits --json > /dev/full");
  EXPECT_EQ(outcome.status, 3);
  EXPECT_THAT(outcome.out, HasSubstr("standard output"));
}

}  // namespace
}  // namespace show_command_test
