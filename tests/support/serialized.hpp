#pragma once

#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <type_traits>
#include <typeinfo>
#include <vector>

#include <fmt/format.h>

#include "orbweaver/core/serialization.hpp"

namespace orbweaver::test {

/// Members of an aggregate, up to 24.
template <class T>
consteval int member_count() {
  int count = 0;
#define ORBWEAVER_MEMBERS(n, ...) \
  if constexpr (requires { T{__VA_ARGS__}; }) count = n
  ORBWEAVER_MEMBERS(1, {});
  ORBWEAVER_MEMBERS(2, {}, {});
  ORBWEAVER_MEMBERS(3, {}, {}, {});
  ORBWEAVER_MEMBERS(4, {}, {}, {}, {});
  ORBWEAVER_MEMBERS(5, {}, {}, {}, {}, {});
  ORBWEAVER_MEMBERS(6, {}, {}, {}, {}, {}, {});
  ORBWEAVER_MEMBERS(7, {}, {}, {}, {}, {}, {}, {});
  ORBWEAVER_MEMBERS(8, {}, {}, {}, {}, {}, {}, {}, {});
  ORBWEAVER_MEMBERS(9, {}, {}, {}, {}, {}, {}, {}, {}, {});
  ORBWEAVER_MEMBERS(10, {}, {}, {}, {}, {}, {}, {}, {}, {}, {});
  ORBWEAVER_MEMBERS(11, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {});
  ORBWEAVER_MEMBERS(12, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {});
  ORBWEAVER_MEMBERS(13, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {});
  ORBWEAVER_MEMBERS(14, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {});
  ORBWEAVER_MEMBERS(15, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {});
  ORBWEAVER_MEMBERS(16, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {});
  ORBWEAVER_MEMBERS(17, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {});
  ORBWEAVER_MEMBERS(18, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {});
  ORBWEAVER_MEMBERS(19, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {});
  ORBWEAVER_MEMBERS(20, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {});
  ORBWEAVER_MEMBERS(21, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {});
  ORBWEAVER_MEMBERS(22, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {});
  ORBWEAVER_MEMBERS(23, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {});
  ORBWEAVER_MEMBERS(24, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {});
#undef ORBWEAVER_MEMBERS
  return count;
}

/// Members of T that are not sent on purpose.
template <class T>
inline constexpr int kept_members = 0;

/// Finds types, at any depth, whose `serialize` does not list every member once.
class Completeness {
 public:
  using is_loading = std::false_type;

  template <class T>
  void visit(T& member) {
    if (!_members.empty()) _members.back().insert(&member);
    if constexpr (core::Serialized<T>) {
      if (!_seen.insert(typeid(T).name()).second) return;
      _members.emplace_back();
      member.serialize(*this, 0);
      const int listed = static_cast<int>(_members.back().size());
      _members.pop_back();
      const int expected = member_count<T>() - kept_members<T>;
      if (listed != expected)
        _problems += fmt::format("{} has {} members to be sent and lists {}\n", typeid(T).name(), expected, listed);
    }
  }
  template <class T>
  void visit(std::vector<T>& member) {
    visit_one<T>(&member);
  }
  template <class T>
  void visit(std::optional<T>& member) {
    visit_one<T>(&member);
  }
  [[nodiscard]] const std::string& problems() const { return _problems; }

 private:
  template <class T>
  void visit_one(const void* address) {
    _members.back().insert(address);
    T one{};
    const std::set<const void*> outside = _members.back();
    visit(one);
    _members.back() = outside;
  }

  std::vector<std::set<const void*>> _members;  // of the types that are being visited, by their addresses
  std::set<std::string> _seen;
  std::string _problems;
};

template <class T>
[[nodiscard]] std::string incomplete_types_in() {
  T value{};
  Completeness completeness;
  completeness.visit(value);
  return completeness.problems();
}

/// Gives every member an unusual value.
class Filler {
 public:
  using is_loading = std::false_type;

  template <class T>
  void visit(T& member) {
    if constexpr (std::is_enum_v<T>)
      member = last_of(T{});
    else if constexpr (std::is_same_v<T, bool>)
      member = !member;
    else if constexpr (std::is_floating_point_v<T>)
      member = next_real();
    else if constexpr (std::is_arithmetic_v<T>)
      member = ++_count % 2 == 0 ? std::numeric_limits<T>::min() : std::numeric_limits<T>::max();
    else
      fill(*this, member);
  }
  void visit(std::string& member) { member = fmt::format("{} Naïve\n\xff", ++_count) + std::string("\0\x7f", 2); }
  template <class T>
  void visit(std::vector<T>& member) {
    member.resize(2 + static_cast<std::size_t>(++_count % 2));
    for (T& element : member) visit(element);
  }
  template <class T>
  void visit(std::optional<T>& member) {
    visit(member.emplace());
  }

 private:
  double next_real() {
    using Limits = std::numeric_limits<double>;
    constexpr double values[]{Limits::quiet_NaN(), -0.0,     Limits::denorm_min(), Limits::max(), -Limits::infinity(),
                              Limits::min(),       1.0 / 3.0};
    return values[++_count % std::size(values)];
  }
  unsigned _count = 0;
};

/// To be overloaded for types that take certain values only.
template <core::Serialized T>
void fill(Filler& filler, T& value) {
  value.serialize(filler, 0);
  if constexpr (requires { value.limited_by; }) value.limited_by = 15;
}

/// All that `serialize` lists, with all bits of it.
class Text {
 public:
  using is_loading = std::false_type;

  template <class T>
  void visit(T& member) {
    if constexpr (core::Serialized<T>) {
      text += '{';
      member.serialize(*this, 0);
      text += '}';
    } else if constexpr (std::is_floating_point_v<T>) {
      std::uint64_t bits = 0;
      std::memcpy(&bits, &member, sizeof bits);
      text += fmt::format("{:x} ", bits);
    } else if constexpr (std::is_enum_v<T>) {
      text += fmt::format("{} ", static_cast<int>(member));
    } else {
      text += fmt::format("{} ", member);
    }
  }
  void visit(std::string& member) {
    for (const char c : member) text += fmt::format("{:02x}", static_cast<unsigned char>(c));
    text += ' ';
  }
  template <class T>
  void visit(std::vector<T>& member) {
    text += fmt::format("[{}: ", member.size());
    for (T& element : member) visit(element);
    text += ']';
  }
  template <class T>
  void visit(std::optional<T>& member) {
    text += member ? '?' : '-';
    if (member) visit(*member);
  }
  std::string text;
};

template <class T>
[[nodiscard]] std::string text_of(T value) {
  Text text;
  text.visit(value);
  return text.text;
}

template <class T>
[[nodiscard]] T filled() {
  T value{};
  Filler filler;
  filler.visit(value);
  return value;
}

}  // namespace orbweaver::test
