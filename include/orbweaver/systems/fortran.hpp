#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "orbweaver/model/graph.hpp"

namespace orbweaver::systems {

/// A double as Fortran 90 reads it back: (1.00000000000000006e-01) with the exponent's letter d.
[[nodiscard]] std::string fortran_literal(double value);

/// What computes some nodes of a graph in Fortran 90.
struct FortranCode {
  std::vector<std::string> lines;    ///< "v(1)=U(1)*PAR(2)", one an operation: v is an array of doubles from 1 on
  std::vector<std::string> results;  ///< what the outputs then are: "v(7)", or an input
};
/// `input` and `parameter`: the texts of those, by their numbers in the graph. Only what the outputs need is computed.
[[nodiscard]] FortranCode fortran_code(const model::Graph& graph, std::span<const int> outputs,
                                       const std::function<std::string(int)>& input,
                                       const std::function<std::string(int)>& parameter);

}  // namespace orbweaver::systems
