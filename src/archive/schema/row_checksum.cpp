#include "row_checksum.hpp"

#include <bit>
#include <string_view>

#include <fmt/format.h>
#include <zlib.h>

namespace orbweaver::archive {

namespace {

constexpr const char* name_of_sum = "checksum";

std::int64_t crc_of(const void* bytes, std::size_t count) {
  return static_cast<std::int64_t>(crc32_z(crc32_z(0, nullptr, 0), static_cast<const Bytef*>(bytes), count));
}

/// Bytes in the order in which they are summed.
class Bytes {
 public:
  void add(std::uint64_t number) {
    for (int shift = 0; shift < 64; shift += 8) _bytes.push_back(static_cast<char>(number >> shift));
  }
  void add(std::int64_t number) { add(static_cast<std::uint64_t>(number)); }
  void add(double number) { add(std::bit_cast<std::uint64_t>(number)); }
  void add(std::string_view text) {
    add(static_cast<std::uint64_t>(text.size()));
    _bytes.append(text);
  }
  void add(const std::string& text) { add(std::string_view(text)); }
  template <class Value>
  void add(const std::vector<Value>& values) {
    add(static_cast<std::uint64_t>(values.size()));
    for (const Value& value : values) add(value);
  }

  void clear() { _bytes.clear(); }
  [[nodiscard]] std::int64_t checksum() const { return crc_of(_bytes.data(), _bytes.size()); }

 private:
  std::string _bytes;
};

void add_row(const Table& table, std::size_t row, std::int64_t minor, Bytes& bytes) {
  for (const Column& column : table.columns()) {
    if (column.spec.name == name_of_sum || column.spec.since > minor) continue;
    const std::size_t width = column.spec.width();
    std::visit(
        [&](const auto& values) {
          for (std::size_t i = row * width; i < (row + 1) * width; ++i) bytes.add(values[i]);
        },
        column.values);
  }
}

std::vector<std::int64_t> checksums_of(const Table& table, std::uint64_t first, std::int64_t minor) {
  std::vector<std::int64_t> sums(table.rows());
  Bytes bytes;
  for (std::size_t row = 0; row < sums.size(); ++row) {
    bytes.clear();
    bytes.add(first + row);
    add_row(table, row, minor, bytes);
    sums[row] = bytes.checksum();
  }
  return sums;
}

}  // namespace

std::int64_t values_checksum(std::span<const double> values) {
  if constexpr (std::endian::native == std::endian::little) return crc_of(values.data(), values.size_bytes());
  Bytes bytes;
  for (const double value : values) bytes.add(value);
  return bytes.checksum();
}

std::int64_t header_checksum(const std::string& format, std::int64_t minor, const Header& header) {
  Bytes bytes;
  bytes.add(format);
  bytes.add(static_cast<std::int64_t>(format_version));
  bytes.add(minor);
  bytes.add(header.orbweaver_version);
  bytes.add(header.scene);
  bytes.add(header.state_names);
  bytes.add(header.winding_names);
  bytes.add(header.system);
  bytes.add(header.effects);
  bytes.add(header.parameter_names);
  bytes.add(header.parameter_values);
  bytes.add(header.scale_names);
  bytes.add(header.scales);
  if (minor >= winding_coordinates_since)
    bytes.add(std::vector<std::int64_t>(header.winding_coordinates.begin(), header.winding_coordinates.end()));
  return bytes.checksum();
}

void set_checksums(Table& table, std::uint64_t first) {
  table.integers(name_of_sum) = checksums_of(table, first, format_minor);
}

std::vector<std::size_t> changed_rows(const Table& table, std::int64_t minor) {
  const std::vector<std::int64_t> found = checksums_of(table, 0, minor);
  const std::vector<std::int64_t>& stored = table.integers(name_of_sum);
  std::vector<std::size_t> changed;
  for (std::size_t row = 0; row < found.size(); ++row)
    if (found[row] != stored[row]) changed.push_back(row);
  return changed;
}

std::string changed_row(const std::string& table, std::size_t row) {
  return fmt::format("has a changed row {} of /{}: its values do not give the checksum stored with them", row, table);
}

std::string changed_values(const std::string& name, std::size_t row) {
  return fmt::format("has a changed {} of row {} of /orbits: the values do not give the checksum stored with the row",
                     name == "modes" ? "loop (/modes)" : "time map (/time_maps)", row);
}

}  // namespace orbweaver::archive
