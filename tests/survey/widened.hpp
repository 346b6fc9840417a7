#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "orbweaver/survey/run/survey.hpp"
#include "survey/atlas.hpp"

namespace orbweaver::test {

/// A survey with narrower limits that goes on with the scene's own stores what one with those does at once, to the
/// byte. `scene_with`: the scene with overrides of its keys.
inline void expect_same_when_widened(const core::Communicator& comm,
                                     const std::function<scene::Scene(std::vector<std::string>)>& scene_with,
                                     const std::vector<std::string>& narrower,
                                     std::shared_ptr<const systems::System> system = {}) {
  const auto survey_in = [&](const std::filesystem::path& folder, const std::vector<std::string>& limits, bool resume) {
    const scene::Scene scene = scene_with(limits);
    survey::RunOptions options;
    options.resume = resume;
    return survey::run_survey(comm, scene, system ? system : scene::bound_system(scene.system), folder, options);
  };
  const std::string ranks = std::to_string(comm.size());
  const auto whole = survey_in(fresh_folder("whole" + ranks, comm.get()), {}, false);
  const auto folder = fresh_folder("widened" + ranks, comm.get());
  EXPECT_EQ(survey_in(folder, narrower, false).failures, 0U);
  const auto widened = survey_in(folder, {}, true);
  EXPECT_EQ(widened.failures, 0U);
  if (!comm.is_root()) return;
  EXPECT_GT(widened.orbits, 0U);
  EXPECT_TRUE(dataset_bytes(widened.atlas) == dataset_bytes(whole.atlas));
}

}  // namespace orbweaver::test
