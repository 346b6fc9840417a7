#pragma once

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

namespace orbweaver::core {

// A type that travels between ranks or lies in files lists its members in a `serialize` of its own, in the form that
// Boost.Serialization calls, and counts in `wire_version` the changes of what they mean:
//
//   struct Orbit {
//     loop::Loop loop;
//     Kind kind;  // last_of(Kind) stands beside the enum
//
//     static constexpr int wire_version = 1;
//     template <class Archive>
//     void serialize(Archive& archive, unsigned /*version*/) {
//       core::serialize_members(archive, loop, kind);
//     }
//   };
//
// Nothing else lists them. What is added, left out or moved changes the type's layout (layout.hpp), by which the bytes
// of other builds are refused.

template <class T>
concept Serialized = requires {
  { T::wire_version } -> std::convertible_to<int>;
};

/// An archive that neither writes nor reads, but describes or counts members.
template <class Archive, class T>
concept Visits = requires(Archive& archive, T& member) {
  archive.visit(member);
};

/// Throws EnvironmentError: `number` is no value of an enum whose last one is `last`.
[[noreturn]] void refuse_enum(int number, int last);
/// Throws EnvironmentError: the byte of a flag is neither 0 nor 1.
[[noreturn]] void refuse_flag(int byte);

/// Bytes by which a text or a list of numbers grows while it is read, so that a forged size takes no more memory than
/// there are bytes behind it.
inline constexpr std::size_t growth_bytes = 1 << 16;

template <class Archive, class T>
void serialize_member(Archive& archive, std::optional<T>& member);
template <class Archive, class T>
void serialize_member(Archive& archive, std::vector<T>& member);
template <class Archive>
void serialize_member(Archive& archive, std::string& member);

/// The values of a text or a list of numbers behind their number.
template <class Archive, class Values>
void serialize_values(Archive& archive, Values& values) {
  using Value = typename Values::value_type;
  std::uint64_t size = values.size();
  archive& size;
  if constexpr (Archive::is_loading::value) {
    values.clear();
    while (values.size() < size) {
      const std::size_t begin = values.size();
      values.resize(begin + std::min<std::uint64_t>(size - begin, growth_bytes / sizeof(Value)));
      archive.load_binary(values.data() + begin, (values.size() - begin) * sizeof(Value));
    }
  } else if (size > 0) {
    archive.save_binary(values.data(), values.size() * sizeof(Value));
  }
}

/// One member: an enum as an int that is checked, a flag as a byte that is, an optional one behind a flag, a text or
/// list behind its size, others as the archive does it.
template <class Archive, class T>
void serialize_member(Archive& archive, T& member) {
  if constexpr (Visits<Archive, T>) {
    archive.visit(member);
  } else if constexpr (std::is_enum_v<T>) {
    constexpr int last = static_cast<int>(last_of(T{}));
    int number = static_cast<int>(member);
    archive& number;
    if (number < 0 || number > last) refuse_enum(number, last);
    if constexpr (Archive::is_loading::value) member = static_cast<T>(number);
  } else if constexpr (std::is_same_v<T, bool>) {
    unsigned char byte = member ? 1 : 0;  // a bool that holds another value than these is undefined
    archive& byte;
    if (byte > 1) refuse_flag(byte);
    if constexpr (Archive::is_loading::value) member = byte == 1;
  } else {
    archive& member;
  }
}

template <class Archive, class T>
void serialize_member(Archive& archive, std::optional<T>& member) {
  if constexpr (Visits<Archive, std::optional<T>>) {
    archive.visit(member);
  } else {
    bool present = member.has_value();
    serialize_member(archive, present);
    if constexpr (Archive::is_loading::value) {
      member.reset();
      if (present) member.emplace();
    }
    if (present) serialize_member(archive, *member);
  }
}

template <class Archive, class T>
void serialize_member(Archive& archive, std::vector<T>& member) {
  if constexpr (Visits<Archive, std::vector<T>>) {
    archive.visit(member);
  } else if constexpr (std::is_arithmetic_v<T>) {
    static_assert(!std::is_same_v<T, bool>, "a vector of bool has no values that lie in memory");
    serialize_values(archive, member);
  } else {
    std::uint64_t size = member.size();
    archive& size;
    if constexpr (Archive::is_loading::value) {
      member.clear();
      for (std::uint64_t n = 0; n < size; ++n) serialize_member(archive, member.emplace_back());
    } else {
      for (T& element : member) serialize_member(archive, element);
    }
  }
}

template <class Archive>
void serialize_member(Archive& archive, std::string& member) {
  if constexpr (Visits<Archive, std::string>)
    archive.visit(member);
  else
    serialize_values(archive, member);
}

template <class Archive, class... Members>
void serialize_members(Archive& archive, Members&... members) {
  (serialize_member(archive, members), ...);
}

}  // namespace orbweaver::core
