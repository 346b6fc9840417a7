#include "orbweaver/model/block_program.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>

#include "block_kernels.hpp"
#include "orbweaver/core/error.hpp"

namespace orbweaver::model {

namespace {

/// States a block: what lies between stays in the first cache, and an operation's dispatch costs little beside it.
constexpr std::size_t block = 64;
/// A vector of every width divides it.
constexpr std::size_t granule = 8;

BlockKernel kernel() {
#if defined(__x86_64__)
  switch (vector_bits()) {
    case 512: return run_in_512_bits;
    case 256: return run_in_256_bits;
    default: break;
  }
#endif
  return run_in_128_bits;
}

bool is_binary(Operation operation) { return operation >= Operation::add && operation <= Operation::divide; }

Step unary(Operation operation) {
  switch (operation) {
    case Operation::negate: return Step::negate;
    case Operation::sqrt: return Step::sqrt;
    case Operation::exp: return Step::exp;
    case Operation::sine: return Step::sine;
    case Operation::cosine: return Step::cosine;
    case Operation::tanh: return Step::tanh;
    case Operation::slope: return Step::slope;
    case Operation::log: return Step::log;
    case Operation::asin: return Step::asin;
    case Operation::acos: return Step::acos;
    case Operation::atan: return Step::atan;
    case Operation::erf: return Step::erf;
    default: break;
  }
  core::require(false, "an operation of one operand");
  return Step::copy;
}

/// Of registers alone, of a register and a scalar, of a scalar and a register.
struct Forms {
  Step vv;
  Step vs;
  Step sv;
};

Forms binary(Operation operation) {
  switch (operation) {
    case Operation::add: return {Step::add_vv, Step::add_vs, Step::add_vs};
    case Operation::subtract: return {Step::subtract_vv, Step::subtract_vs, Step::subtract_sv};
    case Operation::multiply: return {Step::multiply_vv, Step::multiply_vs, Step::multiply_vs};
    default: return {Step::divide_vv, Step::divide_vs, Step::divide_sv};
  }
}

/// Registers of this thread: a table of its own rows, and one whose first rows are the caller's.
class Workspace {
 public:
  void reserve(std::size_t registers) {
    if (registers <= _own.size()) return;
    _space.resize(registers * block);
    _own.resize(registers);
    for (std::size_t n = 0; n < registers; ++n) _own[n] = _space.data() + n * block;
    _direct = _own;
  }
  [[nodiscard]] double* const* own() const { return _own.data(); }
  /// The first `callers` of `registers` rows are to be set.
  [[nodiscard]] double** direct(std::size_t callers, std::size_t registers) {
    std::copy(_own.begin() + static_cast<std::ptrdiff_t>(callers),
              _own.begin() + static_cast<std::ptrdiff_t>(registers),
              _direct.begin() + static_cast<std::ptrdiff_t>(callers));
    return _direct.data();
  }

 private:
  std::vector<double> _space;
  std::vector<double*> _own;
  std::vector<double*> _direct;
};

}  // namespace

int vector_bits() {
  static const int bits = [] {
    int most = 128;
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx2")) most = 256;
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq")) most = 512;
#endif
    const char* const asked = std::getenv("ORBWEAVER_VECTOR_BITS");
    const std::string given = asked == nullptr ? "" : asked;
    for (const int one : {128, 256, 512})
      if (given == std::to_string(one)) most = std::min(most, one);
    return most;
  }();
  return bits;
}

double far_sine(double x) { return std::sin(x); }
double far_cosine(double x) { return std::cos(x); }
double error_function(double x) { return std::erf(x); }

/// Gives nodes their places: scalars to what depends on parameters only, registers to the rest, used again when what
/// they hold is needed no more.
class BlockProgram::Compiler {
 public:
  Compiler(const Graph& graph, std::span<const int> outputs, BlockProgram& program)
      : _graph(graph),
        _program(program),
        _place(graph.nodes().size(), -1),
        _moves(graph.nodes().size(), false),
        _done(_moves) {
    _needed = needed_for(graph, outputs);
    for (std::size_t n = 0; n < _needed.size(); ++n)
      if (_needed[n] && graph.nodes()[n].operation == Operation::slope) _needed[n - 1] = true;
    find_fused(outputs);
    place_leaves(outputs.size());
    place_fixed();
    place_moving(outputs);
  }

