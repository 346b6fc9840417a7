#pragma once

#include <string>
#include <string_view>
#include <type_traits>

#include <hdf5.h>

#include "orbweaver/core/error.hpp"

namespace orbweaver::archive {

/// Switches off HDF5's habit of printing its errors to stderr; they become exceptions instead. Cheap, may be repeated.
void quiet_h5();

/// The text of HDF5's current error stack, innermost cause first, in one line; "no further detail" when it is empty.
[[nodiscard]] std::string h5_error_text();

/// Throws `Failure` (EnvironmentError by default, InputError where a file of the user is read) with HDF5's own text
/// when `result`, an hid_t, herr_t or htri_t, is negative; otherwise returns it. `what` says what was being done.
template <class Failure = core::EnvironmentError, class Result>
Result check_h5(Result result, std::string_view what) {
  if (result < 0) [[unlikely]] {
    constexpr bool is_own = std::is_same_v<Failure, core::EnvironmentError>;
    throw Failure(std::string(what) + ": HDF5 says: " + h5_error_text() +
                  (is_own ? ". Check the folder, its permissions and the free space." : ""));
  }
  return result;
}

/// Closes a file that one rank has written; negative, with HDF5's error stack, where it cannot be written to its end.
/// What the disk does not take is written into memory then: H5Fclose of HDF5 1.10 frees a file that it cannot write,
/// but not its identifier, and HDF5 crashes on that when the program ends.
herr_t close_written_file(hid_t file);

/// Owns one HDF5 identifier (file, group, dataset, dataspace, type, property list, attribute) with the function that
/// closes it. A moved-from handle is empty. Where the file was opened by several ranks, closing is collective.
class H5Handle {
 public:
  using Closer = herr_t (*)(hid_t);

  H5Handle() = default;
  /// Takes over `id`, which must be valid (pass it through check_h5).
  H5Handle(hid_t id, Closer closer) noexcept : _id(id), _closer(closer) {}
  H5Handle(const H5Handle&) = delete;
  H5Handle& operator=(const H5Handle&) = delete;
  H5Handle(H5Handle&& other) noexcept;
  H5Handle& operator=(H5Handle&& other) noexcept;
  ~H5Handle();

  /// The identifier; throws MisuseError when the handle is empty.
  [[nodiscard]] hid_t get() const;
  [[nodiscard]] bool empty() const noexcept { return _id < 0; }

  /// Closes and reports a failure, which the destructor cannot: throws EnvironmentError. The handle is empty
  /// afterwards.
  void close(std::string_view what);

 private:
  void reset() noexcept;
  hid_t _id = H5I_INVALID_HID;
  Closer _closer = nullptr;
};

}  // namespace orbweaver::archive
