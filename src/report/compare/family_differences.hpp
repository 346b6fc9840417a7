#pragma once

#include <map>
#include <string>

#include "compare/family_match.hpp"
#include "orbweaver/report/compare/comparison.hpp"
#include "orbweaver/survey/atlas/loop_check.hpp"

namespace orbweaver::report {

/// Compares what was matched, and adds what it finds to a Comparison.
class FamilyDifferences {
 public:
  FamilyDifferences(const AtlasTree& a, const AtlasTree& b, const TreeMatch& match, const LoopCheck& loops,
                    const CompareOptions& options, Comparison& result)
      : _a(a), _b(b), _match(match), _loops(loops), _options(options), _result(result) {}

  /// All families: first those of A in their order, then those of B alone.
  void run();

 private:
  struct Pair {
    int row_a;
    const TreeFamily& a;
    const TreeFamily& b;
  };

  void compare(const Pair& pair);
  void compare_birth(const Pair& pair);
  void compare_known(const Pair& pair);
  void compare_orbits(const Pair& pair);
  void report_orbits(const Pair& pair, const char* which, const TreeFamily& family, const std::vector<CurveFit>& fits);
  void compare_reach(const Pair& pair, const std::vector<CurveFit>& fits_a, const std::vector<CurveFit>& fits_b);
  void compare_loops(const Pair& pair, const std::vector<CurveFit>& fits);
  void compare_ends(const Pair& pair);
  void compare_crossings(const Pair& pair);
  void compare_places(const Pair& pair, int crossing_a, int crossing_b);
  void add_missing(const AtlasTree& tree, const std::vector<int>& matched, bool is_in_a);

  void add(DifferenceKind kind, const Pair& pair, std::string text, double by = archive::not_computed,
           double allowed = archive::not_computed);
  void note_deviation(const std::string& quantity, double value, double allowed, const std::string& where);

  const AtlasTree& _a;
  const AtlasTree& _b;
  const TreeMatch& _match;
  const LoopCheck& _loops;
  const CompareOptions& _options;
  Comparison& _result;
};

}  // namespace orbweaver::report