 private:
  [[nodiscard]] const Node& node(std::size_t n) const { return _graph.nodes()[n]; }
  int& place(int n) { return _place[static_cast<std::size_t>(n)]; }
  [[nodiscard]] bool moves(int n) const { return _moves[static_cast<std::size_t>(n)]; }
  /// A slope's operand is the tanh before it.
  [[nodiscard]] int first(std::size_t n) const {
    return node(n).operation == Operation::slope ? static_cast<int>(n) - 1 : node(n).first;
  }

  /// Whether a product is one with a power of two: then it is as well rounded by itself.
  [[nodiscard]] bool is_exact(const Node& product) const {
    const auto is_power_of_two = [&](int n) {
      int exponent = 0;
      return _graph.is_constant(n) && std::abs(std::frexp(_graph.node(n).value, &exponent)) == 0.5;
    };
    return is_power_of_two(product.first) || is_power_of_two(product.second);
  }
  /// Products of two things that move, or of one and a scalar, that one sum or difference alone asks for: which.
  void find_fused(std::span<const int> outputs) {
    std::vector<int> uses(_needed.size(), 0);
    for (const int output : outputs) ++uses[static_cast<std::size_t>(output)];
    for (std::size_t n = 0; n < _needed.size(); ++n) {
      if (!_needed[n] || is_leaf(node(n).operation)) continue;
      ++uses[static_cast<std::size_t>(first(n))];
      if (is_binary(node(n).operation)) ++uses[static_cast<std::size_t>(node(n).second)];
    }
    _fused.assign(_needed.size(), -1);
    for (std::size_t n = 0; n < _needed.size(); ++n) {
      if (!_needed[n]) continue;
      const Operation operation = node(n).operation;
      if (operation != Operation::add && operation != Operation::subtract) continue;
      for (const bool exact : {false, true})
        for (const int product : {node(n).first, node(n).second}) {
          const auto at = static_cast<std::size_t>(product);
          const bool is_free = node(at).operation == Operation::multiply && uses[at] == 1 && _fused[n] < 0;
          if (is_free && is_exact(node(at)) == exact) _fused[n] = product;
        }
    }
  }
  /// The product that the node takes in, if it is one that moves, as its other operand does.
  [[nodiscard]] int taken_in(std::size_t n) const {
    const int product = _fused[n];
    if (product < 0 || !moves(product)) return -1;
    return moves(product == node(n).first ? node(n).second : node(n).first) ? product : -1;
  }

  void place_leaves(std::size_t outputs) {
    for (std::size_t n = 0; n < _needed.size(); ++n) {
      if (!_needed[n]) continue;
      const Node& own = node(n);
      const auto number = static_cast<std::size_t>(own.first);
      if (own.operation == Operation::input) _program._inputs = std::max(_program._inputs, number + 1);
      if (own.operation == Operation::parameter) _program._parameters = std::max(_program._parameters, number + 1);
      if (own.operation != Operation::constant) continue;
      _place[n] = static_cast<int>(_program._constants.size());
      _program._constants.push_back(own.value);
    }
    _program._outputs = outputs;
    for (std::size_t n = 0; n < _needed.size(); ++n) {
      if (!_needed[n]) continue;
      if (node(n).operation == Operation::input) _place[n] = node(n).first;
      if (node(n).operation == Operation::parameter)
        _place[n] = static_cast<int>(_program._constants.size()) + node(n).first;
      _moves[n] = node(n).operation == Operation::input;
      if (is_leaf(node(n).operation)) continue;
      _moves[n] = moves(first(n)) || (is_binary(node(n).operation) && moves(node(n).second));
    }
  }

  void place_fixed() {
    _program._scalars = _program._constants.size() + _program._parameters;
    for (std::size_t n = 0; n < _needed.size(); ++n) {
      if (!_needed[n] || _moves[n] || is_leaf(node(n).operation)) continue;
      _place[n] = static_cast<int>(_program._scalars++);
      const bool two = is_binary(node(n).operation);
      _program._fixed.push_back({two ? binary(node(n).operation).vv : unary(node(n).operation), _place[n],
                                 place(first(n)), two ? place(node(n).second) : 0});
    }
  }

