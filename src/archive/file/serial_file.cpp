#include "serial_file.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "h5_types.hpp"
#include "orbweaver/core/file_hash.hpp"
#include "orbweaver/core/input_file.hpp"
#include "own_dataset.hpp"
#include "schema/check_records.hpp"
#include "schema/row_checksum.hpp"

namespace orbweaver::archive {

namespace {

const char* name_of(ColumnType type) {
  switch (type) {
    case ColumnType::integer: return "integers";
    case ColumnType::text: return "fixed-length strings";
    case ColumnType::real: break;
  }
  return "real numbers";
}

H5T_class_t class_of(ColumnType type) {
  switch (type) {
    case ColumnType::integer: return H5T_INTEGER;
    case ColumnType::text: return H5T_STRING;
    case ColumnType::real: break;
  }
  return H5T_FLOAT;
}

std::vector<std::string> split(const std::string& block, std::size_t count, std::size_t width) {
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < count; ++i) {
    const std::string text = block.substr(i * width, width);
    texts.push_back(text.substr(0, text.find_last_not_of('\0') + 1));
  }
  return texts;
}

std::string shape_text(const std::vector<hsize_t>& extents) { return fmt::format("({})", fmt::join(extents, " x ")); }

}  // namespace

const FileKind& atlas_kind() {
  static const FileKind kind{atlas_format, "an Orbweaver atlas",
                             "Give the atlas.h5 of a finished survey, or its folder; if it was damaged, copy it again "
                             "or repeat `orbweaver survey`"};
  return kind;
}

const FileKind& segment_kind() {
  static const FileKind kind{segment_format, "an Orbweaver segment",
                             "A segment that is torn, foreign or lost has to come from a copy"};
  return kind;
}

SerialFile::SerialFile(std::filesystem::path path, const FileKind& kind) : _path(std::move(path)), _kind(&kind) {
  quiet_h5();
  open();
  read_header();
}

void SerialFile::expect(bool condition, const std::string& problem) const {
  if (!condition) throw core::InputError(fmt::format("'{}' {}. {}.", _path.string(), problem, _kind->remedy));
}

void SerialFile::open() {
  if (const std::string problem = core::input_problem(_path); !problem.empty())
    expect(false, fmt::format("{}; {} was expected", problem, _kind->noun));
  expect(H5Fis_hdf5(_path.c_str()) > 0,
         fmt::format("is not an HDF5 file, or was cut short; {} was expected", _kind->noun));
  const H5Handle access(check_h5(H5Pcreate(H5P_FILE_ACCESS), "H5Pcreate"), H5Pclose);
  check_h5(H5Pset_file_locking(access.get(), false, true), "H5Pset_file_locking");
  const hid_t file = H5Fopen(_path.c_str(), H5F_ACC_RDONLY, access.get());
  if (file < 0) expect(false, fmt::format("is damaged or was cut short (HDF5 says: {})", h5_error_text()));
  _file = {file, H5Fclose};
  _bytes = std::filesystem::file_size(_path);
}

