#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "orbweaver/survey/run/survey.hpp"
#include "support/uneven_well.hpp"
#include "survey/atlas.hpp"
#include "survey/scenes.hpp"

namespace orbweaver::test {

/// Of a particle in the plane, families from the origin to depth 2 with subharmonics up to 4, unless overrides say
/// otherwise. Expects it to end without a finding, or, where it `may_be_undecided`, without a contradiction or failure.
inline Atlas survey_of(std::shared_ptr<const systems::System> system, const std::vector<std::string>& overrides,
                       bool may_be_undecided = false) {
  const core::Communicator comm;
  std::vector<std::string> all{
      "starts.fixed_points.names={}", "starts.fixed_points.letters={}", "starts.fixed_points.grid=[[0], [0], [0], [0]]",
      "starts.sweep.period=auto",     "survey.subharmonics=4",          "survey.depth=2"};
  all.insert(all.end(), overrides.begin(), overrides.end());
  const scene::Scene scene = scene::load(ORBWEAVER_SOURCE_DIR "/drivers/scenes/henon_heiles.yaml", all);
  const auto folder = fresh_folder(system->info().name, comm.get());
  const survey::Summary summary = survey::run_survey(comm, scene, std::move(system), folder, {});
  EXPECT_EQ(summary.failures, 0U) << testing::PrintToString(summary.failed_tasks);
  for (const survey::FindingSummary& line : summary.findings)
    EXPECT_TRUE(line.severity == survey::Severity::cut ||
                (may_be_undecided && line.severity == survey::Severity::undecided))
        << line.text;
  return Atlas(summary.atlas);
}

inline Atlas survey_of(const std::map<std::string, double>& parameters, const std::vector<std::string>& overrides,
                       bool may_be_undecided = false) {
  return survey_of(uneven_well(parameters), overrides, may_be_undecided);
}

/// A well, by its coefficients from w2 to g.
inline std::map<std::string, double> well(const std::vector<double>& coefficients) {
  std::map<std::string, double> out{{"w1", 1.0}};
  std::size_t n = 0;
  for (const char* name : {"w2", "a", "b", "c", "d", "e", "f", "g"}) out[name] = coefficients.at(n++);
  return out;
}

}  // namespace orbweaver::test
