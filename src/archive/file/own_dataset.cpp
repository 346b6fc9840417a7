#include "own_dataset.hpp"

#include <cstddef>

namespace orbweaver::archive {

namespace {

/// Whether as many bytes are stored as the extents need: HDF5 1.10 reads on behind a compact or contiguous layout that
/// has fewer.
bool holds_its_values(hid_t dataset, H5D_layout_t layout) {
  const bool is_unwritten = layout == H5D_CONTIGUOUS && H5Dget_offset(dataset) == HADDR_UNDEF;  // it reads as zeros
  if (is_unwritten || (layout != H5D_COMPACT && layout != H5D_CONTIGUOUS)) return true;
  const hid_t type = H5Dget_type(dataset);
  const hid_t space = H5Dget_space(dataset);
  const hssize_t values = space >= 0 ? H5Sget_simple_extent_npoints(space) : -1;
  const std::size_t bytes = type >= 0 ? H5Tget_size(type) : 0;
  if (type >= 0) H5Tclose(type);
  if (space >= 0) H5Sclose(space);
  return values >= 0 && bytes > 0 && H5Dget_storage_size(dataset) / bytes >= static_cast<hsize_t>(values);
}

}  // namespace

bool is_in_file(hid_t file, const std::string& name) {
  for (std::size_t end = name.find('/');; end = name.find('/', end + 1)) {
    const std::string part = name.substr(0, end);
    H5L_info_t link{};
    if (H5Lexists(file, part.c_str(), H5P_DEFAULT) <= 0 || H5Lget_info(file, part.c_str(), &link, H5P_DEFAULT) < 0 ||
        link.type != H5L_TYPE_HARD)
      return false;
    if (end == std::string::npos) return true;
  }
}

hid_t open_own_dataset(hid_t file, const std::string& name) {
  if (!is_in_file(file, name)) return H5I_INVALID_HID;
  const hid_t dataset = H5Dopen2(file, name.c_str(), H5P_DEFAULT);
  if (dataset < 0) return dataset;
  const hid_t creation = H5Dget_create_plist(dataset);
  const H5D_layout_t layout = creation >= 0 ? H5Pget_layout(creation) : H5D_LAYOUT_ERROR;
  const bool is_own = creation >= 0 && layout != H5D_VIRTUAL && H5Pget_external_count(creation) == 0 &&
                      H5Pget_nfilters(creation) == 0 && holds_its_values(dataset, layout);
  if (creation >= 0) H5Pclose(creation);
  if (is_own) return dataset;
  H5Dclose(dataset);
  return H5I_INVALID_HID;
}

}  // namespace orbweaver::archive
