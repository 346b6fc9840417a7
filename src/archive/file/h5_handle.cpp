#include "h5_handle.hpp"

#include <utility>

namespace orbweaver::archive {

namespace {

herr_t append_error(unsigned depth, const H5E_error2_t* error, void* data) {
  std::string& text = *static_cast<std::string*>(data);
  if (error->desc == nullptr || *error->desc == '\0') return 0;
  if (depth > 0 && !text.empty()) text += " <- ";
  text += error->func_name == nullptr ? "HDF5" : error->func_name;
  text += ": ";
  text += error->desc;
  return 0;
}

}  // namespace

void quiet_h5() { H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr); }

std::string h5_error_text() {
  std::string text;
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, append_error, &text);
  H5Eclear2(H5E_DEFAULT);
  return text.empty() ? "no further detail" : text;
}

H5Handle::H5Handle(H5Handle&& other) noexcept
    : _id(std::exchange(other._id, H5I_INVALID_HID)), _closer(std::exchange(other._closer, nullptr)) {}

H5Handle& H5Handle::operator=(H5Handle&& other) noexcept {
  if (this != &other) {
    reset();
    _id = std::exchange(other._id, H5I_INVALID_HID);
    _closer = std::exchange(other._closer, nullptr);
  }
  return *this;
}

H5Handle::~H5Handle() { reset(); }

hid_t H5Handle::get() const {
  core::require(!empty(), "use of an empty HDF5 handle");
  return _id;
}

void H5Handle::close(std::string_view what) {
  const hid_t id = std::exchange(_id, H5I_INVALID_HID);
  if (id >= 0) check_h5(_closer(id), what);
}

void H5Handle::reset() noexcept {
  if (_id >= 0) _closer(_id);
  _id = H5I_INVALID_HID;
}

}  // namespace orbweaver::archive
