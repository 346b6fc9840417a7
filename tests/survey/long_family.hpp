#pragma once

#include <cstdio>
#include <string>

#include <gtest/gtest.h>

#include "orbweaver/core/mpi/communicator.hpp"
#include "survey/atlas.hpp"

namespace orbweaver::test {

struct LongFamily {
  std::string tolerance = "1e-10";
  std::string first = "0.01";
  std::string y = "0.866";
  std::string limit = "120";  ///< of the period: at 83 a step over the gap would end on it, on another family
};

/// Henrard 1970 and 2002 have the long-period family at mu = 0.001 end on an orbit of the short-period family gone
/// around 13 times; the short orbit of that resonance was located on the short-period family itself. On the way a
/// narrow gap must not be stepped over: the family turns there, at T = 82.0097.
inline void expect_long_family_to_end(const core::Communicator& comm, const LongFamily& with) {
  constexpr double short_period = 6.289847916;
  constexpr double energy = -1.234482545;
  SCOPED_TRACE(with.tolerance + " " + with.first + " " + with.y + " " + with.limit);
  const scene::Scene scene =
      scene::load(ORBWEAVER_SOURCE_DIR "/drivers/scenes/pcr3bp_mu_0.001.yaml",
                  {"continuation.start=" + with.first, "continuation.tolerance=" + with.tolerance,
                   "starts.fixed_points.grid=[[0.499], [" + with.y + "]]", "starts.sweep.period=[70, 80]",
                   "starts.sweep.step=0.1", "survey.depth=0", "limits.period=" + with.limit});
  const survey::Summary summary = run(comm, scene, "long");
  if (!comm.is_root()) return;
  EXPECT_EQ(summary.failures, 0U);
  ASSERT_EQ(summary.families.size(), 1U);
  const std::string& end = summary.families.front().end_reason;
  double period = 0.0;
  double found = 0.0;
  double once = 0.0;
  ASSERT_EQ(std::sscanf(end.c_str(), "met a family of more symmetry (T = %lf, E = %lf, 13 times around T = %lf",
                        &period, &found, &once),
            3)
      << end;
  EXPECT_NEAR(period, 13 * short_period, 13e-9);
  EXPECT_NEAR(once, short_period, 1e-9);
  EXPECT_NEAR(found, energy, 1e-9);
  EXPECT_NEAR(summary.families.front().period_to, 82.0097, 1e-4);
}

}  // namespace orbweaver::test
