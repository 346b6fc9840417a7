#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include <boost/archive/binary_iarchive.hpp>
#include <boost/archive/binary_oarchive.hpp>

#include "orbweaver/core/layout.hpp"
#include "orbweaver/core/mpi/team.hpp"
#include "orbweaver/queue/boost_serialization.hpp"

namespace orbweaver::survey {

/// What stands before the members in the bytes of a value.
struct PayloadType {
  const char* name;
  int version;
  std::uint64_t layout;  ///< digest of core::layout_of
};

template <core::Serialized T>
[[nodiscard]] PayloadType payload_type() {
  static const std::uint64_t layout = core::digest_of(core::layout_of<T>());
  return {T::payload_name, T::wire_version, layout};
}

/// Whether `bytes` begin as those of that type, of any version.
[[nodiscard]] bool is_named(const PayloadType& type, const std::string& bytes);
[[nodiscard]] std::string write_payload(const PayloadType& type,
                                        const std::function<void(boost::archive::binary_oarchive&)>& write);
void read_payload(const PayloadType& type, const std::string& bytes,
                  const std::function<void(boost::archive::binary_iarchive&)>& read);

/// `value` as bytes. To be instantiated in the source of its type only: it is slow to compile.
template <core::Serialized T>
[[nodiscard]] std::string to_payload(const T& value) {
  return write_payload(payload_type<T>(), [&](boost::archive::binary_oarchive& archive) { archive << value; });
}

/// The value in `bytes`. Throws EnvironmentError unless they hold a T of this version and layout, whole and valid.
template <core::Serialized T>
[[nodiscard]] T from_payload(const std::string& bytes) {
  T value;
  read_payload(payload_type<T>(), bytes, [&](boost::archive::binary_iarchive& archive) { archive >> value; });
  return value;
}

}  // namespace orbweaver::survey
