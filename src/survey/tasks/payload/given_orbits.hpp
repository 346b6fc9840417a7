#pragma once

#include <string>
#include <vector>

#include "orbweaver/core/serialization.hpp"
#include "orbweaver/loop/curve/loop.hpp"
#include "orbweaver/loop/curve/tangent.hpp"

namespace orbweaver::survey {

/// An orbit that the scene gives, once corrected: a family begins there.
struct GivenOrbit {
  std::string family;  ///< its key
  std::string name;    ///< its name
  std::string told;    ///< GivenStart::told
  loop::Loop loop;

  static constexpr int wire_version = 1;
  template <class Archive>
  void serialize(Archive& archive, unsigned /*version*/) {
    core::serialize_members(archive, family, name, told, loop);
  }
};

/// A family that begins with small orbits around a constant loop.
struct SmallFamily {
  std::string family;  ///< its key
  std::string name;    ///< its name
  loop::Loop base;
  loop::Tangent direction;  ///< of loops like `base`

  static constexpr int wire_version = 1;
  template <class Archive>
  void serialize(Archive& archive, unsigned /*version*/) {
    core::serialize_members(archive, family, name, base, direction);
  }
};

/// Where base families begin that others may come to: all orbits that the scene gives, each once, and the families of
/// small oscillations, in the order of their keys. Known to every rank before it follows a branch, and the same
/// whenever a survey goes on.
struct GivenOrbits {
  static constexpr const char* payload_name = "given orbits";
  std::vector<GivenOrbit> all;
  std::vector<SmallFamily> small;

  static constexpr int wire_version = 2;
  template <class Archive>
  void serialize(Archive& archive, unsigned /*version*/) {
    core::serialize_members(archive, all, small);
  }
};

[[nodiscard]] std::string pack(const GivenOrbits& orbits);
/// Throws EnvironmentError for bytes that hold something else, of another build, or torn.
[[nodiscard]] GivenOrbits unpack_given_orbits(const std::string& bytes);

}  // namespace orbweaver::survey
