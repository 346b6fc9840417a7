#include "processor.hpp"

namespace orbweaver::drivers {

#ifdef __AVX__
constexpr bool has_avx = true;
#else
constexpr bool has_avx = false;
#endif
#ifdef __AVX2__
constexpr bool has_avx2 = true;
#else
constexpr bool has_avx2 = false;
#endif
#ifdef __FMA__
constexpr bool has_fma = true;
#else
constexpr bool has_fma = false;
#endif
#ifdef __BMI2__
constexpr bool has_bmi2 = true;
#else
constexpr bool has_bmi2 = false;
#endif
#ifdef __AVX512F__
constexpr bool has_avx512f = true;
#else
constexpr bool has_avx512f = false;
#endif

constinit const ProcessorExtension processor_extensions[] = {
    {"avx", has_avx},   {"avx2", has_avx2},       {"fma", has_fma},
    {"bmi2", has_bmi2}, {"avx512f", has_avx512f}, {nullptr, false},
};

}  // namespace orbweaver::drivers
