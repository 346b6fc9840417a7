#include "page/page_columns.hpp"

#include <algorithm>
#include <bit>
#include <iterator>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "json_text.hpp"
#include "orbit_stability.hpp"

namespace orbweaver::report {

namespace {

constexpr std::size_t alignment = 8;

template <class Bits>
void append(std::vector<std::uint8_t>& bytes, Bits bits) {
  for (std::size_t shift = 0; shift < 8 * sizeof bits; shift += 8)
    bytes.push_back(static_cast<std::uint8_t>(bits >> shift));
}

}  // namespace

void PageColumns::begin(const std::string& name, const char* type, std::size_t width) {
  _bytes.resize((_bytes.size() + alignment - 1) / alignment * alignment);
  _places.push_back({name, type, width, _bytes.size()});
}

void PageColumns::add_float64(const std::string& name, const std::vector<double>& values, std::size_t width) {
  begin(name, "float64", width);
  for (const double value : values) append(_bytes, std::bit_cast<std::uint64_t>(value));
}

void PageColumns::add_float32(const std::string& name, const std::vector<double>& values, std::size_t width) {
  begin(name, "float32", width);
  for (const double value : values) append(_bytes, std::bit_cast<std::uint32_t>(static_cast<float>(value)));
}

void PageColumns::add_int32(const std::string& name, const std::vector<std::int64_t>& values) {
  begin(name, "int32", 1);
  for (const std::int64_t value : values) append(_bytes, static_cast<std::uint32_t>(value));
}

std::string PageColumns::json() const {
  std::vector<std::string> texts;
  for (const Place& place : _places)
    texts.push_back(fmt::format(R"({{"name":{},"type":"{}","width":{},"at":{}}})", json_text(place.name), place.type,
                                place.width, place.at));
  return fmt::format("[{}]", fmt::join(texts, ","));
}

void add_orbit_columns(PageColumns& columns, const archive::Archive& atlas) {
  const std::set<std::string> exact{"period",   "energy",    "action",    "parameter",
                                    "arclength", "stability", "fundamental_stability", "state"};
  const std::set<std::string> whole{"step", "cutoff", "verdict"};
  for (const archive::Column& column : atlas.orbits().columns()) {
    const std::string& name = column.spec.name;
    const auto* reals = std::get_if<std::vector<double>>(&column.values);
    if (reals != nullptr && exact.contains(name))
      columns.add_float64(name, *reals, column.spec.width());
    else if (reals != nullptr)
      columns.add_float32(name, *reals, column.spec.width());
    else if (whole.contains(name))
      columns.add_int32(name, std::get<std::vector<std::int64_t>>(column.values));
  }
  const OrbitStability stability(atlas);
  std::vector<std::int64_t> stable;
  for (std::size_t orbit = 0; orbit < atlas.orbits().rows(); ++orbit) {
    const std::optional<bool> is_stable = stability.of(orbit);
    stable.push_back(is_stable ? static_cast<std::int64_t>(*is_stable) : -1);
  }
  columns.add_int32("stable", stable);
}

}  // namespace orbweaver::report
