#include <filesystem>
#include <fstream>
#include <sstream>

#include "orbweaver/scene/differences.hpp"
#include "orbweaver/scene/scene.hpp"
#include "support/fuzz.hpp"

namespace {

namespace fs = std::filesystem;
namespace scene = orbweaver::scene;
using orbweaver::test::FuzzBounds;
using orbweaver::test::Mutator;

std::vector<std::string> scenes() {
  std::vector<std::string> texts;
  const fs::path source = ORBWEAVER_SOURCE_DIR;
  for (const fs::path& folder : {source / "drivers/scenes", source / "tests/scene/good", source / "tests/scene/bad"}) {
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(folder))
      if (entry.path().extension() == ".yaml") files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    for (const fs::path& file : files)
      texts.push_back((std::ostringstream() << std::ifstream(file, std::ios::binary).rdbuf()).str());
  }
  return texts;
}

const std::vector<std::string> yaml_words{",",
                                          ":",
                                          "\n",
                                          "- ",
                                          "? ",
                                          "[",
                                          "]",
                                          "{",
                                          "}",
                                          "&a ",
                                          "*a",
                                          "!",
                                          "!!str ",
                                          "|\n",
                                          ">\n",
                                          "---\n",
                                          "...\n",
                                          "%YAML 1.2\n",
                                          "'",
                                          "\"",
                                          "\\x1b",
                                          "\\u0085",
                                          "#",
                                          "<<: ",
                                          "~",
                                          ".inf",
                                          "-.nan",
                                          "1e999",
                                          "0x7f",
                                          "30deg",
                                          "\t",
                                          "\r\n",
                                          "\xC2\x9B",
                                          "\xFF",
                                          "\xEF\xBB\xBF",
                                          "[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[",
                                          "{a: {a: {a: {a: {a: ",
                                          "limits",
                                          "events: {periods: [1, 2, 3]}\n",
                                          "system: {name: double_pendulum}\n",
                                          "starts: {}\n",
                                          "letters: {A: B}"};

TEST(Fuzz, ChangedScenes) {
  const std::vector<std::string> seeds = scenes();
  Mutator mutator(1);
  FuzzBounds bounds;
  for (int n = orbweaver::test::fuzz_count(3000); n > 0; --n) {
    const std::string text = mutator.changed(mutator.one_of(seeds), yaml_words);
    bounds.run(text, [&] {
      const scene::Scene read = scene::parse(text, "fuzz.yaml");
      EXPECT_TRUE(scene::differences(read, read).empty());
      EXPECT_NO_THROW((void)scene::parse(read.text, "again.yaml"));
    });
  }
  bounds.check("scenes");
}

/// Keys, values and structures put together at random: most of it is YAML.
std::string grown(Mutator& mutator, int levels) {
  static const std::vector<std::string> keys{"name",    "system",     "starts",  "continuation", "survey",   "limits",
                                             "events",  "section",    "output",  "fixed_points", "grid",     "names",
                                             "letters", "sweep",      "period",  "periods",      "energies", "step",
                                             "cutoff",  "parameters", "effects", "scales",       "guards",   "m1",
                                             "time",    "depth",      "x",       "[0, 1]",       "\"\\x85\""};
  static const std::vector<std::string> values{"1",
                                               "0",
                                               "-1",
                                               "1e300",
                                               ".inf",
                                               "double_pendulum",
                                               "henon_heiles",
                                               "pcr3bp",
                                               "0.5deg",
                                               "auto",
                                               "~",
                                               "''",
                                               "\"a\"",
                                               "[]",
                                               "{}",
                                               "[1, 2]",
                                               "[[0, 180], [0]]",
                                               "&a [1]",
                                               "*a",
                                               "99999999999999999999",
                                               "adaptive",
                                               "true"};
  if (levels == 0 || mutator.below(3) == 0) return mutator.one_of(values);
  const bool map = mutator.below(3) > 0;
  std::string text = map ? "{" : "[";
  for (std::size_t n = mutator.below(5); n > 0; --n)
    text += map ? fmt::format("{}: {}, ", mutator.one_of(keys), grown(mutator, levels - 1))
                : fmt::format("{}, ", grown(mutator, levels - 1));
  return text + (map ? "}" : "]");
}

TEST(Fuzz, GrownScenes) {
  Mutator mutator(2);
  FuzzBounds bounds;
  for (int n = orbweaver::test::fuzz_count(3000); n > 0; --n) {
    std::string text = grown(mutator, 5);
    if (mutator.below(2) == 0)
      text = fmt::format("system: {{name: double_pendulum}}\nstarts: {}\nlimits: {}\nevents: {}\n", grown(mutator, 3),
                         grown(mutator, 2), grown(mutator, 2));
    bounds.run(text, [&] { (void)scene::parse(text, "fuzz.yaml"); });
  }
  bounds.check("grown scenes");
}

TEST(Fuzz, Overrides) {
  const std::vector<std::string> seeds{"limits.period=30",
                                       "starts.fixed_points.names={[0, 0]: [In-Phase]}",
                                       "events.periods=[1, 2]",
                                       "continuation.step=0.01rad",
                                       "system.parameters.m1=2",
                                       "a.b.c.d.e=1",
                                       "survey.depth=&a [*a]",
                                       "name=\"x\"",
                                       "=",
                                       "limits.guards.r1=0.5"};
  const std::string base = "system: {name: double_pendulum}\nstarts: {}\nlimits: {period: 30, steps: 10}\n";
  Mutator mutator(3);
  FuzzBounds bounds;
  for (int n = orbweaver::test::fuzz_count(3000); n > 0; --n) {
    std::vector<std::string> words;
    for (std::size_t count = 1 + mutator.below(4); count > 0; --count)
      words.push_back(mutator.changed(mutator.one_of(seeds), yaml_words));
    bounds.run(fmt::format("{}", fmt::join(words, " --set ")), [&] {
      const scene::Scene read = scene::parse(base, "fuzz.yaml", words);
      EXPECT_NO_THROW((void)scene::parse(read.text, "again.yaml"));
    });
  }
  bounds.check("overrides");
}

}  // namespace
