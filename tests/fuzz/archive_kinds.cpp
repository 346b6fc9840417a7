#include <memory>

#include <fmt/format.h>

#include "archive/sample.hpp"
#include "fuzz/kinds.hpp"
#include "orbweaver/archive/read/check_segments.hpp"
#include "orbweaver/archive/read/reader.hpp"

namespace orbweaver::fuzz {

namespace {

const std::vector<std::string> words{
    "HDF", "OHDR", "TREE", "SNOD", "HEAP", "FRHP", std::string(8, '\0'), std::string(8, '\xff')};

/// Every value of an archive as bytes.
std::string values_of(const archive::Archive& read) {
  std::string all;
  const auto numbers = [&](const auto& values) {
    all.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof values.front());
  };
  for (const archive::Table* table :
       {&read.families(), &read.orbits(), &read.crossings(), &read.sections(), &read.findings()})
    for (const archive::Column& column : table->columns()) {
      if (const auto* texts = std::get_if<std::vector<std::string>>(&column.values))
        for (const std::string& text : *texts) all += text + '\n';
      else if (const auto* reals = std::get_if<std::vector<double>>(&column.values))
        numbers(*reals);
      else
        numbers(std::get<std::vector<std::int64_t>>(column.values));
    }
  for (std::size_t orbit = 0; orbit < read.orbits().rows(); ++orbit) {
    numbers(read.modes(orbit));
    numbers(read.time_map(orbit));
  }
  return all + read.header().scene;
}

/// Half of the files keep their length and all bytes but one: others rarely come past the library's own structures.
std::string changed(const std::string& whole, Mutator& mutator) {
  if (mutator.below(2) == 0) return mutator.changed(whole, words);
  std::string bytes = whole;
  bytes[mutator.below(bytes.size())] = static_cast<char>(mutator.below(256));
  return bytes;
}

}  // namespace

Kind archives(const std::filesystem::path& folder) {
  const auto header = test::sample_header();
  const std::filesystem::path atlas = test::write_sample_atlas(folder, header, test::sample_records(header));
  const std::string whole = bytes_of(atlas);
  const std::string values = values_of(archive::Archive(atlas));
  return {[whole](Mutator& mutator) { return changed(whole, mutator); },
          [=, file = folder / "changed.h5"](const std::string& bytes) {
            write_bytes(file, bytes);
            if (values_of(archive::Archive(file)) != values) throw WrongReading{"a value came through the checksums"};
          }};
}

Kind segments(const std::filesystem::path& folder) {
  const auto header = test::sample_header();
  (void)test::write_sample_atlas(folder, header, test::sample_records(header));
  const std::string whole = bytes_of(folder / "segment.h5");
  return {[whole](Mutator& mutator) { return changed(whole, mutator); },
          [file = folder / "changed.h5"](const std::string& bytes) {
            write_bytes(file, bytes);
            (void)archive::inspect_segment(file);
          }};
}

}  // namespace orbweaver::fuzz
