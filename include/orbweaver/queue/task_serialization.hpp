#pragma once

#include <boost/serialization/level.hpp>
#include <boost/serialization/string.hpp>
#include <boost/serialization/tracking.hpp>
#include <boost/serialization/vector.hpp>

#include "orbweaver/queue/task.hpp"

namespace orbweaver::queue {

/// Boost.Serialization of tasks and outcomes, in messages and in files; whoever writes them writes a version beside them.
template <class Archive>
void serialize(Archive& archive, Task& t, unsigned) {
  archive& t.key& t.priority& t.kind& t.payload& t.state;
}

template <class Archive>
void serialize(Archive& archive, TaskOutcome& o, unsigned) {
  archive& o.key& o.failed& o.stopped& o.reason& o.children& o.payload& o.state;
}

}  // namespace orbweaver::queue

BOOST_CLASS_IMPLEMENTATION(orbweaver::queue::Task, boost::serialization::object_serializable)
BOOST_CLASS_TRACKING(orbweaver::queue::Task, boost::serialization::track_never)
BOOST_CLASS_IMPLEMENTATION(orbweaver::queue::TaskOutcome, boost::serialization::object_serializable)
BOOST_CLASS_TRACKING(orbweaver::queue::TaskOutcome, boost::serialization::track_never)
