#include <algorithm>
#include <map>
#include <sstream>

#include <fmt/format.h>

#include "fuzz/kinds.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/core/text.hpp"
#include "orbweaver/scene/differences.hpp"
#include "orbweaver/scene/scene.hpp"

namespace orbweaver::fuzz {

namespace {

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
                                          "|\n",
                                          ">\n",
                                          "---\n",
                                          "...\n",
                                          "!!str ",
                                          "'",
                                          "\"",
                                          "\\x1b",
                                          "\\u0085",
                                          "#",
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
                                          "<<: ",
                                          "1e9",
                                          "1e-9",
                                          "-0",
                                          "auto",
                                          "true",
                                          "100000",
                                          "limits",
                                          "starts",
                                          "section",
                                          "\xEF\xBB\xBF",
                                          "%YAML 1.2\n",
                                          std::string(1, '\0'),
                                          "[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[",
                                          "{a: {a: {a: {a: {a: ",
                                          "events: {periods: [1, 2, 3]}\n",
                                          "system: {name: double_pendulum}\n",
                                          "starts: {}\n",
                                          "letters: {A: B}"};

std::vector<std::string> scenes_of_the_source() {
  namespace fs = std::filesystem;
  std::vector<fs::path> files;
  for (const char* folder : {"drivers/scenes", "tests/scene/good", "tests/scene/bad"})
    for (const auto& entry : fs::directory_iterator(fs::path(ORBWEAVER_SOURCE_DIR) / folder))
      if (entry.path().extension() == ".yaml") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  std::vector<std::string> texts;
  for (const fs::path& file : files) texts.push_back(bytes_of(file));
  return texts;
}

/// A scene that was read is a text, and says the same when it is read from that, as a resume does.
void expect_stable(const scene::Scene& read) {
  if (core::first_untextual(read.text) != std::string::npos || core::printable_lines(read.name) != read.name)
    throw WrongReading{"what was accepted is no text"};
  try {
    const scene::Scene again = scene::parse(read.text, "again.yaml");
    for (const scene::Difference& difference : scene::differences(read, again))
      throw WrongReading{fmt::format("{} is another when the scene is read again", difference.key)};
  } catch (const core::InputError& error) {
    throw WrongReading{fmt::format("the text of a scene that was accepted is refused: {}", error.what())};
  }
}

const std::vector<std::string> numbers{"0",      "1",
                                       "2",      "-1",
                                       "3.5",    "1e300",
                                       ".inf",   "-.inf",
                                       ".nan",   "1e-14",
                                       "0x10",   "1e-320",
                                       "1000",   "0.25",
                                       "07",     "1_0",
                                       "999999", "180",
                                       "-0",     "auto",
                                       "~",      "''",
                                       "true",   "[1, 2]",
                                       "{}",     "99999999999999999999"};

std::string edited(Mutator& mutator, std::string text) {
  for (std::size_t n = mutator.below(3); n > 0; --n) text = mutator.edited(std::move(text), numbers, yaml_words);
  return mutator.below(3) == 0 ? mutator.changed(std::move(text), yaml_words) : text;
}

/// Anything at all, in flow style.
std::string grown_value(Mutator& mutator, int levels) {
  static const std::vector<std::string> words{"name", "system", "period",       "x",  "[0, 1]", "double_pendulum",
                                              "30",   "&a [1]", "\"\\x85\"",    "*a", "grid",   "[[0, 180], [0]]",
                                              "auto", "0.5deg", "henon_heiles", "0",  "-1e9",   "\"a\""};
  if (levels == 0 || mutator.below(3) == 0) return mutator.one_of(words);
  const bool map = mutator.below(3) > 0;
  std::string text = map ? "{" : "[";
  for (std::size_t n = mutator.below(5); n > 0; --n)
    text += map ? fmt::format("{}: {}, ", mutator.one_of(words), grown_value(mutator, levels - 1))
                : fmt::format("{}, ", grown_value(mutator, levels - 1));
  return text + (map ? "}" : "]");
}

/// Keys with values that they may have in some system.
const std::vector<std::string> settings{"limits.period=30",
                                        "limits.energy=[-1, 1]",
                                        "limits.steps=10",
                                        "limits.families=3",
                                        "limits.time=10",
                                        "limits.task_time=10",
                                        "limits.guards={r2: 0.01}",
                                        "limits.parameter=[0, 2]",
                                        "starts.fixed_points.grid=[[0, 180], [0]]",
                                        "starts.fixed_points.names={[0, 0]: [A, B]}",
                                        "starts.fixed_points.letters={A: L}",
                                        "starts.sweep={period: [1, 12], step: 0.01}",
                                        "starts.states=[{state: [0.1, 0, 0, 0], period: 6.3, name: Eight}]",
                                        "starts.orbits=[{archive: a.h5, family: A, near: {period: 9}}]",
                                        "starts.loops=[{file: a.csv, period: 6.3, hash: 0a}]",
                                        "starts.recurrences={state: [1, 0, 0, 0], time: 9, period: [1, 2]}",
                                        "events.periods=[1, 2]",
                                        "events.energies=[0.5]",
                                        "continuation.step=0.01rad",
                                        "continuation.start=0.5deg",
                                        "continuation.cutoff=[8, 64]",
                                        "continuation.tolerance=1e-9",
                                        "continuation.corrector=nls",
                                        "continuation.free=m2",
                                        "continuation.hold=period",
                                        "compute.certificate=none",
                                        "compute.stability=true",
                                        "survey.depth=2",
                                        "survey.subharmonics=3",
                                        "survey.spectrum=all",
                                        "survey.team_size=2",
                                        "section={coordinate: w1, value: 0}",
                                        "output={flush_seconds: 1, flush_orbits: 10}",
                                        "system.parameters.m1=2",
                                        "system.effects=[damping]",
                                        "system.scales={time: 1}",
                                        "name=x"};

std::string setting(Mutator& mutator) {
  const std::string given = mutator.one_of(settings);
  switch (mutator.below(10)) {
    case 0: return given.substr(0, given.find('=') + 1) + grown_value(mutator, 3);
    case 1: return mutator.changed(given, yaml_words);
    case 2: return given.substr(0, given.find('=') + 1) + mutator.one_of(mutator.below(2) == 0 ? numbers : yaml_words);
    default: return given;
  }
}

/// The settings as nested maps in flow style.
std::string grown(Mutator& mutator) {
  if (mutator.below(8) == 0) return grown_value(mutator, 5);
  std::map<std::string, std::string> sections{{"starts", "starts: {"}};
  for (std::size_t n = mutator.below(6); n > 0; --n) {
    const std::string given = setting(mutator);
    const std::size_t equals = std::min(given.find('='), given.size());
    const std::size_t dot = std::min(given.find('.'), equals);
    std::string& section = sections[given.substr(0, dot)];
    if (section.empty()) section = given.substr(0, dot) + (dot < equals ? ": {" : ": ");
    std::string inner = given.substr(std::min(dot + 1, given.size()), equals - std::min(dot + 1, equals));
    std::string closing;
    for (std::size_t next = inner.find('.'); next != std::string::npos; next = inner.find('.')) {
      inner.replace(next, 1, ": {");
      closing += '}';
    }
    if (dot < equals) inner += ": ";
    section += inner + given.substr(std::min(equals + 1, given.size())) + closing + (dot < equals ? ", " : "");
  }
  static const std::vector<std::string> systems{"double_pendulum", "henon_heiles", "pcr3bp", "van_der_pol"};
  std::string text = fmt::format("system: {{name: {}}}\n", mutator.one_of(systems));
  for (const auto& [name, section] : sections) text += section + (section.find(": {") < section.size() ? "}\n" : "\n");
  return text;
}

void read_scene(const std::string& text) { expect_stable(scene::parse(text, "fuzz.yaml")); }

}  // namespace

Kind scenes() {
  return {[seeds = scenes_of_the_source()](Mutator& mutator) { return edited(mutator, mutator.one_of(seeds)); },
          read_scene};
}

Kind grown_scenes() { return {grown, read_scene}; }

Kind overrides() {
  return {[](Mutator& mutator) {
            std::string lines;
            for (std::size_t n = 1 + mutator.below(4); n > 0; --n) lines += setting(mutator) + '\n';
            return lines;
          },
          [](const std::string& lines) {
            std::vector<std::string> words;
            std::istringstream stream(lines);
            for (std::string line; std::getline(stream, line);) words.push_back(line);
            expect_stable(scene::parse("system: {name: double_pendulum}\nstarts: {}\nlimits: {period: 30, steps: 10}\n",
                                       "fuzz.yaml", words));
          }};
}

}  // namespace orbweaver::fuzz
