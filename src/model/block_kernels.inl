// The kernel of block_kernels.hpp for vectors of ORBWEAVER_VECTOR_BYTES, in a namespace of its own, for processors that
// have them.

namespace {

constexpr std::size_t width = ORBWEAVER_VECTOR_BYTES / sizeof(double);
using Vector = double __attribute__((vector_size(ORBWEAVER_VECTOR_BYTES)));
using Bits = std::int64_t __attribute__((vector_size(ORBWEAVER_VECTOR_BYTES)));

Vector all(double x) { return x - Vector{}; }
Bits bits_of(Vector x) { return reinterpret_cast<Bits>(x); }
Vector of_bits(Bits x) { return reinterpret_cast<Vector>(x); }
Vector load(const double* from) {
  Vector x;
  __builtin_memcpy(&x, from, sizeof x);
  return x;
}
void store(double* to, Vector x) { __builtin_memcpy(to, &x, sizeof x); }

constexpr double to_integer = 0x1.8p52;  // a sum with it has the rounded number in its low bits
constexpr std::int64_t to_integer_bits = 0x4338000000000000;
constexpr double infinity = __builtin_inf();

Vector magnitude(Vector x) { return of_bits(bits_of(x) & 0x7fffffffffffffff); }
Vector with_sign_of(Vector x, Vector sign) {
  return of_bits(bits_of(x) | (bits_of(sign) & static_cast<std::int64_t>(0x8000000000000000)));
}

Vector fused(Vector a, Vector b, Vector c) {
  for (std::size_t l = 0; l < width; ++l) c[l] = __builtin_fma(a[l], b[l], c[l]);
  return c;
}

Vector square_root(Vector x) {
  for (std::size_t l = 0; l < width; ++l) x[l] = __builtin_sqrt(x[l]);
  return x;
}

// sin and cos of x - quadrant pi/2 on [-pi/4, pi/4]. Argument reduction in three parts of pi/2 (the first two have 33
// bits, so that products with the quadrant are exact), then the polynomials of fdlibm's k_sin.c and k_cos.c. For
// |x| < wave_limit the relative error is below 0.8 ulp.
struct Wave {
  Vector sine;
  Vector cosine;
  Bits quadrant;
};
constexpr double wave_limit = 32768.0;

Wave wave(Vector x) {
  const Vector turned = x * 0x1.45f306dc9c883p-1 + to_integer;
  const Vector n = turned - to_integer;
  const Vector coarse = x - n * 0x1.921fb544p+0;
  const Vector fine = n * 0x1.0b4611a6p-34;
  const Vector reduced = coarse - fine;
  const Vector rest = ((coarse - reduced) - fine) - n * 0x1.3198a2e037073p-69;
  const Vector y = reduced + rest;
  const Vector low = (reduced - y) + rest;

  const Vector z = y * y;
  const Vector w = z * z;
  const Vector v = z * y;
  const Vector s = 8.33333333332248946124e-03 + z * (-1.98412698298579493134e-04 + z * 2.75573137070700676789e-06) +
                   z * w * (-2.50507602534068634195e-08 + z * 1.58969099521155010221e-10);
  const Vector sine = y - ((z * (0.5 * low - v * s) - low) + v * 1.66666666666666324348e-01);

  const Vector c =
      z * (4.16666666666666019037e-02 + z * (-1.38888888888741095749e-03 + z * 2.48015872894767294178e-05)) +
      w * w * (-2.75573143513906633035e-07 + z * (2.08757232129817482790e-09 + z * -1.13596475577881948265e-11));
  const Vector half = 0.5 * z;
  const Vector head = 1.0 - half;
  const Vector cosine = head + (((1.0 - head) - half) + (z * c - y * low));
  return {sine, cosine, bits_of(turned)};
}

Vector signed_by(Bits quadrant, Vector value) { return of_bits(bits_of(value) ^ ((quadrant & 2) << 62)); }
Vector sine_of(const Wave& wave) {
  return signed_by(wave.quadrant, (wave.quadrant & 1) != 0 ? wave.cosine : wave.sine);
}
Vector cosine_of(const Wave& wave) {
  return signed_by(wave.quadrant + 1, (wave.quadrant & 1) != 0 ? wave.sine : wave.cosine);
}

/// Replaces what lies beyond the reach of `wave`, or is NaN.
Vector within_reach(Vector x, Vector value, double (*function)(double)) {
  const Bits inside = (x < wave_limit) & (x > -wave_limit);
  std::int64_t every = -1;
  for (std::size_t l = 0; l < width; ++l) every &= inside[l];
  if (every == 0)
    for (std::size_t l = 0; l < width; ++l)
      if (inside[l] == 0) value[l] = function(x[l]);
  return value;
}

// fdlibm's e_exp.c.
Vector exponential(Vector x) {
  x = x > 710.0 ? all(710.0) : x;
  x = x < -746.0 ? all(-746.0) : x;
  const Vector turned = x * 1.44269504088896338700e+00 + to_integer;
  const Vector n = turned - to_integer;
  const Vector high = x - n * 6.93147180369123816490e-01;
  const Vector low = n * 1.90821492927058770002e-10;
  const Vector r = high - low;
  const Vector z = r * r;
  const Vector c =
      r - z * (1.66666666666666019037e-01 +
               z * (-2.77777777770155933842e-03 +
                    z * (6.61375632143793436117e-05 +
                         z * (-1.65339022054652515390e-06 + z * 4.13813679705723846039e-08))));
  const Vector y = 1.0 - ((low - (r * c) / (2.0 - c)) - high);
  const Bits exponent = bits_of(turned) - to_integer_bits;
  const Bits half = exponent >> 1;
  return y * of_bits((half + 1023) << 52) * of_bits((exponent - half + 1023) << 52);
}

// fdlibm's e_log.c, the significand in [sqrt(1/2), sqrt(2)).
Vector logarithm(Vector x) {
  const Bits is_small = x < 0x1p-1022;
  Bits u = bits_of(is_small ? x * 0x1p54 : x);
  u += 0x3ff0000000000000 - 0x3fe6a09e00000000;
  const Bits exponent = ((u >> 52) & 0x7ff) - 1023 - (is_small & 54);
  const Vector f = of_bits((u & 0x000fffffffffffff) + 0x3fe6a09e00000000) - 1.0;
  const Vector n = of_bits(exponent + to_integer_bits) - to_integer;
  const Vector half_square = 0.5 * f * f;
  const Vector s = f / (2.0 + f);
  const Vector z = s * s;
  const Vector w = z * z;
  const Vector even = w * (3.999999999940941908e-01 + w * (2.222219843214978396e-01 + w * 1.531383769920937332e-01));
  const Vector odd =
      z * (6.666666666666735130e-01 +
           w * (2.857142874366239149e-01 + w * (1.818357216161805012e-01 + w * 1.479819860511658591e-01)));
  Vector value = s * (half_square + (even + odd)) + n * 1.90821492927058770002e-10 - half_square + f +
                 n * 6.93147180369123816490e-01;
  value = x == infinity ? x : value;
  value = x == 0.0 ? all(-infinity) : value;
  return x >= 0.0 ? value : all(__builtin_nan(""));
}

// S. L. Moshier's Cephes, atan.c.
Vector arctangent(Vector argument) {
  const Vector x = magnitude(argument);
  const Bits is_large = x > 2.41421356237309504880;
  const Bits is_middle = (x > 0.66) & ~is_large;
  Vector y = is_middle ? (x - 1.0) / (x + 1.0) : x;
  y = is_large ? -1.0 / x : y;
  const Vector z = y * y;
  const Vector p =
      ((((-8.750608600031904122785e-01 * z - 1.615753718733365076637e+01) * z - 7.500855792314704667340e+01) * z -
        1.228866684490136173410e+02) *
           z -
       6.485021904942025371773e+01);
  const Vector q =
      (((((z + 2.485846490142306297962e+01) * z + 1.650270098316988542046e+02) * z + 4.328810604912902668951e+02) * z +
        4.853903996359136964868e+02) *
           z +
       1.945506571482613964425e+02);
  Vector value = y * (z * p / q) + y;
  constexpr double rest = 6.123233995736765886130e-17;
  value = is_middle ? 7.85398163397448309616e-01 + (value + 0.5 * rest) : value;
  value = is_large ? 1.57079632679489661923e+00 + (value + rest) : value;
  return with_sign_of(value, argument);
}

Vector arcsine(Vector x) { return arctangent(x / square_root((1.0 - x) * (1.0 + x))); }
Vector arccosine(Vector x) { return 2.0 * arctangent(square_root((1.0 - x) / (1.0 + x))); }

// Cephes, tanh.c.
Vector hyperbolic_tangent(Vector argument) {
  const Vector x = magnitude(argument);
  const Vector z = x * x;
  const Vector p = (-9.64399179425052238628e-01 * z - 9.92877231001918586564e+01) * z - 1.61468768441708447952e+03;
  const Vector q = ((z + 1.12811678491632931402e+02) * z + 2.23548839060100448583e+03) * z + 4.84406305325125486048e+03;
  const Vector near = x + x * (z * p / q);
  const Vector far = 1.0 - 2.0 / (exponential(x + x) + 1.0);
  return with_sign_of(x >= 0.625 ? far : near, argument);
}

Vector one_by_one(Vector x, double (*function)(double)) {
  for (std::size_t l = 0; l < width; ++l) x[l] = function(x[l]);
  return x;
}

template <class Function>
[[gnu::always_inline]] inline void each(std::size_t count, double* result, const double* a, const Function& function) {
  for (std::size_t j = 0; j < count; j += width) store(result + j, function(load(a + j)));
}

template <class Function>
[[gnu::always_inline]] inline void each(std::size_t count, double* result, const double* a, const double* b,
                                        const double* c, const Function& function) {
  for (std::size_t j = 0; j < count; j += width) store(result + j, function(load(a + j), load(b + j), load(c + j)));
}

template <class Function>
[[gnu::always_inline]] inline void each(std::size_t count, double* result, const double* a, const double* b,
                                        const Function& function) {
  for (std::size_t j = 0; j < count; j += width) store(result + j, function(load(a + j), load(b + j)));
}

void run(const Instruction* code, std::size_t size, double* const* registers, const double* scalars,
                            std::size_t count) {
  for (const Instruction* i = code; i != code + size; ++i) {
    double* r = registers[i->result];
    const double* const a = i->step == Step::fill || i->step == Step::subtract_sv || i->step == Step::divide_sv
                                ? nullptr
                                : registers[i->a];
    switch (i->step) {
      case Step::fill:
        for (std::size_t j = 0; j < count; j += width) store(r + j, all(scalars[i->a]));
        break;
      case Step::copy: each(count, r, a, [](Vector x) { return x; }); break;
      case Step::add_vv: each(count, r, a, registers[i->b], [](Vector x, Vector y) { return x + y; }); break;
      case Step::add_vs: each(count, r, a, [s = all(scalars[i->b])](Vector x) { return x + s; }); break;
      case Step::subtract_vv: each(count, r, a, registers[i->b], [](Vector x, Vector y) { return x - y; }); break;
      case Step::subtract_vs: each(count, r, a, [s = all(scalars[i->b])](Vector x) { return x - s; }); break;
      case Step::subtract_sv:
        each(count, r, registers[i->b], [s = all(scalars[i->a])](Vector x) { return s - x; });
        break;
      case Step::multiply_vv: each(count, r, a, registers[i->b], [](Vector x, Vector y) { return x * y; }); break;
      case Step::multiply_vs: each(count, r, a, [s = all(scalars[i->b])](Vector x) { return x * s; }); break;
      case Step::divide_vv: each(count, r, a, registers[i->b], [](Vector x, Vector y) { return x / y; }); break;
      case Step::divide_vs: each(count, r, a, [s = all(scalars[i->b])](Vector x) { return x / s; }); break;
      case Step::divide_sv:
        each(count, r, registers[i->b], [s = all(scalars[i->a])](Vector x) { return s / x; });
        break;
      case Step::product_plus_vv:
        each(count, r, a, registers[i->b], registers[i->c],
             [](Vector x, Vector y, Vector z) { return fused(x, y, z); });
        break;
      case Step::product_plus_vs:
        each(count, r, a, registers[i->c], [s = all(scalars[i->b])](Vector x, Vector z) { return fused(x, s, z); });
        break;
      case Step::product_minus_vv:
        each(count, r, a, registers[i->b], registers[i->c],
             [](Vector x, Vector y, Vector z) { return fused(x, y, -z); });
        break;
      case Step::product_minus_vs:
        each(count, r, a, registers[i->c], [s = all(scalars[i->b])](Vector x, Vector z) { return fused(x, s, -z); });
        break;
      case Step::less_product_vv:
        each(count, r, a, registers[i->b], registers[i->c],
             [](Vector x, Vector y, Vector z) { return fused(-x, y, z); });
        break;
      case Step::less_product_vs:
        each(count, r, a, registers[i->c], [s = all(scalars[i->b])](Vector x, Vector z) { return fused(-x, s, z); });
        break;
      case Step::negate: each(count, r, a, [](Vector x) { return -x; }); break;
      case Step::sqrt: each(count, r, a, [](Vector x) { return square_root(x); }); break;
      case Step::exp: each(count, r, a, [](Vector x) { return exponential(x); }); break;
      case Step::log: each(count, r, a, [](Vector x) { return logarithm(x); }); break;
      case Step::sine:
        each(count, r, a, [](Vector x) { return within_reach(x, sine_of(wave(x)), far_sine); });
        break;
      case Step::cosine:
        each(count, r, a, [](Vector x) { return within_reach(x, cosine_of(wave(x)), far_cosine); });
        break;
      case Step::sine_and_cosine:
        for (std::size_t j = 0; j < count; j += width) {
          const Vector x = load(a + j);
          const Wave both = wave(x);
          store(r + j, within_reach(x, sine_of(both), far_sine));
          store(registers[i->b] + j, within_reach(x, cosine_of(both), far_cosine));
        }
        break;
      case Step::tanh: each(count, r, a, [](Vector x) { return hyperbolic_tangent(x); }); break;
      case Step::slope: each(count, r, a, [](Vector x) { return 1.0 - x * x; }); break;
      case Step::asin: each(count, r, a, [](Vector x) { return arcsine(x); }); break;
      case Step::acos: each(count, r, a, [](Vector x) { return arccosine(x); }); break;
      case Step::atan: each(count, r, a, [](Vector x) { return arctangent(x); }); break;
      case Step::erf: each(count, r, a, [](Vector x) { return one_by_one(x, error_function); }); break;
    }
  }
}

}  // namespace
