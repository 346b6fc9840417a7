#pragma once

#include <boost/serialization/level.hpp>
#include <boost/serialization/string.hpp>
#include <boost/serialization/tracking.hpp>
#include <boost/serialization/vector.hpp>

#include "orbweaver/queue/message.hpp"
#include "orbweaver/queue/task_serialization.hpp"

namespace orbweaver::queue {

template <class Archive>
void serialize(Archive& archive, Progress& p, unsigned) {
  archive& p.step& p.rows& p.values;
}

template <class Archive>
void serialize(Archive& archive, Hello& m, unsigned) {
  archive& m.version;
}

template <class Archive>
void serialize(Archive& archive, Assign& m, unsigned) {
  archive& m.task;
}

template <class Archive>
void serialize(Archive& archive, Outcome& m, unsigned) {
  archive& m.outcome& m.rows;
}

template <class Archive>
void serialize(Archive& archive, ProgressReport& m, unsigned) {
  archive& m.key& m.progress;
}

template <class Archive>
void serialize(Archive& archive, FlushRequest& m, unsigned) {
  archive& m.number;
}

template <class Archive>
void serialize(Archive& archive, FlushReady& m, unsigned) {
  archive& m.number& m.rows& m.state;
}

template <class Archive>
void serialize(Archive& archive, FlushGo& m, unsigned) {
  archive& m.number;
}

template <class Archive>
void serialize(Archive& archive, FlushDone& m, unsigned) {
  archive& m.number& m.error;
}

template <class Archive>
void serialize(Archive&, Stop&, unsigned) {}

template <class Archive>
void serialize(Archive& archive, Alarm& m, unsigned) {
  archive& m.error;
}

template <class Archive>
void serialize(Archive& archive, Shutdown& m, unsigned) {
  archive& m.error& m.done& m.failed& m.waiting& m.stopped& m.stopped_early& m.flushes& m.rows& m.seconds;
}

template <class Archive>
void serialize(Archive& archive, Goodbye& m, unsigned) {
  archive& m.tasks& m.busy_seconds;
}

template <class Archive>
void serialize(Archive& archive, EndTask& m, unsigned) {
  archive& m.key;
}

}  // namespace orbweaver::queue

// The envelope carries the version, and nothing is shared by pointer: Boost need not write class information.
#define ORBWEAVER_QUEUE_PLAIN(type)                                                             \
  BOOST_CLASS_IMPLEMENTATION(orbweaver::queue::type, boost::serialization::object_serializable) \
  BOOST_CLASS_TRACKING(orbweaver::queue::type, boost::serialization::track_never)

ORBWEAVER_QUEUE_PLAIN(Progress)
ORBWEAVER_QUEUE_PLAIN(Hello)
ORBWEAVER_QUEUE_PLAIN(Assign)
ORBWEAVER_QUEUE_PLAIN(Outcome)
ORBWEAVER_QUEUE_PLAIN(ProgressReport)
ORBWEAVER_QUEUE_PLAIN(FlushRequest)
ORBWEAVER_QUEUE_PLAIN(FlushReady)
ORBWEAVER_QUEUE_PLAIN(FlushGo)
ORBWEAVER_QUEUE_PLAIN(FlushDone)
ORBWEAVER_QUEUE_PLAIN(Stop)
ORBWEAVER_QUEUE_PLAIN(Alarm)
ORBWEAVER_QUEUE_PLAIN(Shutdown)
ORBWEAVER_QUEUE_PLAIN(Goodbye)
ORBWEAVER_QUEUE_PLAIN(EndTask)

#undef ORBWEAVER_QUEUE_PLAIN
