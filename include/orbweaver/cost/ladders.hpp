#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "orbweaver/core/mpi/communicator.hpp"
#include "orbweaver/cost/table.hpp"
#include "orbweaver/scene/scene.hpp"

namespace orbweaver::cost {

/// What to measure, and how long.
struct Options {
  std::string family;             ///< its name; empty: the scene's first
  std::vector<std::string> only;  ///< names of ladders; empty: all
  bool quick = false;             ///< fewer rungs, fewer repetitions
};

/// The ladders that there are: name and what each measures.
struct LadderInfo {
  std::string_view name;
  std::string_view about;
};
[[nodiscard]] std::vector<LadderInfo> known_ladders();

/// Measures on the scene's own families (docs/accuracy.md) and hands over each table as it is done, on rank 0.
/// Collective over `comm`: other ranks than 0 take part in the ladder `ranks` only. Throws InputError for a scene
/// that cannot be surveyed, a family or a ladder that there is not, or a system that cannot be refined. What is thrown,
/// by `take` too, is thrown on all ranks.
void measure(const core::Communicator& comm, const scene::Scene& scene, const Options& options,
             const std::function<void(const Table&)>& take);

}  // namespace orbweaver::cost
