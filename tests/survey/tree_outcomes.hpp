#pragma once

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "orbweaver/queue/task.hpp"
#include "tasks/payload/work.hpp"

namespace orbweaver::test {

/// Tasks and outcomes of a survey that never ran: loops made by hand with the symmetries of the double pendulum's.
struct Ended {
  queue::Task task;
  queue::TaskOutcome outcome;
};

/// A place where families leave: `times` around an orbit with S@1/2 R@0 whose size tells one place from another.
struct Place {
  std::string key;
  double period;     // of the orbit, once around
  double arclength;  // also sets its size and energy
  int times = 2;
  std::string parent = "0000.0000";
  int depth = 0;  // of the parent

  [[nodiscard]] double energy() const { return -3.0 + arclength; }
  [[nodiscard]] std::string leaving(int number) const { return key + "/" + std::to_string(number); }
};

inline constexpr double pi_number = 3.141592653589793;

inline loop::Loop orbit_at(const Place& place) {
  const std::vector<double> point(4, 0.0);
  loop::Loop orbit = loop::constant_loop(point, place.period, 3);
  const double size = 0.3 * place.arclength;
  const double rate = 2.0 * pi_number / place.period;
  orbit.cosine(1, 0) = size;
  orbit.cosine(1, 1) = 1.4 * size;
  orbit.cosine(3, 1) = 0.1 * size * size;
  orbit.sine(1, 2) = -rate * size;
  orbit.sine(1, 3) = -rate * 1.4 * size;
  orbit.sine(3, 3) = -3.0 * rate * 0.1 * size * size;
  return loop::repeated(orbit, place.times);
}

/// A vector of the kernel. Twice around, angles 0 and 3 pi/4 have the reversors R and RS, multiples of pi/2 are images;
/// three times around, 0 has R, and pi is no image; once around, the second harmonic breaks S and pi is an image.
inline std::vector<double> kernel_vector(const Place& place, double angle) {
  loop::Loop vector = orbit_at(place);
  std::fill(vector.modes.begin(), vector.modes.end(), 0.0);
  const int k = place.times == 1 ? 2 : 1;
  for (const int i : {0, 1}) {
    const double size = i == 0 ? 1.0 : -0.8;
    vector.cosine(k, i) = size * std::cos(angle);
    vector.sine(k, i) = size * std::sin(angle);
    vector.cosine(k, i + 2) = size * std::sin(angle);
    vector.sine(k, i + 2) = -size * std::cos(angle);
  }
  return vector.modes;
}

/// The angle of the direction with this number.
inline double angle_of(int number) { return number == 0 ? 0.0 : 0.75 * pi_number; }

/// An orbit on the way to a place, along one of its directions; started elsewhere and mirrored by S.
inline loop::Loop orbit_near(const Place& place, int number, int side) {
  loop::Loop loop = orbit_at(place);
  const std::vector<double> vector = kernel_vector(place, angle_of(number));
  for (std::size_t n = 0; n < loop.modes.size(); ++n) loop.modes[n] += 0.02 * side * vector[n];
  for (double& v : loop.modes) v = -v;
  return loop::time_shifted(loop, 0.3);
}

inline loop::Isotropy isotropy_numbered(int number) { return {{number == 0 ? "R" : "RS", true, {}, 0, 1}}; }

inline survey::BranchWork base_work(const std::string& key = "0000.0000", const std::string& name = "In-Phase") {
  survey::BranchWork work;
  work.key = work.lineage.family = key;
  work.name = name;
  work.isotropy = {{"S", false, {}, 1, 2}, {"R", true, {}, 0, 1}};
  return work;
}

inline survey::BranchWork work_from(const Place& place, int number, int side = 0) {
  survey::BranchWork work;
  work.key = place.leaving(number) + (side == 0 ? "" : side > 0 ? "+" : "-");
  work.name = "on its way";
  work.lineage = {place.leaving(number), place.key, place.depth + 1, place.times, side < 0 ? -1 : 1};
  work.isotropy = isotropy_numbered(number);
  return work;
}

inline Ended ended(const survey::BranchWork& work, continuation::EndReason reason, double from, double to,
                   int orbits = 10) {
  survey::BranchOutcome outcome;
  outcome.key = work.key;
  outcome.orbits = orbits;
  outcome.period_from = from;
  outcome.period_to = to;
  outcome.end.reason = reason;
  return {task_of(work), {work.key, false, "", {}, pack(outcome), false}};
}

/// A branch that comes to `place` along its direction `number`.
inline Ended arrived(const survey::BranchWork& work, double from, const Place& place, int number, int side = 1) {
  survey::BranchOutcome outcome;
  outcome.key = work.key;
  outcome.orbits = 10;
  outcome.period_from = from;
  outcome.period_to = place.times * place.period;
  outcome.end.reason = continuation::EndReason::stopped;
  const double roughly = 1.0001;  // places of arrivals are extrapolated
  outcome.arrival.push_back({roughly * place.times * place.period, place.energy(), orbit_near(place, number, side)});
  return {task_of(work), {work.key, false, "", {}, pack(outcome), false}};
}

inline Ended failed(Ended branch, const std::string& reason) {
  branch.outcome.failed = true;
  branch.outcome.reason = reason;
  return branch;
}

/// A branch that has failed half way.
inline Ended gave_up(const survey::BranchWork& work, const std::string& reason, double from, double to) {
  Ended branch = ended(work, continuation::EndReason::failure, from, to);
  survey::BranchOutcome outcome = survey::unpack_branch_outcome(branch.outcome.payload);
  outcome.end.detail = reason;
  branch.outcome.payload = pack(outcome);
  return failed(std::move(branch), outcome.end.text());
}

inline Ended start_failed(const survey::BranchWork& work, const std::string& reason) {
  return {task_of(survey::StartWork{work}), {"start " + work.key, true, reason, {}, "", false}};
}

/// The location of a place, with `directions` directions; both sides of each are different where it is three times
/// around.
inline Ended located(const Place& place, int directions = 2) {
  survey::LocateWork work;
  work.key = place.key;
  work.lineage = {place.parent, "", place.depth, 1, 1};
  survey::LocateOutcome outcome;
  outcome.key = place.key;
  outcome.lineage = work.lineage;
  outcome.arclength = place.arclength;
  outcome.period = place.period;
  outcome.energy = place.energy();
  outcome.kind = place.times == 1   ? archive::CrossingKind::branch_point
                 : place.times == 2 ? archive::CrossingKind::period_doubling
                                    : archive::CrossingKind::subharmonic;
  outcome.multiplicity = place.times;
  outcome.kernel_dimension = place.times == 1 ? 1 : 2;
  outcome.state = {0.3 * place.arclength, 0.0, 0.0, 0.0};
  for (int number = 0; number < directions; ++number) {
    survey::LeavingRecord leaving;
    leaving.key = place.leaving(number);
    leaving.isotropy = isotropy_numbered(number);
    leaving.both_sides = place.times == 3;
    leaving.base = orbit_at(place);
    leaving.direction.modes = kernel_vector(place, angle_of(number));
    outcome.leaving.push_back(std::move(leaving));
  }
  return {task_of(work), {"locate " + place.key, false, "", {}, pack(outcome), false}};
}

inline Ended not_located(const Place& place, const std::string& reason) {
  survey::LocateWork work;
  work.key = place.key;
  work.lineage.family = place.parent;
  survey::LocateOutcome outcome;
  outcome.key = place.key;
  return {task_of(work), {"locate " + place.key, true, reason, {}, pack(outcome), false}};
}

}  // namespace orbweaver::test
