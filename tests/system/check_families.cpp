// check_families ATLAS [--split]: no orbit of a family lies on another family (or elsewhere on its own), away from
// crossings. Prints what does, and exits 1. With --split every second orbit of each family is mirrored, started at
// another time, and taken for a family of its own, which must be found.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "orbweaver/archive/read/loop_of.hpp"
#include "orbweaver/archive/read/reader.hpp"
#include "orbweaver/bifurcation/identity.hpp"
#include "orbweaver/core/blas_kernels.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/core/petsc/session.hpp"
#include "orbweaver/loop/symmetry/isotropy_text.hpp"
#include "orbweaver/scene/scene.hpp"
#include "orbweaver/systems/registry.hpp"

namespace {

using namespace orbweaver;

constexpr double slack = 1e-3;        // of period, energy and action against those of two neighbours
constexpr std::size_t per_pair = 10;  // orbits of one family that are compared with another
constexpr double at_crossing = 1e-6;  // relative in period and energy

struct Box {
  double from[3];
  double to[3];
};

struct Point {
  std::size_t row;
  double values[3];  // period, energy, action
  double margin[3];
  bool moved = false;
};

struct Family {
  std::string name;
  loop::Isotropy isotropy;
  std::vector<Point> points;
  Box box;
  std::vector<Box> segments;  // of points n and n + 1
};

struct Pair {
  std::size_t x;  // point of the one
  std::size_t n;  // first of two neighbours of the other
};

bool is_in(const Point& x, const Box& box) {
  for (int i = 0; i < 3; ++i)
    if (!(x.values[i] >= box.from[i] - x.margin[i] && x.values[i] <= box.to[i] + x.margin[i])) return false;
  return true;
}

Box box_of(const std::vector<Point>& points, std::size_t first, std::size_t last) {
  Box box;
  for (int i = 0; i < 3; ++i) {
    box.from[i] = box.to[i] = points[first].values[i];
    for (std::size_t n = first; n <= last; ++n) {
      box.from[i] = std::min(box.from[i], points[n].values[i]);
      box.to[i] = std::max(box.to[i], points[n].values[i]);
    }
  }
  return box;
}

class Check {
 public:
  explicit Check(const char* path) : _atlas(path) {
    const scene::Scene scene = scene::parse(_atlas.header().scene, path);
    _system = systems::make_system(scene.system.name, scene.system.parameters, scene.system.effects);
    for (std::size_t n = 0; n < _atlas.families().rows(); ++n) {
      Family family{_atlas.families().texts("name")[n],
                    loop::isotropy_of(_system->structure(), _atlas.families().texts("isotropy")[n]),
                    {},
                    {},
                    {}};
      const auto first = static_cast<std::size_t>(_atlas.families().integers("first_orbit")[n]);
      const auto count = static_cast<std::size_t>(_atlas.families().integers("orbit_count")[n]);
      for (std::size_t row = first; row < first + count; ++row) family.points.push_back(point_of(row));
      add(std::move(family));
    }
  }

  void split_families() {
    core::require(!_families.empty(), "nothing to split");
    const std::size_t count = _families.size();
    for (std::size_t n = 0; n < count; ++n) {
      Family second{_families[n].name + ", every second orbit", _families[n].isotropy, {}, {}, {}};
      std::vector<Point> kept;
      for (const Point& point : _families[n].points) {
        const bool moved = (&point - _families[n].points.data()) % 2 == 1;
        (moved ? second.points : kept).push_back(point);
        if (moved) second.points.back().moved = true;
      }
      _families[n].points = std::move(kept);
      measure(_families[n]);
      add(std::move(second));
    }
  }

  int run() {
    for (const Family& family : _families)
      for (const Family& other : _families) compare(family, other);
    fmt::print("{} families: {} orbits were compared with neighbours on other families, {} lie on one\n",
               _families.size(), _compared, _found);
    return _found == 0 ? 0 : 1;
  }

 private:
  [[nodiscard]] Point point_of(std::size_t row) const {
    const archive::Table& orbits = _atlas.orbits();
    const double period = orbits.reals("period")[row];
    const double action = orbits.reals("action")[row];
    return {row,
            {period, orbits.reals("energy")[row], action},
            {slack * period, slack * std::abs(action) / period, slack * std::abs(action)}};
  }

  void add(Family family) {
    if (family.points.size() < 2) return;
    measure(family);
    _families.push_back(std::move(family));
  }

  static void measure(Family& family) {
    family.box = box_of(family.points, 0, family.points.size() - 1);
    family.segments.clear();
    for (std::size_t n = 0; n + 1 < family.points.size(); ++n)
      family.segments.push_back(box_of(family.points, n, n + 1));
  }

