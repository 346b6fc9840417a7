// Its session logs (-log_view of the main below), so that stages and events can be read back from PETSc.
#include <chrono>
#include <stdexcept>
#include <thread>

#include <gmock/gmock.h>
#include <petsclog.h>

#include "orbweaver/core/log/log_stage.hpp"
#include "orbweaver/core/petsc/check.hpp"
#include "orbweaver/core/petsc/session.hpp"

namespace {

using namespace orbweaver::core;

PetscLogStage current() {
  PetscStageLog log = nullptr;
  check(PetscLogGetStageLog(&log), "PetscLogGetStageLog");
  PetscLogStage stage = -1;
  check(PetscStageLogGetCurrent(log, &stage), "PetscStageLogGetCurrent");
  return stage;
}

PetscLogStage id_of(const char* name) {
  PetscLogStage id = -1;
  check(PetscLogStageGetId(name, &id), "PetscLogStageGetId");
  return id;
}

PetscEventPerfInfo info_of(const char* stage, const char* event) {
  PetscLogEvent id = -1;
  check(PetscLogEventGetId(event, &id), "PetscLogEventGetId");
  PetscEventPerfInfo info{};
  check(PetscLogEventGetPerfInfo(id_of(stage), id, &info), "PetscLogEventGetPerfInfo");
  return info;
}

double seconds_of(const char* stage) {
  PetscStageLog log = nullptr;
  check(PetscLogGetStageLog(&log), "PetscLogGetStageLog");
  return log->stageInfo[id_of(stage)].perfInfo.time;
}

void spend_milliseconds(int n) { std::this_thread::sleep_for(std::chrono::milliseconds(n)); }

TEST(LogStage, EveryStageAndEventIsRegisteredUnderItsName) {
  for (const char* name : {"Sweep", "Continuation", "Corrector", "Spectrum", "Certificate", "Archive", "Queue wait"})
    EXPECT_GE(id_of(name), 0) << name;
  const LogStage stage(Stage::queue_wait);
  EXPECT_EQ(current(), id_of("Queue wait"));
}

TEST(LogStage, StagesNestAndTimeCountsForTheInnermost) {
  const PetscLogStage main_stage = current();
  {
    const LogStage outer(Stage::continuation);
    EXPECT_EQ(current(), id_of("Continuation"));
    spend_milliseconds(20);
    for (int n = 0; n < 2; ++n) {
      const LogStage inner(Stage::corrector);
      const LogStage again(Stage::corrector);
      EXPECT_EQ(current(), id_of("Corrector"));
      spend_milliseconds(50);
    }
    EXPECT_EQ(current(), id_of("Continuation"));
  }
  EXPECT_EQ(current(), main_stage);
  EXPECT_GE(seconds_of("Corrector"), 0.1);
  EXPECT_GE(seconds_of("Continuation"), 0.02);
  EXPECT_LT(seconds_of("Continuation"), seconds_of("Corrector"));
}

TEST(LogStage, AnExceptionLeavesItsStagesAndEvents) {
  const PetscLogStage before = current();
  try {
    const LogStage stage(Stage::archive);
    const LogEvent event(Event::assembly);
    throw std::runtime_error("in the middle");
  } catch (const std::runtime_error&) {
  }
  EXPECT_EQ(current(), before);
  EXPECT_EQ(info_of("Archive", "LoopAssembly").depth, 0);
  EXPECT_EQ(info_of("Archive", "LoopAssembly").count, 1);
}

TEST(LogEvent, CountsWithinItsStage) {
  const LogStage stage(Stage::spectrum);
  for (int n = 0; n < 3; ++n) {
    const LogEvent event(Event::multipliers);
    spend_milliseconds(5);
  }
  const PetscEventPerfInfo info = info_of("Spectrum", "Multipliers");
  EXPECT_EQ(info.count, 3);
  EXPECT_GE(info.time, 0.015);
  EXPECT_EQ(info_of("Corrector", "Multipliers").count, 0);
}

TEST(LogStage, WithoutASessionOrALogItDoesNothing) {
  const detail::Log kept = detail::log;
  detail::log = detail::no_log;
  const PetscLogStage before = current();
  const LogStage stage(Stage::sweep);
  const LogEvent event(Event::field);
  EXPECT_EQ(current(), before);
  detail::log = kept;
}

}  // namespace

int main(int argc, char** argv) {
  const Session session({"-log_view", "ascii:log_view.txt"});
  ::testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
