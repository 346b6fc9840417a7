#include "h5_handle.hpp"

#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

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
  std::erase(text, '\n');  // HDF5's times end with one
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

herr_t close_written_file(hid_t file) {
  const herr_t flushed = H5Fflush(file, H5F_SCOPE_LOCAL);
  if (flushed >= 0) return H5Fclose(file);
  const hid_t errors = H5Eget_current_stack();
  void* handle = nullptr;
  const int memory = memfd_create("orbweaver", 0);
  if (memory >= 0 && H5Fget_vfd_handle(file, H5P_DEFAULT, &handle) >= 0) dup2(memory, *static_cast<int*>(handle));
  if (memory >= 0) ::close(memory);
  rlimit limit{};  // of the size of files, which holds in memory too
  getrlimit(RLIMIT_FSIZE, &limit);
  const rlimit none{limit.rlim_max, limit.rlim_max};
  setrlimit(RLIMIT_FSIZE, &none);
  H5Fclose(file);
  setrlimit(RLIMIT_FSIZE, &limit);
  H5Eset_current_stack(errors);
  return flushed;
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
