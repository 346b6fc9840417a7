#pragma once

#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "orbweaver/core/serialization.hpp"

namespace orbweaver::core {

/// Describes what a type's `serialize` lists, with the versions of all types in it: "{1:f8[f8]e4}".
class Layout {
 public:
  using is_loading = std::false_type;

  template <class T>
  void visit(T& member) {
    if constexpr (std::is_enum_v<T>) {
      _text += 'e' + std::to_string(static_cast<int>(last_of(T{})));
    } else if constexpr (Serialized<T>) {
      _text += '{' + std::to_string(T::wire_version) + ':';
      member.serialize(*this, 0);
      _text += '}';
    } else {
      add(member);
    }
  }
  [[nodiscard]] const std::string& text() const { return _text; }

 private:
  template <class T>
  void add(std::vector<T>& /*member*/) {
    _text += '[';
    visit_one<T>();
    _text += ']';
  }
  template <class T>
  void add(std::optional<T>& /*member*/) {
    _text += '?';
    visit_one<T>();
  }
  void add(std::string& /*member*/) { _text += 's'; }
  template <class T>
  requires std::is_arithmetic_v<T>
  void add(T& /*member*/) {
    _text += std::is_same_v<T, bool> ? 'b' : std::is_floating_point_v<T> ? 'f' : std::is_signed_v<T> ? 'i' : 'u';
    _text += std::to_string(sizeof(T));
  }
  template <class T>
  void visit_one() {
    T one{};
    visit(one);
  }

  std::string _text;
};

/// What two builds must agree in to read each other's bytes of a T.
template <Serialized T>
[[nodiscard]] const std::string& layout_of() {
  static const std::string text = [] {
    T value{};
    Layout layout;
    layout.visit(value);
    return layout.text();
  }();
  return text;
}

}  // namespace orbweaver::core
