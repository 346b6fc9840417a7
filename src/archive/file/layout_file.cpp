#include "layout_file.hpp"

#include <algorithm>
#include <string_view>

#include <fmt/format.h>

#include "h5_types.hpp"
#include "orbweaver/core/file_hash.hpp"
#include "orbweaver/core/posix_file.hpp"
#include "schema/row_checksum.hpp"

namespace orbweaver::archive {

namespace {

// Room for attributes, headers and groups beside the datasets.
constexpr std::uint64_t metadata_bytes = std::uint64_t{1} << 18;

std::uint64_t value_bytes(const ColumnSpec& spec) { return spec.type == ColumnType::text ? spec.text_width : 8; }

H5Handle property_list(hid_t list_class) { return {check_h5(H5Pcreate(list_class), "H5Pcreate"), H5Pclose}; }

// Times would make two runs of the same scene differ.
H5Handle timeless_list(hid_t list_class) {
  H5Handle list = property_list(list_class);
  check_h5(H5Pset_obj_track_times(list.get(), false), "H5Pset_obj_track_times");
  return list;
}

// Attributes and links stay in their object's header, which has HDF5's checksum: heaps have parts that nobody reads.
void keep_in_header(const H5Handle& creation) {
  constexpr unsigned most = 1024;
  check_h5(H5Pset_attr_phase_change(creation.get(), most, 0), "H5Pset_attr_phase_change");
  check_h5(H5Pset_link_phase_change(creation.get(), most, 0), "H5Pset_link_phase_change");
}

H5Handle scalar_space() { return {check_h5(H5Screate(H5S_SCALAR), "H5Screate"), H5Sclose}; }

H5Handle dataspace(const std::vector<hsize_t>& extents) {
  const hid_t id = H5Screate_simple(static_cast<int>(extents.size()), extents.data(), nullptr);
  return {check_h5(id, "H5Screate_simple"), H5Sclose};
}

class Layout {
 public:
  enum class Begin { anew, with_what_is_there };

  Layout(const std::filesystem::path& path, Begin begin) : _path(path.string()) {
    const H5Handle access = property_list(H5P_FILE_ACCESS);
    check_h5(H5Pset_libver_bounds(access.get(), H5F_LIBVER_V18, H5F_LIBVER_V18), "H5Pset_libver_bounds");
    check_h5(H5Pset_file_locking(access.get(), false, true), "H5Pset_file_locking");
    // No blocks of which something stays unused, where a changed byte would be seen by nobody.
    check_h5(H5Pset_meta_block_size(access.get(), 0), "H5Pset_meta_block_size");
    check_h5(H5Pset_small_data_block_size(access.get(), 0), "H5Pset_small_data_block_size");
    const H5Handle creation = timeless_list(H5P_FILE_CREATE);
    keep_in_header(creation);
    const hid_t file = begin == Begin::anew ? H5Fcreate(path.c_str(), H5F_ACC_TRUNC, creation.get(), access.get())
                                            : H5Fopen(path.c_str(), H5F_ACC_RDWR, access.get());
    _file = {check_h5(file, fmt::format("cannot {} '{}'", begin == Begin::anew ? "create" : "open", _path)),
             close_written_file};
  }

  void write_attributes(const char* format, const Header& header) {
    const std::int64_t version = format_version;
    write_text("format", format);
    write_attribute("format_version", h5_memory_type({"", ColumnType::integer, {}}), scalar_space(), &version);
    const std::int64_t minor = format_minor;
    write_attribute("format_minor", h5_memory_type({"", ColumnType::integer, {}}), scalar_space(), &minor);
    write_text("orbweaver_version", header.orbweaver_version);
    write_text("scene", header.scene);
    write_texts("state_names", header.state_names);
    write_texts("winding_names", header.winding_names);
    write_text("system", header.system);
    write_texts("effects", header.effects);
    write_texts("parameter_names", header.parameter_names);
    write_numbers("parameter_values", header.parameter_values);
    write_texts("scale_names", header.scale_names);
    write_numbers("scales", header.scales);
    write_wholes("winding_coordinates", header.winding_coordinates);
    if (!header.model.empty()) write_text("model_hash", core::text_hash(header.model));
    const std::int64_t sum = header_checksum(format, format_minor, header);
    write_attribute("checksum", h5_memory_type({"", ColumnType::integer, {}}), scalar_space(), &sum);
  }

  void create_table(const TableSpec& table, std::uint64_t rows) {
    const H5Handle creation = timeless_list(H5P_GROUP_CREATE);
    keep_in_header(creation);
    const hid_t id = H5Gcreate2(_file.get(), table.name.c_str(), H5P_DEFAULT, creation.get(), H5P_DEFAULT);
    const H5Handle group(check_h5(id, fmt::format("cannot create /{} in '{}'", table.name, _path)), H5Gclose);
    for (const ColumnSpec& column : table.columns) create_dataset(table.name + '/' + column.name, column, rows);
  }

