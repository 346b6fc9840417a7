// Wells without symmetry but time reversal, drawn by lot: the tree hangs neither on where first orbits lie nor on how
// long steps are.
#include <cstdint>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "survey/same_tree.hpp"
#include "survey/surveyed_well.hpp"

namespace wells_by_lot_test {
namespace {

using namespace orbweaver;

/// The same numbers with every library: those of std::uniform_real_distribution are not.
class Lot {
 public:
  double between(double from, double to) {
    _state = _state * 6364136223846793005U + 1442695040888963407U;
    return from + (to - from) * static_cast<double>(_state >> 11U) * 0x1p-53;
  }

 private:
  std::uint64_t _state = 20261126;
};

TEST(WellsByLot, HaveOneTreeWhereverFirstOrbitsLieAndHoweverLongStepsAre) {
  Lot lot;
  for (int n = 0; n < 16; ++n) {
    std::vector<double> coefficients{lot.between(0.7, 1.4)};  // w2
    for (int cubic = 0; cubic < 4; ++cubic) coefficients.push_back(lot.between(-0.5, 0.5));
    coefficients.push_back(lot.between(0.3, 0.8));  // e
    coefficients.push_back(lot.between(3.0, 5.0));  // f
    coefficients.push_back(lot.between(0.2, 1.3));  // g
    const std::string energy = fmt::format("limits.energy=[-.inf, {}]", lot.between(0.8, 2.0));
    const auto with = [&](const std::string& key) {
      return test::survey_of(test::well(coefficients), {energy, "limits.period=26", "continuation." + key}, true);
    };
    const test::Atlas usual = with("start=0.0087");
    EXPECT_GT(usual.crossings().rows(), 0U);
    for (const std::string key : {"start=0.0436", "step=0.25"}) {
      SCOPED_TRACE(fmt::format("well {}: {}, {}", n, testing::PrintToString(coefficients), key));
      test::expect_same_tree(usual, with(key));
    }
  }
}

}  // namespace
}  // namespace wells_by_lot_test
