#pragma once

#include <cstddef>

#include "orbweaver/model/block_program.hpp"

namespace orbweaver::model {

/// Runs a code over `count` states, a multiple of 8, in vectors of so many bits.
using BlockKernel = void (*)(const Instruction* code, std::size_t size, double* const* registers, const double* scalars,
                             std::size_t count);

void run_in_128_bits(const Instruction* code, std::size_t size, double* const* registers, const double* scalars,
                     std::size_t count);
/// The same bits at one state, without vectors but for functions: registers are numbers.
void run_at_one_state(const Instruction* code, std::size_t size, double* registers, const double* scalars);
#if defined(__x86_64__)
void run_in_256_bits(const Instruction* code, std::size_t size, double* const* registers, const double* scalars,
                     std::size_t count);
void run_in_512_bits(const Instruction* code, std::size_t size, double* const* registers, const double* scalars,
                     std::size_t count);
#endif

// Of one number, where a vector's functions do not reach.
double far_sine(double x);
double far_cosine(double x);
double error_function(double x);

}  // namespace orbweaver::model