  [[nodiscard]] bool is_at_crossing(const Point& x) const {
    const archive::Table& crossings = _atlas.crossings();
    for (std::size_t n = 0; n < crossings.rows(); ++n) {
      const double m = static_cast<double>(std::max<std::int64_t>(1, crossings.integers("multiplicity")[n]));
      const double period = crossings.reals("period")[n];
      const bool energy_fits =
          std::abs(crossings.reals("energy")[n] - x.values[1]) < at_crossing * (1.0 + std::abs(x.values[1]));
      for (const double t : {period, m * period})
        if (energy_fits && std::abs(t - x.values[0]) < at_crossing * x.values[0]) return true;
    }
    return false;
  }

  [[nodiscard]] continuation::Orbit orbit_of(const Point& point) const {
    continuation::Orbit orbit;
    orbit.loop = archive::loop_of(_atlas, point.row, _system->structure().angles);
    orbit.energy = point.values[1];
    orbit.action = point.values[2];
    const systems::Structure& system = _system->structure();
    if (point.moved && !system.equivariances.empty())
      orbit.loop = loop::transformed(orbit.loop, system.equivariances.front().map, false, 0.0);
    if (point.moved) orbit.loop = loop::time_shifted(orbit.loop, 0.3183);
    return orbit;
  }

  // Whether x, an orbit of the same branch, is no further along it from the step a-b than that is long.
  [[nodiscard]] bool is_near(const Point& a, const Point& b, const Point& x) const {
    const auto& arclength = _atlas.orbits().reals("arclength");
    const double length = arclength[b.row] - arclength[a.row];
    return arclength[x.row] >= arclength[a.row] - length && arclength[x.row] <= arclength[b.row] + length;
  }

  // Which orbits of `other` have invariants between those of neighbours of `family`.
  [[nodiscard]] std::vector<Pair> candidates(const Family& family, const Family& other) const {
    std::vector<Pair> out;
    for (std::size_t x = 0; x < other.points.size(); ++x) {
      if (!is_in(other.points[x], family.box)) continue;
      for (std::size_t n = 0; n + 1 < family.points.size(); ++n) {
        // On its own family, neighbours do not count, and what is within a step of them where steps are short; a closed
        // one ends where it began.
        const std::size_t apart = x > n ? x - n : n - x;
        const bool is_own = &family == &other && (apart <= 3 || apart + 3 >= family.points.size() ||
                                                  is_near(family.points[n], family.points[n + 1], other.points[x]));
        if (!is_own && is_in(other.points[x], family.segments[n])) out.push_back({x, n});
      }
    }
    return out;
  }

  void compare(const Family& family, const Family& other) {
    if (family.points.front().moved) return;  // not at the phase of its isotropy
    const std::vector<Pair> all = candidates(family, other);
    std::vector<std::size_t> orbits;
    for (const Pair& pair : all)
      if ((orbits.empty() || orbits.back() != pair.x) && !is_at_crossing(other.points[pair.x]))
        orbits.push_back(pair.x);
    const std::size_t chosen = std::min(per_pair, orbits.size());
    for (std::size_t c = 0; c < chosen; ++c) {
      const std::size_t x = orbits[c * orbits.size() / chosen];
      const continuation::Orbit orbit = orbit_of(other.points[x]);
      for (const Pair& pair : all) {
        if (pair.x != x) continue;
        ++_compared;
        const continuation::Orbit a = orbit_of(family.points[pair.n]);
        const continuation::Orbit b = orbit_of(family.points[pair.n + 1]);
        const bifurcation::Comparison result = bifurcation::same_family(*_system, a, b, family.isotropy, orbit);
        if (!result.same) continue;
        ++_found;
        fmt::print("{}: the orbit in row {} lies on {}, between rows {} and {}: distance {:.1e}\n", other.name,
                   other.points[x].row, family.name, family.points[pair.n].row, family.points[pair.n + 1].row,
                   result.distance);
      }
    }
  }

  archive::Archive _atlas;
  std::shared_ptr<const systems::System> _system;
  std::vector<Family> _families;
  std::size_t _compared = 0;
  std::size_t _found = 0;
};

}  // namespace

int main(int argc, char** argv) {
  const bool split = argc == 3 && std::string(argv[2]) == "--split";
  if (argc != 2 && !split) {
    fmt::print(stderr, "usage: check_families ATLAS [--split]\n");
    return 2;
  }
  core::prefer_fitting_blas_kernels(argv);
  const core::Session session;
  try {
    Check check(argv[1]);
    if (split) check.split_families();
    return check.run();
  } catch (const std::exception& error) {
    fmt::print(stderr, "check_families: {}\n", error.what());
    return 2;
  }
}
