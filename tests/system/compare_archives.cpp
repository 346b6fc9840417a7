// compare_archives A B ...: exits with 0 if every attribute and every value of all archives is the same, bit by bit.
#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "archive/sample.hpp"
#include "orbweaver/archive/read/reader.hpp"

namespace {

using namespace orbweaver::archive;

int differences = 0;

void expect(bool same, const std::string& what) {
  if (same) return;
  ++differences;
  fmt::print(stderr, "differs: {}\n", what);
}

bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
  if (a.size() != b.size()) return false;
  for (std::size_t i = 0; i < a.size(); ++i)
    if (std::bit_cast<std::uint64_t>(a[i]) != std::bit_cast<std::uint64_t>(b[i])) return false;
  return true;
}

bool same_values(const Column& a, const Column& b) {
  const auto* reals = std::get_if<std::vector<double>>(&a.values);
  const auto* other = std::get_if<std::vector<double>>(&b.values);
  if (reals != nullptr && other != nullptr) return same_bits(*reals, *other);
  return a.values == b.values;
}

void compare(const Header& a, const Header& b) {
  expect(a.orbweaver_version == b.orbweaver_version, "attribute orbweaver_version");
  expect(a.scene == b.scene, "attribute scene");
  expect(a.model == b.model, "table model");
  expect(a.state_names == b.state_names, "attribute state_names");
  expect(a.winding_names == b.winding_names, "attribute winding_names");
  expect(a.winding_coordinates == b.winding_coordinates, "attribute winding_coordinates");
  expect(a.pairs == b.pairs && a.symplectic == b.symplectic, "width of the stability columns");
}

void compare(const Table& a, const Table& b) {
  expect(a.rows() == b.rows(), fmt::format("rows of /{}: {} and {}", a.name(), a.rows(), b.rows()));
  expect(a.columns().size() == b.columns().size(), fmt::format("columns of /{}", a.name()));
  for (const Column& column : a.columns()) {
    const Column& other = b.column(column.spec.name);
    const std::string place = fmt::format("/{}/{}", a.name(), column.spec.name);
    expect(column.spec.type == other.spec.type && column.spec.row_shape == other.spec.row_shape &&
               column.spec.text_width == other.spec.text_width,
           "shape of " + place);
    expect(same_values(column, other), place);
  }
}

void compare(const Archive& a, const Archive& b) {
  expect(a.orbits().rows() > 0 && a.mode_values() > 0, "an empty archive from one that holds something");
  compare(a.header(), b.header());
  compare(a.families(), b.families());
  compare(a.orbits(), b.orbits());
  compare(a.crossings(), b.crossings());
  compare(a.sections(), b.sections());
  expect(a.mode_values() == b.mode_values(), "length of /modes");
  for (std::size_t row = 0; row < std::min(a.orbits().rows(), b.orbits().rows()); ++row) {
    expect(same_bits(a.modes(row), b.modes(row)), fmt::format("modes of orbit {}", row));
    expect(same_bits(a.time_map(row), b.time_map(row)), fmt::format("time map of orbit {}", row));
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) {
    fmt::print(stderr, "usage: compare_archives A B ...\n");
    return 2;
  }
  for (int n = 2; n < argc; ++n) {
    fmt::print(stderr, "{} against {}\n", argv[n], argv[1]);
    // Beneath the reader: the raw bytes of whatever datasets the files have.
    expect(orbweaver::test::dataset_bytes(argv[1]) == orbweaver::test::dataset_bytes(argv[n]),
           "the bytes of the datasets");
    compare(Archive(argv[1]), Archive(argv[n]));
  }
  return differences == 0 ? 0 : 1;
}
