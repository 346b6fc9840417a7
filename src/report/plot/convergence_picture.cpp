#include "plot/convergence_picture.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <Eigen/Dense>

#include "family_row.hpp"
#include "gnuplot.hpp"
#include "orbweaver/certificate/certificate.hpp"
#include "orbweaver/certificate/integrate.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/corrector/correct.hpp"
#include "orbweaver/loop/curve/measures.hpp"
#include "orbweaver/loop/symmetry/isotropy_text.hpp"
#include "orbweaver/survey/atlas/stored_orbits.hpp"
#include "plot/axis_titles.hpp"
#include "plot/orbit_paths.hpp"

namespace orbweaver::report {

namespace {

/// Iterations after which a first-order method is given up, and how much further each look at it is than the last.
constexpr int most_iterations = 3000;
constexpr double further = 1.15;

/// An orbit of a family as a problem for the correctors: through a guess, across the family.
struct Problem {
  std::shared_ptr<const systems::System> system;
  loss::Unknowns unknowns;
  loss::Slice slice;
  loop::Loop guess;
};

/// The prediction along the line through the two orbits before it, as far as the orbit lies.
Problem problem_of(const archive::Archive& atlas, const OrbitChoice& choice) {
  const auto [first, count] = orbits_of(atlas, choice.family);
  const bool backwards = atlas.orbits().integers("step")[choice.orbit] < 0;
  const std::size_t before = backwards ? first + count - 1 - choice.orbit : choice.orbit - first;
  if (before < 2)
    throw core::InputError(fmt::format("step {} of `{}` has not two orbits before it, which a guess is made from",
                                       atlas.orbits().integers("step")[choice.orbit],
                                       atlas.families().texts("name")[choice.family]));
  const auto system = survey::scaled_system_of(atlas);
  const auto row = [&](std::size_t back) { return backwards ? choice.orbit + back : choice.orbit - back; };
  std::vector<loop::Loop> loops;
  int cutoff = 0;
  for (const std::size_t back : {2, 1, 0}) {
    loop::Loop loop = loop::evenly_in_time(survey::stored_loop(atlas, row(back), *system));
    if (!loops.empty()) loop = survey::started_as(system->structure(), loop, loops.back());
    cutoff = std::max(cutoff, loop.cutoff);
    loops.push_back(std::move(loop));
  }
  for (loop::Loop& loop : loops) loop = loop::with_cutoff(loop, cutoff);
  // Where a reversor fixes the phase all three have the isotropy as it is stored; else they are whole loops.
  const loop::Isotropy isotropy =
      loop::isotropy_of(system->structure(), atlas.families().texts("isotropy")[choice.family]);
  loss::Unknowns unknowns{loop::Subspace(system->dimension(), cutoff, isotropy), {loss::Scalar::period()}};
  const auto vector_of = [&](const std::vector<double>& u) {
    return Eigen::VectorXd(Eigen::Map<const Eigen::VectorXd>(u.data(), static_cast<Eigen::Index>(u.size())));
  };
  const Eigen::VectorXd along = vector_of(unknowns.difference(loops[0], loops[1])).normalized();
  const double ahead = along.dot(vector_of(unknowns.difference(loops[1], loops[2])));
  const Eigen::VectorXd step = ahead * along;
  loop::Loop guess = unknowns.moved(loops[1], {step.data(), static_cast<std::size_t>(step.size())});
  const Eigen::VectorXd shift = vector_of(unknowns.time_shift_direction(guess));
  const bool holds_phase = shift.norm() > loss::Unknowns::least_time_shift * loop::rms_amplitude(guess);
  Eigen::MatrixXd conditions(along.size(), holds_phase ? 2 : 1);
  conditions.col(0) = along;
  if (holds_phase) conditions.col(1) = (shift - along.dot(shift) * along).normalized();
  loss::Slice slice(unknowns.size(), conditions);
  return {system, std::move(unknowns), std::move(slice), std::move(guess)};
}

double gap_once_around(const systems::System& system, const loop::Loop& loop) {
  const std::vector<double> start = loop::state_at(loop, 0.0);
  try {
    const std::vector<double> end =
        certificate::integrate(system, start, loop.period, certificate::Options{}.tolerance);
    double sum = 0.0;
    for (std::size_t i = 0; i < end.size(); ++i)
      sum += std::pow(end[i] - start[i] - 2.0 * std::numbers::pi * loop.winding[i], 2);
    return std::sqrt(sum);
  } catch (const core::NumericalError&) {
    return no_value;
  }
}

struct Course {
  std::vector<PlotPoint> loss;
  std::vector<PlotPoint> gap;
  int iterations = 0;
  bool converged = false;
};

/// Looked at by stopping early, again and again: all methods are deterministic.
Course course_of(const Problem& problem, corrector::Method method) {
  Course course;
  const auto add = [&](int iterations, double loss_rms, const loop::Loop& loop) {
    course.loss.push_back({static_cast<double>(iterations), loss_rms});
    course.gap.push_back({static_cast<double>(iterations), gap_once_around(*problem.system, loop)});
  };
  int last = 0;
  for (int next = 1; next <= most_iterations;
       next = std::max(next + 1, static_cast<int>(std::lround(further * next)))) {
    corrector::Options options;
    options.method = method;
    options.max_iterations = next;
    const corrector::Result result =
        corrector::correct(*problem.system, problem.guess, problem.unknowns, problem.slice, options);
    if (result.iterations <= last) break;
    last = result.iterations;
    add(result.iterations, result.loss_rms, result.loop);
    course.iterations = result.iterations;
    course.converged = result.converged();
    if (result.outcome != corrector::Outcome::iteration_limit) break;
  }
  return course;
}

}  // namespace

Figure convergence_figure(const archive::Archive& atlas, const PlotRequest& request) {
  const OrbitChoice choice = chosen_orbit(atlas, request);
  const Problem problem = problem_of(atlas, choice);
  Figure figure{fmt::format("{}, {}", title_of(atlas, choice.family), short_text(atlas, choice.orbit)),
                {"iterations", Scale::logarithmic},
                {"root of the loss; gap", Scale::logarithmic}};
  const std::pair<corrector::Method, const char*> methods[] = {
      {corrector::Method::rprop, "Rprop"},
      {corrector::Method::rprop_extrapolated, "Rprop, extrapolated"},
      {corrector::Method::automatic, "Newton"}};
  std::size_t n = 0;
  for (const auto& [method, name] : methods) {
    const Course course = course_of(problem, method);
    figure.series.push_back({fmt::format("{}: {}{}", name, course.converged ? "" : "> ", course.iterations),
                             Look::solid, plot_colours[n], course.loss});
    figure.series.push_back({"", Look::dotted, plot_colours[n], course.gap});
    ++n;
  }
  figure.series.push_back({"loss", Look::solid, "#000000", {figure.series.front().points.front()}});
  figure.series.push_back({"gap once around", Look::dotted, "#000000", {figure.series.front().points.front()}});
  return figure;
}

}  // namespace orbweaver::report
