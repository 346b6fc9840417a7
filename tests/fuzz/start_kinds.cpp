#include <cmath>

#include <fmt/format.h>

#include "archive/sample.hpp"
#include "fuzz/kinds.hpp"
#include "orbweaver/core/file_hash.hpp"
#include "orbweaver/scene/loop_samples.hpp"
#include "orbweaver/scene/scene.hpp"
#include "orbweaver/starts/loop_guess.hpp"
#include "orbweaver/survey/tree/expected_starts.hpp"
#include "orbweaver/systems/registry.hpp"

namespace orbweaver::fuzz {

namespace {

const std::vector<std::string> csv_words{",",    "\n",   "\r\n", "nan", "inf",         "-",           "1e999", "t",
                                         "\xFF", ";",    "\"",   " ",   "0x1p3",       "\n\n",        "t,th1", "1e-320",
                                         "-0",   "\x1b", ",,",   "1",   "th1,th1,th1", "\xEF\xBB\xBF"};
const std::vector<std::string> numbers{"0", "1", "-1", "1e300", "nan", "inf", "0.5", "1e-300", "6.3", "7"};
const std::vector<std::string> hdf_words{"HDF", "OHDR", "TREE", std::string(8, '\0'), std::string(8, '\xff')};

constexpr double period = 6.3;

std::string table() {
  std::string text = "t, th1, w1, th2, w2\n";
  for (int j = 0; j < 12; ++j) {
    const double t = period * j / 12.0;
    text += fmt::format("{}, {}, {}, {}, {}\n", t, std::sin(t), std::cos(t), t, 1.0);
  }
  return text;
}

}  // namespace

Kind loops() {
  return {[whole = table()](Mutator& mutator) {
            std::string text = whole;
            for (std::size_t n = mutator.below(4); n > 0; --n)
              text = mutator.edited(std::move(text), numbers, csv_words);
            return mutator.below(3) == 0 ? mutator.changed(std::move(text), csv_words) : text;
          },
          [system = systems::make_system("double_pendulum")](const std::string& text) {
            const scene::LoopSamples samples = scene::parse_loop_samples(text, "fuzz.csv", *system, period);
            for (const std::vector<double>& state : samples.states)
              for (const double value : state)
                if (!std::isfinite(value)) throw WrongReading{"a sample that is not finite"};
            for (const double value :
                 starts::loop_through(system->structure(),
                                      starts::curve_through(*system, samples.times, samples.states, period))
                     .modes)
              if (std::isnan(value)) throw WrongReading{"a loop that is not a number"};
          }};
}

Kind start_archives(const std::filesystem::path& folder) {
  archive::Header header = test::sample_header();
  header.system = "harmonic_oscillator";
  header.effects.clear();
  header.state_names = {"q", "p"};
  header.winding_names.clear();
  header.winding_coordinates.clear();
  header.parameter_names = {"omega"};
  header.parameter_values = {2.0};
  archive::Records records = test::sample_records(header);
  for (archive::OrbitRecord& orbit : records.orbits) orbit.winding.clear();
  const std::filesystem::path atlas = test::write_sample_atlas(folder, header, records);
  const std::filesystem::path file = folder / "changed.h5";
  return {[whole = bytes_of(atlas)](Mutator& mutator) {
            if (mutator.below(2) == 0) return mutator.changed(whole, hdf_words);
            std::string bytes = whole;
            bytes[mutator.below(bytes.size())] = static_cast<char>(mutator.below(256));
            return bytes;
          },
          [file, folder, told = std::string()](const std::string& bytes) mutable {
            write_bytes(file, bytes);
            write_bytes(folder / "scene.yaml",
                        "system: {name: harmonic_oscillator}\n"
                        "starts: {orbits: [{archive: changed.h5, family: Out-Phase, near: {step: 1}}]}\n");
            const scene::Scene scene = scene::load(folder / "scene.yaml");
            if (scene.orbits.front().archive.hash != core::file_hash({file}))
              throw WrongReading{"another hash than the file's"};
            const survey::ExpectedStarts read = survey::expected_starts(scene, *scene::bound_system(scene.system));
            if (told.empty()) told = read.orbits.front();  // checksums let no other one through
            if (read.orbits.size() != 1 || read.orbits.front() != told) throw WrongReading{"another orbit was taken"};
          }};
}

}  // namespace orbweaver::fuzz