void SerialFile::read_header() {
  expect(H5Aexists(_file.get(), "format") > 0,
         fmt::format("is an HDF5 file of something else (it has no attribute 'format'); {} was expected", _kind->noun));
  const std::string format = single_text_attribute("format");
  expect(format == _kind->format,
         fmt::format("has the format '{}'; {} (format '{}') was expected", format, _kind->noun, _kind->format));
  const std::int64_t version = integer_attribute("format_version");
  if (version > format_version)
    throw core::InputError(
        fmt::format("'{}' has format_version {}; this Orbweaver reads versions up to {}. Use the Orbweaver that wrote "
                    "the file, or a newer one.",
                    _path.string(), version, format_version));
  expect(version == format_version, fmt::format("has format_version {}; {} was expected", version, format_version));
  _header.orbweaver_version = single_text_attribute("orbweaver_version");
  _header.scene = single_text_attribute("scene");
  _header.state_names = text_attribute("state_names");
  _header.winding_names = text_attribute("winding_names");
  expect(!_header.state_names.empty(), "names no state coordinate (attribute 'state_names' is empty)");
  if (H5Aexists(_file.get(), "format_minor") > 0) _minor = integer_attribute("format_minor");
  if (_minor >= 1) {
    _header.system = single_text_attribute("system");
    _header.effects = text_attribute("effects");
    _header.parameter_names = text_attribute("parameter_names");
    _header.parameter_values = real_attribute("parameter_values");
    _header.scale_names = text_attribute("scale_names");
    _header.scales = real_attribute("scales");
    expect(_header.parameter_names.size() == _header.parameter_values.size(),
           "has another number of parameter_values than parameter_names");
    expect(_header.scale_names.size() == _header.scales.size(), "has another number of scales than scale_names");
  }
  if (_minor >= winding_coordinates_since) {
    _header.winding_coordinates = whole_attribute("winding_coordinates");
    const std::string problem = winding_problem(_header);
    expect(problem.empty(), problem);
  }
  const std::vector<hsize_t> shape = extents(dataset("orbits/stability"));
  const bool is_real = shape.size() == 2 && shape[1] <= 1;
  const bool is_complex = shape.size() == 3 && shape[2] == 2;
  expect(is_real || is_complex,
         fmt::format("has /orbits/stability of shape {}; (rows x pairs) with at most one pair, or (rows x pairs x 2), "
                     "was expected",
                     shape_text(shape)));
  _header.pairs = static_cast<int>(shape[1]);
  _header.symplectic = is_real;
}

H5Handle SerialFile::attribute(const char* name, H5T_class_t type) const {
  expect(H5Aexists(_file.get(), name) > 0, fmt::format("lacks the attribute '{}'", name));
  const hid_t id = H5Aopen(_file.get(), name, H5P_DEFAULT);
  H5Handle found(check_h5<core::InputError>(id, fmt::format("'{}': attribute '{}'", _path.string(), name)), H5Aclose);
  const H5Handle actual(check_h5<core::InputError>(H5Aget_type(found.get()), "H5Aget_type"), H5Tclose);
  const bool is_fixed = H5Tget_class(actual.get()) != H5T_STRING || H5Tis_variable_str(actual.get()) == 0;
  expect(H5Tget_class(actual.get()) == type && is_fixed, fmt::format("has an attribute '{}' that is not {}", name,
                                                                     type == H5T_STRING  ? "a fixed-length string"
                                                                     : type == H5T_FLOAT ? "real"
                                                                                         : "an integer"));
  return found;
}

std::int64_t SerialFile::integer_attribute(const char* name) const {
  const H5Handle found = attribute(name, H5T_INTEGER);
  const H5Handle space(check_h5<core::InputError>(H5Aget_space(found.get()), "H5Aget_space"), H5Sclose);
  expect(H5Sget_simple_extent_npoints(space.get()) == 1,
         fmt::format("has more than one value in attribute '{}'", name));
  std::int64_t value = 0;
  check_h5<core::InputError>(H5Aread(found.get(), H5T_NATIVE_INT64, &value),
                             fmt::format("'{}': attribute '{}'", _path.string(), name));
  return value;
}

std::vector<std::string> SerialFile::text_attribute(const char* name) const {
  const H5Handle found = attribute(name, H5T_STRING);
  const H5Handle type(check_h5<core::InputError>(H5Aget_type(found.get()), "H5Aget_type"), H5Tclose);
  const H5Handle space(check_h5<core::InputError>(H5Aget_space(found.get()), "H5Aget_space"), H5Sclose);
  const std::size_t width = H5Tget_size(type.get());
  const auto count = static_cast<std::size_t>(std::max<hssize_t>(0, H5Sget_simple_extent_npoints(space.get())));
  expect_room(fmt::format("attribute '{}'", name), {count}, width);
  std::string block(count * width + 1, '\0');
  check_h5<core::InputError>(H5Aread(found.get(), type.get(), block.data()),
                             fmt::format("'{}': attribute '{}'", _path.string(), name));
  return split(block, count, width);
}

std::vector<double> SerialFile::real_attribute(const char* name) const {
  const H5Handle found = attribute(name, H5T_FLOAT);
  const H5Handle space(check_h5<core::InputError>(H5Aget_space(found.get()), "H5Aget_space"), H5Sclose);
  const auto count = static_cast<std::size_t>(std::max<hssize_t>(0, H5Sget_simple_extent_npoints(space.get())));
  expect_room(fmt::format("attribute '{}'", name), {count}, 1);
  std::vector<double> values(count);
  if (!values.empty())
    check_h5<core::InputError>(H5Aread(found.get(), H5T_NATIVE_DOUBLE, values.data()),
                               fmt::format("'{}': attribute '{}'", _path.string(), name));
  return values;
}

