#pragma once

#include <limits>
#include <string>
#include <vector>

#include "orbweaver/continuation/branch.hpp"
#include "orbweaver/equations/collocation.hpp"
#include "point_problem.hpp"

/// What an answer of the solver on the fundamental domain is worth.
namespace orbweaver::continuation {

/// The tolerance on sqrt(loss) to which the way is solved where the scene's is larger: a scene's tolerance may decide
/// how well an orbit is resolved, but not on which side of a narrow gap the branch goes on, nor how far beside the
/// family a step begins (a residual of 6e-9 was seen to leave 2.6e-5 where an index is 2 to 1e-6). The default.
inline constexpr double of_the_way = 1e-10;
/// Roundings of a mode, some of the transforms' own: their number was not measured.
inline constexpr double mode_rounding = 4.0 * std::numeric_limits<double>::epsilon();
/// Where the field is finite, and what the correction made of it is not.
inline constexpr const char* beyond_numbers = "the correction met numbers that are not finite";

/// Accepts a trial by the loss over the whole loop, and says what of it is the equations', truncation's and rounding's.
void judge(const equations::Collocation& equations, const std::vector<double>& winding, const Options& options,
           Trial& trial);

/// Whether more harmonics would not help a judged trial. Sets its loop.
[[nodiscard]] bool is_resolved(const equations::Collocation& equations, const Options& options, Trial& trial);

/// Whether the equations hold to rounding where they ask.
[[nodiscard]] bool holds_to_rounding(const equations::Collocation& equations, const std::vector<double>& values);

/// The sentence that the loss has for a field that is not finite, there or at what was predicted; `otherwise` where it
/// is.
[[nodiscard]] std::string not_finite_at(const equations::Collocation& equations, const std::vector<double>& values,
                                        const std::vector<double>& predicted, const std::string& otherwise);

}  // namespace orbweaver::continuation