  void place_moving(std::span<const int> outputs) {
    const auto first_output = static_cast<int>(_program._inputs);
    _registers = first_output + static_cast<int>(outputs.size());
    std::vector<int> last(_needed.size(), -1);
    std::vector<bool> within(_needed.size(), false);  // another node's operation
    for (std::size_t n = 0; n < _needed.size(); ++n) {
      if (!_needed[n] || !_moves[n] || is_leaf(node(n).operation)) continue;
      if (const int product = taken_in(n); product >= 0) {
        within[static_cast<std::size_t>(product)] = true;
        for (const int operand :
             {node(static_cast<std::size_t>(product)).first, node(static_cast<std::size_t>(product)).second})
          last[static_cast<std::size_t>(operand)] = static_cast<int>(n);
      }
      last[static_cast<std::size_t>(first(n))] = static_cast<int>(n);
      if (is_binary(node(n).operation)) last[static_cast<std::size_t>(node(n).second)] = static_cast<int>(n);
    }
    std::vector<bool> is_output(_needed.size(), false);
    for (std::size_t k = 0; k < outputs.size(); ++k) {
      const auto n = static_cast<std::size_t>(outputs[k]);
      if (!_moves[n] || is_leaf(node(n).operation) || is_output[n]) continue;
      is_output[n] = true;
      _place[n] = first_output + static_cast<int>(k);
    }
    const auto give_back = [&](int n, std::size_t at) {
      const auto number = static_cast<std::size_t>(n);
      if (last[number] == static_cast<int>(at) && _moves[number] && !is_output[number] &&
          !is_leaf(node(number).operation))
        _free.push_back(place(n));
    };
    for (std::size_t n = 0; n < _needed.size(); ++n) {
      if (!_needed[n] || !_moves[n] || is_leaf(node(n).operation) || _done[n] || within[n]) continue;
      const bool pair = node(n).operation == Operation::sine && n + 1 < _needed.size() && _needed[n + 1];
      if (_place[n] < 0) _place[n] = register_for();
      if (pair) {
        _done[n + 1] = true;
        if (_place[n + 1] < 0) _place[n + 1] = register_for();
      }
      emit(n, pair);
      if (const int product = taken_in(n); product >= 0) {
        const Node& own = node(static_cast<std::size_t>(product));
        give_back(own.first, n);
        if (own.second != own.first) give_back(own.second, n);
        const int other = product == node(n).first ? node(n).second : node(n).first;
        if (other != own.first && other != own.second) give_back(other, n);
        continue;
      }
      give_back(first(n), pair ? n + 1 : n);
      if (is_binary(node(n).operation) && node(n).second != node(n).first) give_back(node(n).second, n);
    }
    for (std::size_t k = 0; k < outputs.size(); ++k) {
      const int row = first_output + static_cast<int>(k);
      const int from = place(outputs[k]);
      if (!moves(outputs[k]))
        _program._code.push_back({Step::fill, row, from, 0});
      else if (from != row)
        _program._code.push_back({Step::copy, row, from, 0});
    }
    _program._registers = static_cast<std::size_t>(_registers);
  }

  int register_for() {
    if (_free.empty()) return _registers++;
    const int place = _free.back();
    _free.pop_back();
    return place;
  }

  void emit(std::size_t n, bool pair) {
    const int a = first(n);
    if (pair) {
      _program._code.push_back({Step::sine_and_cosine, _place[n], place(a), _place[n + 1]});
    } else if (!is_binary(node(n).operation)) {
      _program._code.push_back({unary(node(n).operation), _place[n], place(a), 0});
    } else if (const int product = taken_in(n); product >= 0) {
      const Node& own = node(static_cast<std::size_t>(product));
      const bool is_first = product == a;
      const int other = is_first ? node(n).second : a;
      const bool both = moves(own.first) && moves(own.second);
      const int moving = moves(own.first) ? own.first : own.second;
      const int factor = moving == own.first ? own.second : own.first;
      Step step = both ? Step::product_plus_vv : Step::product_plus_vs;
      if (node(n).operation == Operation::subtract)
        step = is_first ? (both ? Step::product_minus_vv : Step::product_minus_vs)
                        : (both ? Step::less_product_vv : Step::less_product_vs);
      _program._code.push_back({step, _place[n], place(moving), place(factor), place(other)});
    } else {
      const int b = node(n).second;
      const Forms forms = binary(node(n).operation);
      const bool commutes = forms.vs == forms.sv;
      if (moves(a) && moves(b))
        _program._code.push_back({forms.vv, _place[n], place(a), place(b)});
      else if (moves(a))
        _program._code.push_back({forms.vs, _place[n], place(a), place(b)});
      else if (commutes)
        _program._code.push_back({forms.vs, _place[n], place(b), place(a)});
      else
        _program._code.push_back({forms.sv, _place[n], place(a), place(b)});
    }
  }

