#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "compare/family_match.hpp"
#include "orbweaver/report/compare/comparison.hpp"
#include "orbweaver/survey/atlas/loop_check.hpp"

namespace orbweaver::report {

/// "E", or the name of the parameter that moves.
[[nodiscard]] std::string level_name(const AtlasTree& tree);
/// "T = 8.2, E = 1.5".
[[nodiscard]] std::string orbit_text(const AtlasTree& tree, const TreeFamily& family, std::size_t orbit);

/// Where the orbits of a family lie on the curve of the one that it was matched with, where their numbers do not tell.
class OrbitPlaces {
 public:
  struct Of {
    const AtlasTree& tree;
    const TreeFamily& family;
  };

  OrbitPlaces(const Of& own, const Of& other, const LoopCheck& loops, const CompareOptions& options, Comparison& result)
      : _own(own), _other(other), _loops(loops), _options(options), _result(result) {}

  /// Puts on the curve those of the orbits off it (`fits`, one an orbit of its own family) whose loops lie there, or
  /// which nothing tells; the latter are noted in the comparison.
  void settle(std::vector<CurveFit>& fits);

 private:
  void decide_by_loops(std::vector<CurveFit>& fits);
  void leave_out_nearer_to_birth(std::vector<CurveFit>& fits);
  void leave_out_undecided(std::vector<CurveFit>& fits);

  Of _own;
  Of _other;
  const LoopCheck& _loops;
  const CompareOptions& _options;
  Comparison& _result;
};

}  // namespace orbweaver::report
