#include "block_kernels.hpp"

#include <cstdint>

namespace orbweaver::model {

namespace in_128_bits {
#define ORBWEAVER_VECTOR_BYTES 16
#include "block_kernels.inl"
#undef ORBWEAVER_VECTOR_BYTES
}  // namespace in_128_bits

void run_in_128_bits(const Instruction* code, std::size_t size, double* const* registers, const double* scalars,
                     std::size_t count) {
  in_128_bits::run(code, size, registers, scalars, count);
}

#if defined(__x86_64__)
#pragma GCC push_options
#pragma GCC target("avx2,fma")
namespace in_256_bits {
#define ORBWEAVER_VECTOR_BYTES 32
#include "block_kernels.inl"
#undef ORBWEAVER_VECTOR_BYTES
}  // namespace in_256_bits

void run_in_256_bits(const Instruction* code, std::size_t size, double* const* registers, const double* scalars,
                     std::size_t count) {
  in_256_bits::run(code, size, registers, scalars, count);
}
#pragma GCC pop_options

#pragma GCC push_options
#pragma GCC target("avx512f,avx512dq,fma,prefer-vector-width=512")
namespace in_512_bits {
#define ORBWEAVER_VECTOR_BYTES 64
#include "block_kernels.inl"
#undef ORBWEAVER_VECTOR_BYTES
}  // namespace in_512_bits

void run_in_512_bits(const Instruction* code, std::size_t size, double* const* registers, const double* scalars,
                     std::size_t count) {
  in_512_bits::run(code, size, registers, scalars, count);
}
#pragma GCC pop_options
#endif

void run_at_one_state(const Instruction* code, std::size_t size, double* registers, const double* scalars) {
  for (const Instruction* i = code; i != code + size; ++i) {
    double& r = registers[i->result];
    switch (i->step) {
      case Step::fill: r = scalars[i->a]; break;
      case Step::copy: r = registers[i->a]; break;
      case Step::add_vv: r = registers[i->a] + registers[i->b]; break;
      case Step::add_vs: r = registers[i->a] + scalars[i->b]; break;
      case Step::subtract_vv: r = registers[i->a] - registers[i->b]; break;
      case Step::subtract_vs: r = registers[i->a] - scalars[i->b]; break;
      case Step::subtract_sv: r = scalars[i->a] - registers[i->b]; break;
      case Step::multiply_vv: r = registers[i->a] * registers[i->b]; break;
      case Step::multiply_vs: r = registers[i->a] * scalars[i->b]; break;
      case Step::divide_vv: r = registers[i->a] / registers[i->b]; break;
      case Step::divide_vs: r = registers[i->a] / scalars[i->b]; break;
      case Step::divide_sv: r = scalars[i->a] / registers[i->b]; break;
      case Step::product_plus_vv: r = __builtin_fma(registers[i->a], registers[i->b], registers[i->c]); break;
      case Step::product_plus_vs: r = __builtin_fma(registers[i->a], scalars[i->b], registers[i->c]); break;
      case Step::product_minus_vv: r = __builtin_fma(registers[i->a], registers[i->b], -registers[i->c]); break;
      case Step::product_minus_vs: r = __builtin_fma(registers[i->a], scalars[i->b], -registers[i->c]); break;
      case Step::less_product_vv: r = __builtin_fma(-registers[i->a], registers[i->b], registers[i->c]); break;
      case Step::less_product_vs: r = __builtin_fma(-registers[i->a], scalars[i->b], registers[i->c]); break;
      case Step::negate: r = -registers[i->a]; break;
      case Step::sqrt: r = __builtin_sqrt(registers[i->a]); break;
      case Step::slope: r = 1.0 - registers[i->a] * registers[i->a]; break;
      default: {  // functions, by the vectors' own
        double lanes[2][in_128_bits::width];
        for (double& lane : lanes[0]) lane = registers[i->a];
        double* rows[2] = {lanes[0], lanes[1]};
        const Instruction alone{i->step, 0, 0, 1};
        run_in_128_bits(&alone, 1, rows, scalars, in_128_bits::width);
        r = lanes[0][0];
        if (i->step == Step::sine_and_cosine) registers[i->b] = lanes[1][0];
      }
    }
  }
}

}  // namespace orbweaver::model
