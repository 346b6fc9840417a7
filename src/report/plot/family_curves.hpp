#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "orbit_stability.hpp"
#include "orbweaver/archive/read/reader.hpp"
#include "plot/figure.hpp"

namespace orbweaver::report {

/// Families of an archive as curves through their orbits.
class FamilyCurves {
 public:
  /// `families`: only these (names); none: all that have orbits. Throws InputError for names that are not there, and
  /// where no orbits are left.
  FamilyCurves(const archive::Archive& atlas, const std::vector<std::string>& families);

  [[nodiscard]] const archive::Archive& atlas() const { return _atlas; }
  /// Rows of /families, parents before what was born on them.
  [[nodiscard]] const std::vector<std::size_t>& families() const { return _families; }
  [[nodiscard]] const std::string& name(std::size_t family) const { return _atlas.families().texts("name")[family]; }
  /// That of its first ancestor among the families drawn; of its own where there are few.
  [[nodiscard]] std::string colour(std::size_t family) const;
  /// Families that have a colour of their own, as many as there are colours.
  [[nodiscard]] const std::vector<std::size_t>& coloured() const { return _coloured; }

  /// A number of an orbit, by its row.
  using Number = std::function<double(std::size_t)>;
  /// A column of /orbits.
  [[nodiscard]] Number column(const char* name) const;

  /// The curve of a family: polynomials of third degree in the arclength through the numbers as the axes have them.
  /// Solid where it is stable, dashed where it is not, dotted where that is not known.
  [[nodiscard]] std::vector<Series> drawn(std::size_t family, const Number& x, const Axis& x_axis, const Number& y,
                                          const Axis& y_axis) const;
  /// The same in one piece, for the place of its name.
  [[nodiscard]] NamedCurve named(std::size_t family, const Number& x, const Axis& x_axis, const Number& y,
                                 const Axis& y_axis) const;

 private:
  struct Sample {
    PlotPoint point;
    Look look;
  };
  [[nodiscard]] std::vector<Sample> samples(std::size_t family, const Number& x, const Axis& x_axis, const Number& y,
                                            const Axis& y_axis) const;
  [[nodiscard]] Look look_of(std::size_t orbit) const;
  /// Where the stability changes between an orbit and the next: at a crossing, or in the middle.
  [[nodiscard]] double change_between(std::size_t family, std::size_t orbit) const;

  const archive::Archive& _atlas;
  OrbitStability _stability;
  std::vector<std::size_t> _families;
  std::vector<std::size_t> _colour_of;  ///< of a row of /families: the family whose colour it has
  std::vector<std::size_t> _coloured;
};

/// The inverse of `placed`.
[[nodiscard]] double unplaced(Scale scale, double value);

}  // namespace orbweaver::report
