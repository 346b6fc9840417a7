// make_atlas hostile|empty|many|told|unknown FILE.h5 [ORBITS]: writes an atlas that no survey of today would make.
// make_atlas reduced FILE.h5 FILE.html: writes one of a system that a conserved quantity reduces, which only this
// program knows, and its page.
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <string>

#include <fmt/format.h>

#include "archive/sample.hpp"
#include "orbweaver/core/petsc/session.hpp"
#include "orbweaver/report/page/page.hpp"
#include "orbweaver/systems/recorded_model.hpp"
#include "orbweaver/systems/registry.hpp"
#include "page/page_template.hpp"
#include "support/lattice.hpp"

namespace {

using namespace orbweaver;

/// A dissipative system of which the program knows nothing, along a parameter.
archive::Header unknown_header() {
  archive::Header header;
  header.orbweaver_version = "9.0.0";
  header.scene = "system: unknown\n";
  header.state_names = {"x", "y", "z"};
  header.pairs = 2;
  header.symplectic = false;
  header.system = "unknown_attractor";
  header.effects = {"noise"};
  header.parameter_names = {"rho"};
  header.parameter_values = {28};
  header.scale_names = {"time", "x", "y", "z"};
  header.scales = {1, 1, 1, 1};
  return header;
}

archive::Records unknown_records() {
  archive::Records records;
  archive::FamilyRecord family;
  family.key = "0000";
  family.name = "Cycle";
  family.end_reason = "parameter limit";
  records.families.push_back(family);
  for (int step = 0; step < 40; ++step) {
    const double s = 0.05 * step;
    archive::OrbitRecord orbit;
    orbit.family_key = family.key;
    orbit.step = step;
    orbit.arclength = s;
    orbit.parameter = 20 + 3 * s - s * s;
    orbit.period = 1 + 0.1 * s;
    orbit.stability = {0.6 * s, 0.4 * s, 0.6 * s, -0.4 * s};
    orbit.stability_error = 1e-9;
    orbit.cutoff = 4;
    orbit.modes.assign(9 * 3, 0.0);
    for (int i = 0; i < 3; ++i) orbit.modes[static_cast<std::size_t>(3 * (1 + i) + i)] = 1 + s;
    orbit.state = {1 + s, 0, 0};
    records.orbits.push_back(orbit);
  }
  archive::CrossingRecord crossing;
  crossing.family_key = family.key;
  crossing.arclength = 1.38;
  crossing.period = 1.138;
  crossing.parameter = 20 + 3 * 1.38 - 1.38 * 1.38;
  crossing.kind = archive::CrossingKind::torus;
  crossing.state = {2.38, 0, 0};
  records.crossings.push_back(crossing);
  return records;
}

/// Three particles without their centre of mass: the coordinates are those that the reduction leaves.
archive::Header reduced_header() {
  systems::add_recorded<test::Lattice>();
  const auto system = systems::make_system("lattice", {{"closing", 0.0}}, {});
  archive::Header header;
  header.orbweaver_version = "0.1.0";
  header.scene = "system: {name: lattice, parameters: {closing: 0}}\n";
  header.system = "lattice";
  header.state_names = system->info().state_names;
  header.pairs = 1;
  for (const auto& [name, value] : system->parameters()) {
    header.parameter_names.push_back(name);
    header.parameter_values.push_back(value);
  }
  header.scale_names = {"time"};
  header.scale_names.insert(header.scale_names.end(), header.state_names.begin(), header.state_names.end());
  header.scale_names.push_back("energy");
  header.scales.assign(header.scale_names.size(), 1.0);
  return header;
}

archive::Header header_of() {
  archive::Header header;
  header.orbweaver_version = "0.1.0";
  header.scene = "name: </script><script>window.hacked = 1</script>\n";
  header.state_names = {"th1", "th2", "w1", "w2"};
  header.winding_names = {"n1", "n2"};
  header.winding_coordinates = {0, 1};
  header.pairs = 1;
  header.system = "double_pendulum";
  header.parameter_names = {"g", "l1", "l2", "m1", "m2"};
  header.parameter_values = {1, 1, 1, 1, 1};
  header.scale_names = {"time", "th1", "th2", "w1", "w2", "energy"};
  header.scales = {1, 1, 1, 1, 1, 1};
  return header;
}

/// Some ellipse with harmonics; T and E are smooth functions of the place along the family.
archive::OrbitRecord orbit_of(const std::string& key, int step, double s, double family) {
  archive::OrbitRecord orbit;
  orbit.family_key = key;
  orbit.step = step;
  orbit.arclength = s;
  orbit.period = 6 + 0.3 * family + s + 0.2 * std::sin(3 * s + family);
  orbit.energy = -3 + 0.2 * family + 1.5 * s + 0.1 * std::cos(5 * s);
  orbit.action = orbit.period * orbit.energy;
  orbit.stability = {2.6 * std::cos(4 * s + family)};
  orbit.fundamental_stability = orbit.stability;
  orbit.stability_error = 1e-9;
  orbit.cutoff = 24;
  orbit.modes.assign(49 * 4, 0.0);
  for (int k = 1; k <= 24; ++k)
    for (int i = 0; i < 4; ++i)
      orbit.modes[static_cast<std::size_t>((2 * k - 1 + i / 2) * 4 + i)] =
          (0.2 + s) * std::exp(-0.5 * (k - 1)) * std::cos(k * (i + 1) + family);
  orbit.state = {orbit.modes[4], orbit.modes[5], 0.0, 0.0};
  orbit.winding = {0, 0};
  orbit.loss_rms = 1e-12;
  orbit.verdict = 0;
  orbit.closure = 1e-11;
  return orbit;
}

void add_family(archive::Records& records, int number, const std::string& name, int orbits) {
  archive::FamilyRecord family;
  family.key = fmt::format("{:04}", number);
  family.name = name;
  family.isotropy = "S@1/2 R@0";
  family.end_reason = fmt::format("period limit {}", name);
  records.families.push_back(family);
  for (int step = 0; step < orbits; ++step)
    records.orbits.push_back(orbit_of(family.key, step, 2.0 * step / std::max(1, orbits - 1), number));
  archive::CrossingRecord crossing;
  crossing.family_key = family.key;
  crossing.arclength = 0.9;
  crossing.period = orbits > 0 ? records.orbits.back().period : 6;
  crossing.energy = 0;
  crossing.kind = archive::CrossingKind::period_doubling;
  crossing.multiplicity = 2;
  crossing.state = {0, 0, 0, 0};
  if (orbits > 0) records.crossings.push_back(crossing);
}

/// A double pendulum whose states are not told by its angles.
archive::Header told_header() {
  archive::Header header = header_of();
  header.scene = "system: double_pendulum\n";
  header.state_names = {"q1", "q2", "p1", "p2"};
  return header;
}

archive::Header header_for(const std::string& what) {
  if (what == "unknown") return unknown_header();
  if (what == "reduced") return reduced_header();
  return what == "told" ? told_header() : header_of();
}

archive::Records records_of(const std::string& what, int orbits) {
  archive::Records records;
  if (what == "unknown") return unknown_records();
  if (what == "told") {
    add_family(records, 0, "Told", 12);
  } else if (what == "reduced") {
    add_family(records, 0, "Breathing", 12);
    for (archive::OrbitRecord& orbit : records.orbits) orbit.winding.clear();
  } else if (what == "hostile") {
    const std::string names[] = {"</script><script>window.hacked = 1</script>",
                                 "<img src=x onerror=\"window.hacked = 2\">",
                                 "\"><svg onload='window.hacked = 3'>",
                                 "javascript:alert(1)&amp;#x3c;%3Cb%3E",
                                 "=HYPERLINK(\"http://example.org\")",
                                 "\xe2\x80\xae"
                                 "gnp.exe",
                                 "../../etc/passwd",
                                 "a b&family=In-Phase#x=E"};
    int number = 0;
    for (const std::string& name : names) add_family(records, number++, name, 12);
  } else if (what == "many") {
    constexpr int families = 200;
    for (int number = 0; number < families; ++number)
      add_family(records, number, fmt::format("F{}", number), orbits / families);
  } else {
    add_family(records, 0, "Left out", 0);
  }
  return records;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) return 2;
  const core::Session session;
  const std::filesystem::path folder = std::filesystem::path(argv[2]).parent_path() / "parts";
  std::filesystem::create_directories(folder);
  const std::string what = argv[1];
  const auto orbits = what == "many" && argc > 3 ? std::atoi(argv[3]) : 100'000;
  const auto atlas = test::write_sample_atlas(folder, header_for(what), records_of(what, orbits));
  std::filesystem::rename(atlas, argv[2]);
  std::filesystem::remove_all(folder);
  if (what == "reduced") {
    if (argc < 4) return 2;
    std::ofstream page(argv[3], std::ios::binary);
    report::write_page(page, archive::Archive(argv[2]), drivers::page_template());
  }
  return 0;
}