std::vector<int> SerialFile::whole_attribute(const char* name) const {
  const H5Handle found = attribute(name, H5T_INTEGER);
  const H5Handle space(check_h5<core::InputError>(H5Aget_space(found.get()), "H5Aget_space"), H5Sclose);
  const auto count = static_cast<std::size_t>(std::max<hssize_t>(0, H5Sget_simple_extent_npoints(space.get())));
  expect_room(fmt::format("attribute '{}'", name), {count}, 1);
  std::vector<int> values(count);
  if (!values.empty())
    check_h5<core::InputError>(H5Aread(found.get(), H5T_NATIVE_INT, values.data()),
                               fmt::format("'{}': attribute '{}'", _path.string(), name));
  return values;
}

std::string SerialFile::single_text_attribute(const char* name) const {
  const std::vector<std::string> texts = text_attribute(name);
  expect(texts.size() == 1, fmt::format("has {} values in attribute '{}'; one was expected", texts.size(), name));
  return texts.front();
}

const H5Handle& SerialFile::dataset(const std::string& name) {
  const auto known = _datasets.find(name);
  if (known != _datasets.end()) return known->second;
  const hid_t id = open_own_dataset(_file.get(), name);
  if (id < 0)
    expect(false, fmt::format("lacks the dataset /{}, or it is damaged, compressed or lies in another file", name));
  return _datasets[name] = {id, H5Dclose};
}

std::vector<hsize_t> SerialFile::extents(const H5Handle& dataset) const {
  const H5Handle space(check_h5<core::InputError>(H5Dget_space(dataset.get()), "H5Dget_space"), H5Sclose);
  const int rank = check_h5<core::InputError>(H5Sget_simple_extent_ndims(space.get()), "H5Sget_simple_extent_ndims");
  std::vector<hsize_t> extents(static_cast<std::size_t>(rank));
  check_h5<core::InputError>(H5Sget_simple_extent_dims(space.get(), extents.data(), nullptr),
                             "H5Sget_simple_extent_dims");
  return extents;
}

void SerialFile::expect_type(const std::string& name, ColumnSpec& spec) {
  const H5Handle type(check_h5<core::InputError>(H5Dget_type(dataset(name).get()), "H5Dget_type"), H5Tclose);
  const bool is_variable = spec.type == ColumnType::text && H5Tis_variable_str(type.get()) > 0;
  expect(H5Tget_class(type.get()) == class_of(spec.type) && !is_variable,
         fmt::format("has a dataset /{} of another type; {} were expected", name, name_of(spec.type)));
  if (spec.type == ColumnType::text) spec.text_width = H5Tget_size(type.get());
  expect_room(fmt::format("dataset /{}", name), extents(dataset(name)), H5Tget_size(type.get()));
}

void SerialFile::expect_room(const std::string& name, const std::vector<hsize_t>& extents, std::size_t bytes) const {
  std::uint64_t values = _bytes / std::max<std::size_t>(bytes, 1);
  for (const hsize_t extent : extents) values /= std::max<hsize_t>(extent, 1);
  expect(values > 0 || std::find(extents.begin(), extents.end(), hsize_t{0}) != extents.end(),
         fmt::format("has a {} of shape {} with values of {} bytes, more than the file's {}", name, shape_text(extents),
                     bytes, _bytes));
}

std::string SerialFile::change_in_header() const {
  if (!has_checksums()) return "";
  const bool holds = integer_attribute("checksum") == header_checksum(_kind->format, _minor, _header);
  return holds ? "" : "has root attributes that were changed: they do not give the checksum stored with them";
}

bool SerialFile::has_table(const std::string& name) const { return is_in_file(_file.get(), name); }

