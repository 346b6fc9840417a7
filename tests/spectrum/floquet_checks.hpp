#pragma once

#include <complex>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "orbweaver/continuation/branch.hpp"
#include "orbweaver/loop/symmetry/isotropy.hpp"
#include "orbweaver/systems/system.hpp"

namespace orbweaver::test {

/// An index, or multiplier, is what it must be, within its own bound as well, which says something.
inline void expect_value(std::complex<double> value, double error, std::complex<double> truth, double relative) {
  EXPECT_LE(std::abs(value - truth), relative * std::abs(truth)) << value << " instead of " << truth;
  EXPECT_LE(std::abs(value - truth), error) << value << " instead of " << truth;
  EXPECT_LE(error, 1e-9 * (1.0 + std::abs(truth))) << "the bound says nothing";
}

inline std::vector<continuation::Orbit> orbits_of(const std::shared_ptr<const systems::System>& system,
                                           const continuation::Start& start, const continuation::Options& options) {
  std::vector<continuation::Orbit> orbits;
  (void)continuation::trace(system, start, options, [&](const continuation::Orbit& orbit) {
    orbits.push_back(orbit);
    return true;
  });
  return orbits;
}

}  // namespace orbweaver::test
