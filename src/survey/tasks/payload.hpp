#pragma once

#include <exception>
#include <sstream>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <boost/archive/binary_iarchive.hpp>
#include <boost/archive/binary_oarchive.hpp>
#include <boost/serialization/string.hpp>
#include <boost/serialization/vector.hpp>

#include "orbweaver/core/error.hpp"

namespace orbweaver::survey {

/// Version of everything that travels in payloads and lies in checkpoints and journals.
inline constexpr int payload_version = 3;

/// `value` as bytes: a name, the version, and its members.
template <class T>
[[nodiscard]] std::string to_payload(const T& value) {
  std::ostringstream stream;
  {
    boost::archive::binary_oarchive archive(stream);
    const std::string name = T::payload_name;
    archive << name << payload_version << value;
  }
  return std::move(stream).str();
}

/// The value in `bytes`. Throws EnvironmentError unless they hold a T of this version, whole.
template <class T>
[[nodiscard]] T from_payload(const std::string& bytes) {
  try {
    std::istringstream stream(bytes);
    boost::archive::binary_iarchive archive(stream);
    std::string name;
    int version = 0;
    archive >> name >> version;
    if (name != T::payload_name || version != payload_version)
      throw core::EnvironmentError(
          fmt::format("expected a {} of version {}, got a {} of version {}: all ranks, and whoever "
                      "wrote the files of a survey, must be the same build of Orbweaver",
                      T::payload_name, payload_version, name, version));
    T value;
    archive >> value;
    if (stream.peek() != std::istringstream::traits_type::eof())
      throw core::EnvironmentError(
          fmt::format("a {} of {} bytes has more bytes than its own", T::payload_name, bytes.size()));
    return value;
  } catch (const core::EnvironmentError&) {
    throw;
  } catch (const std::exception& error) {  // foreign bytes may also ask Boost for texts of impossible length
    throw core::EnvironmentError(
        fmt::format("a {} of {} bytes cannot be read: {}", T::payload_name, bytes.size(), error.what()));
  }
}

}  // namespace orbweaver::survey
