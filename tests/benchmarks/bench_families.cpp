// Traces the families of the double pendulum in a fresh process and prints what it cost: one side of the comparison
// with AUTO-07p (tests/benchmarks/auto07p/compare.py).
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <exception>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "family_orbit.hpp"
#include "orbit_error.hpp"
#include "orbweaver/core/blas_kernels.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/core/petsc/session.hpp"
#include "orbweaver/spectrum/floquet.hpp"
#include "orbweaver/systems/registry.hpp"
#include "orbweaver/systems/scaled_system.hpp"
#include "support/relative_error.hpp"

namespace {

using namespace orbweaver;
using benchmarks::Family;

struct Settings {
  Family family = Family::in_phase;
  double period = 30.0;
  double longest = 0.0;
  double fixed_step = 0.0;
  int aim = 0;
  int repetitions = 1;
  bool full = false;
  bool multipliers = false;
  bool check = false;
  bool no_time_map = false;
  bool scaled = false;
  double bound = std::numeric_limits<double>::infinity();
};

struct Trace {
  std::vector<loop::Loop> loops;  // only if kept
  int orbits = 0;
  int cutoff = 0;
  double microseconds = 0.0;
  double worst_index_error = 0.0;
};

double cpu_microseconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return 1e6 * static_cast<double>(now.tv_sec) + 1e-3 * static_cast<double>(now.tv_nsec);
}

continuation::Options options_of(const Settings& s) {
  continuation::Options options;
  options.period_limit = s.period;
  options.fit_time_map = !s.no_time_map;
  if (s.longest > 0.0) options.largest_step = s.longest;
  if (s.fixed_step > 0.0) options.fixed_step = s.fixed_step;
  return options;
}

Trace trace(const benchmarks::FamilyStart& from, const Settings& s, bool keep) {
  continuation::Start start = from.start;
  if (s.full) start.isotropy.clear();
  Trace out;
  const double begin = cpu_microseconds();
  continuation::Branch branch(from.system, start, options_of(s));
  while (const auto orbit = branch.advance()) {
    if (s.multipliers)
      out.worst_index_error = std::max(
          out.worst_index_error, test::relative_error(spectrum::floquet(*from.system, orbit->loop, start.isotropy)));
    out.cutoff = std::max(out.cutoff, orbit->loop.cutoff);
    ++out.orbits;
    if (keep) out.loops.push_back(orbit->loop);
  }
  out.microseconds = cpu_microseconds() - begin;
  if (branch.ending()->reason != continuation::EndReason::period_limit)
    throw core::NumericalError("the family does not reach the period: " + branch.ending()->text());
  return out;
}

// Maxima of the distance to the true orbits, by period (the last: all beyond T = 20); returns the largest of all.
double print_errors(const benchmarks::FamilyStart& from, const Trace& traced) {
  constexpr double limits[] = {0.0, 10.0, 15.0, 20.0, std::numeric_limits<double>::infinity()};
  double worst[4] = {};
  double reference = 0.0;
  for (std::size_t n = 0; n < traced.loops.size(); ++n) {
    const loop::Loop& orbit = traced.loops[n];
    const loop::Loop& neighbour = traced.loops[n > 0 ? n - 1 : 1];
    const benchmarks::OrbitError error = benchmarks::error_of(*from.system, orbit, neighbour, from.start.isotropy);
    reference = std::max(reference, error.reference_step);
    for (int range = 0; range < 4; ++range)
      if (orbit.period >= limits[range] && orbit.period < limits[range + 1])
        worst[range] = std::max(worst[range], error.distance);
  }
  fmt::print("error_T10={:.1e} error_T15={:.1e} error_T20={:.1e} error_T30={:.1e} reference={:.1e}\n", worst[0],
             worst[1], worst[2], worst[3], reference);
  return *std::max_element(std::begin(worst), std::end(worst));
}