  void create_dataset(const std::string& name, const ColumnSpec& spec, std::uint64_t rows) {
    std::vector<hsize_t> extents{rows};
    extents.insert(extents.end(), spec.row_shape.begin(), spec.row_shape.end());
    const H5Handle creation = timeless_list(H5P_DATASET_CREATE);
    check_h5(H5Pset_alloc_time(creation.get(), H5D_ALLOC_TIME_EARLY), "H5Pset_alloc_time");
    check_h5(H5Pset_fill_time(creation.get(), H5D_FILL_TIME_NEVER), "H5Pset_fill_time");
    const H5Handle type = h5_file_type(spec);
    const H5Handle space = dataspace(extents);
    const hid_t id =
        H5Dcreate2(_file.get(), name.c_str(), type.get(), space.get(), H5P_DEFAULT, creation.get(), H5P_DEFAULT);
    const H5Handle dataset(check_h5(id, fmt::format("cannot create /{} in '{}'", name, _path)), H5Dclose);
    describe(dataset, "unit", spec.unit);
    describe(dataset, "meaning", spec.meaning);
  }

  void close() { _file.close(fmt::format("cannot close '{}'", _path)); }

 private:
  void write_attribute(const char* name, const H5Handle& type, const H5Handle& space, const void* data) {
    write_attribute(_file, name, type, space, data);
  }

  void write_attribute(const H5Handle& object, const char* name, const H5Handle& type, const H5Handle& space,
                       const void* data) {
    const std::string doing = fmt::format("cannot write attribute '{}' of '{}'", name, _path);
    const hid_t id = H5Acreate2(object.get(), name, type.get(), space.get(), H5P_DEFAULT, H5P_DEFAULT);
    const H5Handle attribute(check_h5(id, doing), H5Aclose);
    check_h5(H5Awrite(attribute.get(), type.get(), data), doing);
  }

  void write_text(const char* name, const std::string& text) {
    write_attribute(name, h5_text_type(std::max<std::size_t>(text.size(), 1)), scalar_space(), text.c_str());
  }

  void describe(const H5Handle& dataset, const char* name, std::string_view text) {
    if (text.empty()) return;
    write_attribute(dataset, name, h5_text_type(text.size()), scalar_space(), text.data());
  }

  void write_numbers(const char* name, const std::vector<double>& numbers) {
    const double none = 0.0;  // HDF5 wants an address even for no values
    write_attribute(name, h5_memory_type({"", ColumnType::real, {}}), dataspace({numbers.size()}),
                    numbers.empty() ? &none : numbers.data());
  }

  void write_wholes(const char* name, const std::vector<int>& numbers) {
    std::vector<std::int64_t> wide(numbers.begin(), numbers.end());
    const hsize_t count = wide.size();
    if (wide.empty()) wide.push_back(0);  // as for numbers
    write_attribute(name, h5_memory_type({"", ColumnType::integer, {}}), dataspace({count}), wide.data());
  }

  void write_texts(const char* name, const std::vector<std::string>& texts) {
    const std::size_t width = longest_text(texts);
    const std::string block = padded_texts(texts, width);
    write_attribute(name, h5_text_type(width), dataspace({texts.size()}), block.c_str());
  }

  std::string _path;
  H5Handle _file;
};

}  // namespace

std::uint64_t FileLayout::bytes() const {
  std::uint64_t sum = 0;
  for (const auto& [table, rows] : tables)
    for (const ColumnSpec& column : table.columns) sum += rows * column.width() * value_bytes(column);
  for (const auto& [name, count] : flats) sum += count * sizeof(double);
  return sum;
}

void create_layout_file(const std::filesystem::path& path, const FileLayout& layout) {
  const std::uint64_t bytes = layout.bytes();
  core::try_out_file(path, bytes + metadata_bytes);
  Layout file(path, Layout::Begin::anew);
  file.write_attributes(layout.format, layout.header);
  for (const auto& [table, rows] : layout.tables) file.create_table(table, rows);
  for (const auto& [spec, count] : layout.flats) file.create_dataset(spec.name, spec, count);
  file.close();
  core::reserve_space(path, std::filesystem::file_size(path));
}

void add_table_to_file(const std::filesystem::path& path, const TableSpec& table, std::uint64_t rows) {
  Layout file(path, Layout::Begin::with_what_is_there);
  file.create_table(table, rows);
  file.close();
  core::reserve_space(path, std::filesystem::file_size(path));
}

}  // namespace orbweaver::archive
