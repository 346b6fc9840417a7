#include "orbweaver/survey/work.hpp"

#include <fmt/format.h>

#include "orbweaver/core/error.hpp"
#include "payload.hpp"

namespace boost::serialization {

template <class Archive>
void serialize(Archive& archive, orbweaver::survey::SweepWork& w, unsigned) {
  archive& w.index& w.point;
}

template <class Archive>
void serialize(Archive& archive, orbweaver::survey::FoundMode& m, unsigned) {
  archive& m.period& m.direction& m.cutoff& m.isotropy& m.reversing& m.shift_numerators& m.shift_denominators& m
      .one_direction;
}

template <class Archive>
void serialize(Archive& archive, orbweaver::survey::SweepOutcome& o, unsigned) {
  archive& o.index& o.point& o.modes& o.rejected;
}

template <class Archive>
void serialize(Archive& archive, orbweaver::survey::BranchWork& w, unsigned) {
  archive& w.key& w.name& w.point& w.start& w.sign;
}

template <class Archive>
void serialize(Archive& archive, orbweaver::survey::BranchOutcome& o, unsigned) {
  archive& o.key& o.orbits& o.period_from& o.period_to& o.energy_from& o.energy_to& o.last_period& o.last_energy& o
      .last_cutoff& o.end_reason;
}

}  // namespace boost::serialization

namespace orbweaver::survey {

namespace {

constexpr int sweep_priority = 0;
constexpr int branch_priority = 1;

const Eigen::MatrixXd& declared_matrix(const systems::Description& system, const std::string& name, bool reversing) {
  for (const systems::Symmetry& s : reversing ? system.reversors : system.equivariances)
    if (s.name == name) return s.matrix;
  throw core::EnvironmentError(
      fmt::format("a task names the symmetry `{}`, which {} does not declare", name, system.name));
}

}  // namespace

queue::Task task_of(const SweepWork& work) {
  return {fmt::format("sweep.{:04}", work.index), sweep_priority, sweep_kind, pack(work)};
}
queue::Task task_of(const BranchWork& work) { return {work.key, branch_priority, branch_kind, pack(work)}; }

std::string pack(const SweepWork& work) { return to_payload(work); }
std::string pack(const SweepOutcome& outcome) { return to_payload(outcome); }
std::string pack(const BranchWork& work) { return to_payload(work); }
std::string pack(const BranchOutcome& outcome) { return to_payload(outcome); }
SweepWork unpack_sweep_work(const std::string& bytes) { return from_payload<SweepWork>(bytes); }
SweepOutcome unpack_sweep_outcome(const std::string& bytes) { return from_payload<SweepOutcome>(bytes); }
BranchWork unpack_branch_work(const std::string& bytes) { return from_payload<BranchWork>(bytes); }
BranchOutcome unpack_branch_outcome(const std::string& bytes) { return from_payload<BranchOutcome>(bytes); }

void set_isotropy(FoundMode& mode, const loop::Isotropy& isotropy) {
  for (const loop::SymmetryElement& g : isotropy) {
    mode.isotropy.push_back(g.name);
    mode.reversing.push_back(g.reversing ? 1 : 0);
    mode.shift_numerators.push_back(g.shift_numerator);
    mode.shift_denominators.push_back(g.shift_denominator);
  }
}

loop::Isotropy isotropy_of(const FoundMode& mode, const systems::Description& system) {
  loop::Isotropy isotropy;
  for (std::size_t n = 0; n < mode.isotropy.size(); ++n) {
    const bool reversing = mode.reversing.at(n) != 0;
    isotropy.push_back({mode.isotropy[n], reversing, declared_matrix(system, mode.isotropy[n], reversing),
                        mode.shift_numerators.at(n), mode.shift_denominators.at(n)});
  }
  return isotropy;
}

continuation::Start start_of(const BranchWork& work, const systems::Description& system) {
  continuation::Start start;
  start.base = loop::constant_loop(work.point, work.start.period, work.start.cutoff);
  start.direction = work.start.direction;
  for (double& v : start.direction) v *= work.sign;
  start.isotropy = isotropy_of(work.start, system);
  return start;
}

}  // namespace orbweaver::survey
