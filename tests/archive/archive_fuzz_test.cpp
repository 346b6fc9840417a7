#include <fstream>
#include <sstream>

#include "archive/sample.hpp"
#include "orbweaver/archive/read/reader.hpp"
#include "orbweaver/archive/write/segment.hpp"
#include "support/fuzz.hpp"

namespace {

using namespace orbweaver;

const std::vector<std::string> words{
    "HDF", "OHDR", "TREE", "SNOD", "HEAP", "FRHP", std::string(8, '\0'), std::string(8, '\xff')};

std::string bytes_of(const std::filesystem::path& path) {
  return (std::ostringstream() << std::ifstream(path, std::ios::binary).rdbuf()).str();
}

/// What comes through the checksums is what was written.
TEST(Fuzz, Archives) {
  const auto header = test::sample_header();
  const auto folder = test::fresh_folder("fuzz");
  const std::filesystem::path atlas = test::write_sample_atlas(folder, header, test::sample_records(header));
  const std::string whole = bytes_of(atlas);
  const std::filesystem::path changed = folder / "changed.h5";
  test::Mutator mutator(6);
  test::FuzzBounds bounds;
  for (int n = test::fuzz_count(1000); n > 0; --n) {
    const std::string bytes = mutator.changed(whole, words);
    std::ofstream(changed, std::ios::binary) << bytes;
    bounds.run(fmt::format("input {}", n), [&] {
      const archive::Archive read(changed);
      for (std::size_t orbit = 0; orbit < read.orbits().rows(); ++orbit) {
        (void)read.modes(orbit);
        (void)read.time_map(orbit);
      }
    });
  }
  bounds.check("archives");
}

TEST(Fuzz, Segments) {
  const auto header = test::sample_header();
  const auto folder = test::fresh_folder("fuzz_segment");
  (void)test::write_sample_atlas(folder, header, test::sample_records(header));
  const std::string whole = bytes_of(folder / "segment.h5");
  const std::filesystem::path changed = folder / "changed.h5";
  test::Mutator mutator(7);
  test::FuzzBounds bounds;
  for (int n = test::fuzz_count(1000); n > 0; --n) {
    std::ofstream(changed, std::ios::binary) << mutator.changed(whole, words);
    bounds.run(fmt::format("input {}", n), [&] { (void)archive::inspect_segment(changed); });
  }
  bounds.check("segments");
}

}  // namespace
