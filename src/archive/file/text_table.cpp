#include "orbweaver/archive/file/text_table.hpp"

#include <algorithm>
#include <cstdint>
#include <filesystem>

#include <fmt/format.h>
#include <zlib.h>

#include "h5_types.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/core/input_file.hpp"
#include "orbweaver/core/output_file.hpp"
#include "orbweaver/core/text.hpp"
#include "own_dataset.hpp"

namespace orbweaver::archive {

namespace {

constexpr const char* checksum_column = "checksum";
constexpr std::size_t longest_attribute = 1000;  // of those that this program reads

/// Of the row's number and its texts, each with its length before it.
std::string checksum_of(const TextTable& table, std::size_t row) {
  std::string bytes = fmt::format("{}:", row);
  for (const std::vector<std::string>& column : table.values)
    bytes += fmt::format("{}:{}", column[row].size(), column[row]);
  const auto sum = crc32(0, reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uInt>(bytes.size()));
  return fmt::format("{:08x}", sum);
}

H5Handle timeless(hid_t list_class) {
  H5Handle list(check_h5(H5Pcreate(list_class), "H5Pcreate"), H5Pclose);
  check_h5(H5Pset_obj_track_times(list.get(), false), "H5Pset_obj_track_times");
  return list;
}

H5Handle opened(const std::filesystem::path& path) {
  const H5Handle access(check_h5(H5Pcreate(H5P_FILE_ACCESS), "H5Pcreate"), H5Pclose);
  check_h5(H5Pset_file_locking(access.get(), false, true), "H5Pset_file_locking");
  return {check_h5<core::InputError>(H5Fopen(path.c_str(), H5F_ACC_RDONLY, access.get()),
                                     fmt::format("'{}' cannot be opened", path.string())),
          H5Fclose};
}

void write_attribute(const H5Handle& file, const char* name, const H5Handle& type, const void* data) {
  const H5Handle space(check_h5(H5Screate(H5S_SCALAR), "H5Screate"), H5Sclose);
  const H5Handle attribute(
      check_h5(H5Acreate2(file.get(), name, type.get(), space.get(), H5P_DEFAULT, H5P_DEFAULT), name), H5Aclose);
  check_h5(H5Awrite(attribute.get(), type.get(), data), name);
}

void write_column(const H5Handle& file, const std::string& name, const std::vector<std::string>& texts) {
  const std::size_t width = longest_text(texts);
  const hsize_t rows = texts.size();
  const H5Handle space(check_h5(H5Screate_simple(1, &rows, nullptr), name), H5Sclose);
  const H5Handle type = h5_text_type(width);
  const H5Handle creation = timeless(H5P_DATASET_CREATE);
  const H5Handle dataset(
      check_h5(H5Dcreate2(file.get(), name.c_str(), type.get(), space.get(), H5P_DEFAULT, creation.get(), H5P_DEFAULT),
               name),
      H5Dclose);
  const std::string block = padded_texts(texts, width);
  if (rows > 0) check_h5(H5Dwrite(dataset.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, block.data()), name);
}

/// Of an attribute: one value, as its reader takes.
bool is_single(const H5Handle& attribute) {
  const H5Handle space(check_h5<core::InputError>(H5Aget_space(attribute.get()), "H5Aget_space"), H5Sclose);
  return H5Sget_simple_extent_npoints(space.get()) == 1;
}

std::optional<std::string> text_attribute(const H5Handle& file, const char* name) {
  if (H5Aexists(file.get(), name) <= 0) return std::nullopt;
  const H5Handle attribute(check_h5<core::InputError>(H5Aopen(file.get(), name, H5P_DEFAULT), name), H5Aclose);
  const H5Handle type(check_h5<core::InputError>(H5Aget_type(attribute.get()), name), H5Tclose);
  if (H5Tget_class(type.get()) != H5T_STRING || H5Tis_variable_str(type.get()) != 0 || !is_single(attribute) ||
      H5Tget_size(type.get()) > longest_attribute)
    return std::nullopt;
  std::string text(H5Tget_size(type.get()), '\0');
  check_h5<core::InputError>(H5Aread(attribute.get(), type.get(), text.data()), name);
  return text.substr(0, text.find_last_not_of('\0') + 1);
}

std::vector<std::string> read_column(const std::filesystem::path& path, const H5Handle& file, const std::string& name) {
  const std::string problem =
      fmt::format("'{}' lacks the column /{}, or it is damaged or compressed", path.string(), name);
  const H5Handle dataset(check_h5<core::InputError>(open_own_dataset(file.get(), name), problem), H5Dclose);
  const H5Handle type(check_h5<core::InputError>(H5Dget_type(dataset.get()), problem), H5Tclose);
  const H5Handle space(check_h5<core::InputError>(H5Dget_space(dataset.get()), problem), H5Sclose);
  if (H5Tget_class(type.get()) != H5T_STRING || H5Tis_variable_str(type.get()) != 0 ||
      H5Sget_simple_extent_ndims(space.get()) != 1)
    throw core::InputError(problem);
  const std::size_t width = H5Tget_size(type.get());
  const auto rows = static_cast<std::size_t>(std::max<hssize_t>(0, H5Sget_simple_extent_npoints(space.get())));
  if (rows > std::filesystem::file_size(path) / width)
    throw core::InputError(fmt::format("'{}' claims {} rows of {} bytes in /{}, more than the file's {}", path.string(),
                                       rows, width, name, std::filesystem::file_size(path)));
  std::string block(rows * width, '\0');
  if (rows > 0)
    check_h5<core::InputError>(H5Dread(dataset.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, block.data()),
                               problem);
  std::vector<std::string> texts;
  for (std::size_t row = 0; row < rows; ++row) {
    const std::string text = block.substr(row * width, width);
    texts.push_back(text.substr(0, text.find_last_not_of('\0') + 1));
  }
  return texts;
}

}  // namespace

void write_text_table(const std::filesystem::path& path, const TextTable& table) {
  core::require(table.columns.size() == table.values.size() && !table.values.empty(), "one list a column");
  for (const std::vector<std::string>& column : table.values)
    core::require(column.size() == table.values.front().size(), "columns are of one length");
  quiet_h5();
  core::PartFile whole(path);
  const std::filesystem::path& part = whole.path();
  {
    const H5Handle creation = timeless(H5P_FILE_CREATE);
    H5Handle file(check_h5(H5Fcreate(part.c_str(), H5F_ACC_TRUNC, creation.get(), H5P_DEFAULT),
                           fmt::format("cannot create '{}'", part.string())),
                  close_written_file);
    write_attribute(file, "format", h5_text_type(table.format.size()), table.format.c_str());
    const std::int64_t version = table.version;
    write_attribute(file, "format_version", h5_memory_type({"", ColumnType::integer, {}}), &version);
    const H5Handle group_creation = timeless(H5P_GROUP_CREATE);
    const H5Handle group(
        check_h5(H5Gcreate2(file.get(), table.name.c_str(), H5P_DEFAULT, group_creation.get(), H5P_DEFAULT),
                 table.name),
        H5Gclose);
    for (std::size_t n = 0; n < table.columns.size(); ++n)
      write_column(file, table.name + '/' + table.columns[n], table.values[n]);
    std::vector<std::string> checksums;
    for (std::size_t row = 0; row < table.values.front().size(); ++row) checksums.push_back(checksum_of(table, row));
    write_column(file, table.name + '/' + checksum_column, checksums);
    file.close(fmt::format("cannot close '{}'", part.string()));
  }
  whole.publish();
}

TextTable read_text_table(const std::filesystem::path& path, const TextTable& expected) {
  quiet_h5();
  if (const std::string problem = core::input_problem(path); !problem.empty())
    throw core::InputError(fmt::format("'{}' {}", path.string(), problem));
  const H5Handle file = opened(path);
  const std::optional<std::string> format = text_attribute(file, "format");
  if (format != expected.format)
    throw core::InputError(fmt::format("'{}' has the format '{}'; '{}' was expected", path.string(),
                                       core::printable(format.value_or("unknown")), expected.format));
  std::int64_t version = 0;
  const H5Handle attribute(
      check_h5<core::InputError>(H5Aopen(file.get(), "format_version", H5P_DEFAULT), "format_version"), H5Aclose);
  if (!is_single(attribute))
    throw core::InputError(fmt::format("'{}' has a format_version that is not one number", path.string()));
  check_h5<core::InputError>(H5Aread(attribute.get(), H5T_NATIVE_INT64, &version), "format_version");
  if (version > expected.version)
    throw core::NewerVersionError(fmt::format("'{}' has format_version {}; this Orbweaver reads versions up to {}",
                                              path.string(), version, expected.version));
  TextTable table = expected;
  table.version = static_cast<int>(version);
  table.values.clear();
  for (const std::string& column : table.columns)
    table.values.push_back(read_column(path, file, table.name + '/' + column));
  const std::vector<std::string> checksums = read_column(path, file, table.name + '/' + checksum_column);
  for (const std::vector<std::string>& column : table.values)
    if (column.size() != checksums.size())
      throw core::InputError(fmt::format("'{}' has columns of different lengths in /{}", path.string(), table.name));
  for (std::size_t row = 0; row < checksums.size(); ++row)
    if (checksums[row] != checksum_of(table, row))
      throw core::InputError(
          fmt::format("'{}' has a changed row {} of /{}: it does not give the checksum stored with it", path.string(),
                      row, table.name));
  return table;
}

std::optional<std::string> format_of(const std::filesystem::path& path) {
  quiet_h5();
  if (!core::unreadable_input(path).empty() || H5Fis_hdf5(path.c_str()) <= 0) return std::nullopt;
  try {
    return text_attribute(opened(path), "format");
  } catch (const core::InputError&) {
    return std::nullopt;  // damaged, as who reads it will say
  }
}

}  // namespace orbweaver::archive