// The longest step with which a trace has about `aim` orbits.
double step_for(const benchmarks::FamilyStart& from, Settings s) {
  double low = 1e-3;
  double high = 1.0;
  for (int n = 0; n < 12; ++n) {
    s.longest = std::sqrt(low * high);
    const int orbits = trace(from, s, false).orbits;
    if (std::abs(orbits - s.aim) <= 2) break;
    (orbits > s.aim ? low : high) = s.longest;
  }
  return s.longest;
}

void run(const Settings& s) {
  const double begin = cpu_microseconds();
  benchmarks::FamilyStart from = benchmarks::start_of(s.family);
  if (s.scaled)  // the same bits, told in scales
    from.system = systems::scaled(systems::make_system("double_pendulum", {{"g", 16.0}}),
                                  {0.25, {1.0, 1.0, 4.0, 4.0}, {16.0}, {}});
  const double start = cpu_microseconds() - begin;
  if (s.aim > 0) {
    fmt::print("longest={:.6g}\n", step_for(from, s));
    return;
  }
  const Trace cold = trace(from, s, s.check);
  const auto orbits = static_cast<double>(cold.orbits);
  fmt::print("orbits={} K={} cold={:.1f} cold_per_orbit={:.2f} start={:.0f}", cold.orbits, cold.cutoff,
             cold.microseconds, cold.microseconds / orbits, start);
  if (s.multipliers) fmt::print(" index_error={:.1e}", cold.worst_index_error);
  std::vector<double> warm;
  for (int n = 1; n < s.repetitions; ++n) warm.push_back(trace(from, s, false).microseconds);
  if (!warm.empty()) {
    std::nth_element(warm.begin(), warm.begin() + static_cast<std::ptrdiff_t>(warm.size() / 2), warm.end());
    fmt::print(" warm={:.1f} warm_per_orbit={:.2f}", warm[warm.size() / 2], warm[warm.size() / 2] / orbits);
  }
  fmt::print("\n");
  if (!s.check) return;
  const double error = print_errors(from, cold);
  if (!(error <= s.bound))
    throw core::NumericalError(fmt::format("an orbit is {:.2g} off the true one, more than {:.2g}", error, s.bound));
}

}  // namespace

int main(int argc, char** argv) {
  orbweaver::core::prefer_fitting_blas_kernels(argv);
  Settings settings;
  CLI::App program("Traces one family of the double pendulum; times are CPU microseconds of this process.");
  const std::map<std::string, Family> names{
      {"in", Family::in_phase}, {"out", Family::out_phase}, {"du", Family::down_up}, {"ud", Family::up_down}};
  program.add_option("--family", settings.family, "in, out, du or ud")->transform(CLI::CheckedTransformer(names));
  program.add_option("--period", settings.period, "Where the family ends")->capture_default_str();
  program.add_option("--longest", settings.longest,
                     "Bound on the adaptive steps, in coefficients (default: the engine's)");
  program.add_option("--fixed-step", settings.fixed_step, "Every step by |dz(s = 0)|, radians, instead");
  program.add_option("--aim", settings.aim, "Print the bound --longest that gives about this many orbits, and end");
  program.add_option("--repetitions", settings.repetitions, "Traces; the first is the cold one")->capture_default_str();
  program.add_flag("--full", settings.full, "Full loops: no symmetry assumed");
  program.add_flag("--multipliers", settings.multipliers, "Floquet multipliers of every orbit");
  program.add_flag("--no-time-map", settings.no_time_map, "s runs evenly with time");
  program.add_flag("--check", settings.check, "Distance of every orbit to the true one");
  program.add_flag("--scaled", settings.scaled, "The pendulum with g = 16, told in scales that give the same bits");
  program.add_option("--bound", settings.bound, "Fail if it is larger for any");
  CLI11_PARSE(program, argc, argv);
  try {
    const orbweaver::core::Session session;
    run(settings);
  } catch (const std::exception& error) {
    fmt::print(stderr, "bench_families: {}\n", error.what());
    return 1;
  }
  return 0;
}
