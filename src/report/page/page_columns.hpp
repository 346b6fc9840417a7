#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "orbweaver/archive/read/reader.hpp"

namespace orbweaver::report {

/// Typed arrays of a page, one after the other, lowest byte first.
class PageColumns {
 public:
  void add_float64(const std::string& name, const std::vector<double>& values, std::size_t width);
  void add_float32(const std::string& name, const std::vector<double>& values, std::size_t width);
  void add_int32(const std::string& name, const std::vector<std::int64_t>& values);

  [[nodiscard]] const std::vector<std::uint8_t>& bytes() const { return _bytes; }
  /// A JSON array: name, type (`float64`, `float32`, `int32`), width, and where in bytes() each begins.
  [[nodiscard]] std::string json() const;

 private:
  struct Place {
    std::string name;
    const char* type;
    std::size_t width;
    std::size_t at;
  };
  void begin(const std::string& name, const char* type, std::size_t width);

  std::vector<Place> _places;
  std::vector<std::uint8_t> _bytes;
};

/// The columns of /orbits that a page has, and `stable` (1, 0, -1: not known). What may be an axis of a diagram or
/// is copied keeps all of its digits; what certificates measured has those of float32.
void add_orbit_columns(PageColumns& columns, const archive::Archive& atlas);

}  // namespace orbweaver::report
