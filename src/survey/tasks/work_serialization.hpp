#pragma once

#include <boost/serialization/string.hpp>
#include <boost/serialization/vector.hpp>

#include "orbweaver/survey/tasks/work.hpp"

namespace boost::serialization {

using namespace orbweaver::survey;

template <class Archive>
void serialize(Archive& archive, LoopRecord& r, unsigned) {
  archive& r.dimension& r.cutoff& r.period& r.modes& r.winding& r.time_map;
}

template <class Archive>
void serialize(Archive& archive, IsotropyRecord& r, unsigned) {
  archive& r.names& r.reversing& r.shift_numerators& r.shift_denominators;
}

template <class Archive>
void serialize(Archive& archive, SweepWork& w, unsigned) {
  archive& w.index& w.point;
}

template <class Archive>
void serialize(Archive& archive, FoundMode& m, unsigned) {
  archive& m.period& m.direction& m.cutoff& m.isotropy& m.one_direction;
}

template <class Archive>
void serialize(Archive& archive, SweepOutcome& o, unsigned) {
  archive& o.index& o.point& o.modes& o.rejected;
}

template <class Archive>
void serialize(Archive& archive, Lineage& l, unsigned) {
  archive& l.family& l.crossing& l.depth& l.multiplicity& l.side;
}

template <class Archive>
void serialize(Archive& archive, BranchWork& w, unsigned) {
  archive& w.key& w.name& w.lineage& w.base& w.direction& w.isotropy& w.amplitude;
}

template <class Archive>
void serialize(Archive& archive, ArrivalRecord& a, unsigned) {
  archive& a.period& a.energy& a.near;
}

template <class Archive>
void serialize(Archive& archive, orbweaver::continuation::Ending& e, unsigned) {
  archive& e.reason& e.detail;
}

template <class Archive>
void serialize(Archive& archive, StartOutcome& o, unsigned) {
  archive& o.limited_by;
}

template <class Archive>
void serialize(Archive& archive, BranchOutcome& o, unsigned) {
  archive& o.key& o.orbits& o.period_from& o.period_to& o.energy_from& o.energy_to& o.last_period& o.last_energy& o
      .last_cutoff& o.end& o.arrival& o.remarks& o.limited_by& o.before_limit;
}

template <class Archive>
void serialize(Archive& archive, KnownOrbit& k, unsigned) {
  archive& k.position& k.loop;
}

template <class Archive>
void serialize(Archive& archive, LocateWork& w, unsigned) {
  archive& w.key& w.name& w.lineage& w.isotropy& w.known& w.before_first& w.event& w.function& w.q& w.j& w.tangency& w
      .from& w.to;
}

template <class Archive>
void serialize(Archive& archive, LeavingRecord& r, unsigned) {
  archive& r.key& r.isotropy& r.both_sides& r.base& r.direction;
}

template <class Archive>
void serialize(Archive& archive, LocateOutcome& o, unsigned) {
  bool crosses = o.kind.has_value();
  archive& crosses;
  if (crosses && !o.kind) o.kind.emplace();
  if (crosses) archive&* o.kind;
  archive& o.key& o.lineage& o.arclength& o.period& o.energy& o.multiplicity& o.kernel_dimension& o.residual& o
      .kernel_singular_value& o.next_singular_value& o.test_value& o.state& o.q& o.j& o.fundamental_order& o.leaving& o
      .remark& o.limited_by;
}

template <class Archive>
void serialize(Archive& archive, StartWork& w, unsigned) {
  archive& w.branch;
}

}  // namespace boost::serialization
