#include "branch_state.hpp"

#include "orbweaver/queue/task_serialization.hpp"
#include "tasks/payload.hpp"
#include "tasks/work_serialization.hpp"

namespace boost::serialization {

using namespace orbweaver;

template <class Archive>
void serialize(Archive& archive, loop::TimeMap& m, unsigned) {
  archive& m.kappa& m.coefficients;
}

template <class Archive>
void serialize(Archive& archive, loop::Loop& l, unsigned) {
  archive& l.dimension& l.cutoff& l.period& l.modes& l.winding& l.time_map;
}

template <class Archive>
void serialize(Archive& archive, continuation::Orbit& o, unsigned) {
  archive& o.loop& o.step& o.arclength& o.energy& o.action& o.loss_rms& o.tail& o.iterations& o.off_branch_eigenvalue;
}

template <class Archive>
void serialize(Archive& archive, continuation::TracePoint& p, unsigned) {
  archive& p.values& p.parameter;
}

template <class Archive>
void serialize(Archive& archive, continuation::Resolution& r, unsigned) {
  archive& r.size& r.time_map;
}

template <class Archive>
void serialize(Archive& archive, continuation::ProblemState& s, unsigned) {
  archive& s.resolution& s.amplitude& s.factor_point& s.factor_conditions;
}

template <class Archive>
void serialize(Archive& archive, continuation::Frontier& f, unsigned) {
  archive& f.orbit& f.tangent& f.next_length& f.last_increment& f.first& f.first_energy& f.first_amplitude& f
      .earlier_energy& f.earlier_period& f.farthest& f.on_energy_limit& f.points& f.problem;
}

template <class Archive>
void serialize(Archive& archive, continuation::FamilyCurve::Known& k, unsigned) {
  archive& k.position& k.loop;
}

template <class Archive>
void serialize(Archive& archive, bifurcation::Reading& r, unsigned) {
  archive& r.value& r.error;
}

template <class Archive>
void serialize(Archive& archive, bifurcation::Station& s, unsigned) {
  archive& s.position& s.readings;
}

template <class Archive>
void serialize(Archive& archive, bifurcation::DetectorState::Node& n, unsigned) {
  archive& n.position& n.reading;
}

template <class Archive>
void serialize(Archive& archive, bifurcation::DetectorState::Watch& w, unsigned) {
  bool has_undecided = w.undecided.has_value();
  archive& w.signed_nodes& has_undecided;
  if (has_undecided && !w.undecided) w.undecided.emplace();
  if (has_undecided) archive&* w.undecided;
  archive& w.scale& w.examined_to;
}

template <class Archive>
void serialize(Archive& archive, bifurcation::DetectorState& s, unsigned) {
  archive& s.stations& s.watches;
}

template <class Archive>
void serialize(Archive& archive, bifurcation::FoldWatch::Turn& t, unsigned) {
  archive& t.before& t.position& t.value& t.scale& t.direction;
}

template <class Archive>
void serialize(Archive& archive, bifurcation::FoldWatch& w, unsigned) {
  archive& w.period& w.energy;
}

template <class Archive>
void serialize(Archive& archive, survey::BranchState& s, unsigned) {
  archive& s.frontier& s.known& s.detector& s.folds& s.last& s.before_first& s.events& s.outcome& s.children;
}

}  // namespace boost::serialization

namespace orbweaver::survey {

std::string pack(const BranchState& state) { return to_payload(state); }
BranchState unpack_branch_state(const std::string& bytes) { return from_payload<BranchState>(bytes); }

}  // namespace orbweaver::survey