  const Graph& _graph;
  BlockProgram& _program;
  std::vector<bool> _needed;
  std::vector<int> _place;   // of a node: its scalar, or its register
  std::vector<bool> _moves;  // with the state
  std::vector<bool> _done;   // as the second of a pair
  std::vector<int> _fused;   // of a sum: the product that it alone asks for
  std::vector<int> _free;
  int _registers = 0;
};

BlockProgram::BlockProgram(const Graph& graph, std::span<const int> outputs) { Compiler(graph, outputs, *this); }

std::vector<double> BlockProgram::scalars(std::span<const double> parameters) const {
  core::require(parameters.size() >= _parameters, "a value for every parameter of a graph");
  std::vector<double> values(_constants);
  values.insert(values.end(), parameters.begin(), parameters.begin() + static_cast<std::ptrdiff_t>(_parameters));
  values.resize(_scalars);
  if (_fixed.empty()) return values;
  std::vector<double> space(_scalars * granule);
  std::vector<double*> registers(_scalars);
  for (std::size_t n = 0; n < _scalars; ++n) {
    registers[n] = space.data() + n * granule;
    std::fill_n(registers[n], granule, values[n]);
  }
  kernel()(_fixed.data(), _fixed.size(), registers.data(), values.data(), granule);
  for (std::size_t n = 0; n < _scalars; ++n) values[n] = *registers[n];
  return values;
}

void BlockProgram::run(std::span<const double> scalars, std::size_t states, std::span<const double* const> inputs,
                       std::span<double* const> outputs) const {
  core::require(inputs.size() >= _inputs && outputs.size() == _outputs && scalars.size() == _scalars,
                "a program of blocks is given what it asks for");
  thread_local Workspace workspace;
  workspace.reserve(_registers);
  static const BlockKernel run_block = kernel();
  std::size_t j = 0;
  if (states >= block) {
    double** const registers = workspace.direct(_inputs + _outputs, _registers);
    for (; j + block <= states; j += block) {
      for (std::size_t i = 0; i < _inputs; ++i) registers[i] = const_cast<double*>(inputs[i]) + j;
      for (std::size_t k = 0; k < _outputs; ++k) registers[_inputs + k] = outputs[k] + j;
      run_block(_code.data(), _code.size(), registers, scalars.data(), block);
    }
  }
  if (j == states) return;
  double* const* const registers = workspace.own();
  const std::size_t count = states - j;
  const std::size_t padded = (count + granule - 1) / granule * granule;
  for (std::size_t i = 0; i < _inputs; ++i) {
    double* const row = registers[i];
    for (std::size_t n = 0; n < count; ++n) row[n] = inputs[i][j + n];
    for (std::size_t n = count; n < padded; ++n) row[n] = row[count - 1];
  }
  run_block(_code.data(), _code.size(), registers, scalars.data(), padded);
  for (std::size_t k = 0; k < _outputs; ++k)
    for (std::size_t n = 0; n < count; ++n) outputs[k][j + n] = registers[_inputs + k][n];
}

void BlockProgram::run_one(std::span<const double> scalars, std::span<const double> inputs,
                           std::initializer_list<std::span<double>> outputs) const {
  core::require(inputs.size() >= _inputs && scalars.size() == _scalars, "a program is given what it asks for");
  thread_local std::vector<double> registers;
  if (registers.size() < _registers) registers.resize(_registers);
  double* const own = registers.data();
  for (std::size_t i = 0; i < _inputs; ++i) own[i] = inputs[i];
  run_at_one_state(_code.data(), _code.size(), own, scalars.data());
  const double* from = own + _inputs;
  for (const std::span<double>& row : outputs) {
    for (std::size_t k = 0; k < row.size(); ++k) row[k] = from[k];
    from += row.size();
  }
}

}  // namespace orbweaver::model