std::string SerialFile::read_model() {
  if (!has_table("model")) return "";
  TableSpec spec = model_spec();
  const std::uint64_t rows = expect_table(spec);
  if (rows == 0) return "";
  expect(rows == 1 && spec.columns.front().text_width <= longest_model,
         fmt::format("has {} models with at most {} bytes; one of at most {} was expected", rows,
                     spec.columns.front().text_width, longest_model));
  const Table table = read_table(spec, rows);
  _header.model = table.texts("text").front();
  if (has_checksums() && !changed_rows(table, _minor).empty()) return changed_row("model", 0);
  return text_attribute("model_hash") == std::vector{core::text_hash(_header.model)}
             ? ""
             : "has a model whose text does not give the hash in the attribute 'model_hash'";
}

std::uint64_t SerialFile::expect_table(TableSpec& spec) {
  std::vector<hsize_t> first_shape;
  for (ColumnSpec& column : spec.columns) {
    if (column.since > _minor) continue;
    const std::string name = spec.name + '/' + column.name;
    expect_type(name, column);
    const std::vector<hsize_t> actual = extents(dataset(name));
    if (first_shape.empty()) first_shape = actual;
    std::vector<hsize_t> expected{first_shape.empty() ? 0 : first_shape[0]};
    expected.insert(expected.end(), column.row_shape.begin(), column.row_shape.end());
    expect(actual == expected, fmt::format("has a dataset /{} of shape {}; {} was expected", name, shape_text(actual),
                                           shape_text(expected)));
  }
  return first_shape.at(0);
}

std::uint64_t SerialFile::expect_flat(const std::string& name) {
  ColumnSpec spec{name, ColumnType::real, {}};
  expect_type(name, spec);
  const std::vector<hsize_t> actual = extents(dataset(name));
  expect(actual.size() == 1,
         fmt::format("has a dataset /{} of shape {}; one extent was expected", name, shape_text(actual)));
  return actual[0];
}

Column SerialFile::read(const std::string& table, const ColumnSpec& spec, std::uint64_t first,
                        std::uint64_t count) const {
  Column column(spec, count);
  if (spec.since > _minor) return column;
  const std::string name = table + '/' + spec.name;
  std::vector<hsize_t> counts{count};
  counts.insert(counts.end(), spec.row_shape.begin(), spec.row_shape.end());
  const H5Handle type = h5_memory_type(spec);
  if (auto* integers = std::get_if<std::vector<std::int64_t>>(&column.values)) {
    read_rows(name, type.get(), first, counts, integers->data());
  } else if (auto* reals = std::get_if<std::vector<double>>(&column.values)) {
    read_rows(name, type.get(), first, counts, reals->data());
  } else {
    std::string block(count * spec.text_width, '\0');
    read_rows(name, type.get(), first, counts, block.data());
    column.values = split(block, count, spec.text_width);
  }
  return column;
}

Table SerialFile::read_table(const TableSpec& spec, std::uint64_t rows) const {
  Table table(spec, rows);
  for (Column& column : table.columns()) column = read(spec.name, column.spec, 0, rows);
  return table;
}

std::vector<double> SerialFile::read_flat(const std::string& name, std::uint64_t first, std::uint64_t count) const {
  std::vector<double> values(count);
  read_rows(name, H5T_NATIVE_DOUBLE, first, {count}, values.data());
  return values;
}

void SerialFile::read_rows(const std::string& name, hid_t memory_type, std::uint64_t first,
                           const std::vector<hsize_t>& counts, void* data) const {
  const auto found = _datasets.find(name);
  core::require(found != _datasets.end(), "a column is read before it was checked");
  if (std::find(counts.begin(), counts.end(), hsize_t{0}) != counts.end()) return;
  const std::string doing = fmt::format("cannot read /{} of '{}'", name, _path.string());
  std::vector<hsize_t> start(counts.size(), 0);
  start[0] = first;
  const H5Handle place(check_h5<core::InputError>(H5Dget_space(found->second.get()), doing), H5Sclose);
  check_h5<core::InputError>(
      H5Sselect_hyperslab(place.get(), H5S_SELECT_SET, start.data(), nullptr, counts.data(), nullptr), doing);
  const H5Handle memory(
      check_h5<core::InputError>(H5Screate_simple(static_cast<int>(counts.size()), counts.data(), nullptr), doing),
      H5Sclose);
  check_h5<core::InputError>(H5Dread(found->second.get(), memory_type, memory.get(), place.get(), H5P_DEFAULT, data),
                             doing);
}

}  // namespace orbweaver::archive
