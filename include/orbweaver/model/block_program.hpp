#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <span>
#include <vector>

#include "orbweaver/model/graph.hpp"

namespace orbweaver::model {

/// One operation over a block of states; its name says whether an operand is a register (v) or a scalar (s).
enum class Step : std::uint8_t {
  fill,  ///< scalar a
  copy,
  add_vv,
  add_vs,
  subtract_vv,
  subtract_vs,
  subtract_sv,
  multiply_vv,
  multiply_vs,
  divide_vv,
  divide_vs,
  divide_sv,
  product_plus_vv,   ///< a b + c, rounded once; the next ones too
  product_plus_vs,   ///< scalar b
  product_minus_vv,  ///< a b - c
  product_minus_vs,
  less_product_vv,  ///< c - a b
  less_product_vs,
  negate,
  sqrt,
  exp,
  log,
  sine,
  cosine,
  sine_and_cosine,  ///< into `result` and `b`
  tanh,
  slope,  ///< 1 - a^2
  asin,
  acos,
  atan,
  erf,
};

struct Instruction {
  Step step;
  std::int32_t result;  ///< register
  std::int32_t a;
  std::int32_t b;
  std::int32_t c = 0;
};

/// Nodes of a graph in double precision at many states: each operation runs over a block of states before the next, in
/// vectors as wide as the processor has. A state's bits depend neither on the other states nor on its place among them
/// nor on that width: a product that one sum alone asks for is rounded with it, and functions are the kernels' own,
/// after fdlibm and Cephes.
class BlockProgram {
 public:
  BlockProgram(const Graph& graph, std::span<const int> outputs);

  /// What depends on parameters only, from their values: computed once for many runs.
  [[nodiscard]] std::vector<double> scalars(std::span<const double> parameters) const;

  /// Writes output k at state j to outputs[k][j], from input i at state j at inputs[i][j]. Outputs overlap nothing.
  void run(std::span<const double> scalars, std::size_t states, std::span<const double* const> inputs,
           std::span<double* const> outputs) const;

  /// The same at one state, for integrators: inputs in a row, outputs in rows behind one another.
  void run_one(std::span<const double> scalars, std::span<const double> inputs,
               std::initializer_list<std::span<double>> outputs) const;

  /// Operations a state.
  [[nodiscard]] std::size_t operations() const { return _code.size(); }

 private:
  class Compiler;

  std::size_t _inputs = 0;  // rows needed: the largest number of an input, and one
  std::size_t _outputs = 0;
  std::size_t _registers = 0;      // inputs, outputs and what lies between
  std::vector<double> _constants;  // the first scalars; parameters and what is computed from both follow
  std::size_t _parameters = 0;
  std::vector<Instruction> _fixed;  // its registers are scalars
  std::size_t _scalars = 0;
  std::vector<Instruction> _code;
};

/// Bits of the vectors in which blocks are computed: 128, 256 or 512; what the processor has at most, or less as the
/// environment's ORBWEAVER_VECTOR_BITS says.
[[nodiscard]] int vector_bits();

}  // namespace orbweaver::model
