#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>

namespace orbweaver::ad {

/// As many doubles as fit a vector register of the CPU compiled for, with the arithmetic of one: a function written
/// for any scalar type S runs at `width` states at once with S = Lanes. A lane's result depends on nothing in the other
/// lanes.
struct Lanes {
#if defined(__AVX512F__)
  static constexpr std::size_t width = 8;
#elif defined(__AVX__)
  static constexpr std::size_t width = 4;
#else
  static constexpr std::size_t width = 2;
#endif
  using Packed = double __attribute__((vector_size(width * sizeof(double))));
  using Bits = std::int64_t __attribute__((vector_size(width * sizeof(double))));

  Packed packed;

  Lanes() = default;
  Lanes(double all) : packed(all - Packed{}) {}
  Lanes(Packed p) : packed(p) {}

  /// The `width` numbers at `from`, of any alignment.
  static Lanes load(const double* from) {
    Lanes lanes;
    __builtin_memcpy(&lanes.packed, from, sizeof(Packed));
    return lanes;
  }
  /// The first `count` >= 1 numbers at `from`, at most `width`; the last is repeated.
  static Lanes load(const double* from, std::size_t count) {
    Lanes lanes;
    for (std::size_t l = 0; l < width; ++l) lanes.packed[l] = from[l < count ? l : count - 1];
    return lanes;
  }
  /// Writes all lanes to `to`.
  void store(double* to) const { __builtin_memcpy(to, &packed, sizeof(Packed)); }
  /// Writes the first `count` lanes, at most all.
  void store(double* to, std::size_t count) const {
    for (std::size_t l = 0; l < width; ++l)
      if (l < count) to[l] = packed[l];
  }

  Lanes& operator+=(Lanes b) { return *this = *this + b; }
  Lanes& operator-=(Lanes b) { return *this = *this - b; }
  Lanes& operator*=(Lanes b) { return *this = *this * b; }
  Lanes& operator/=(Lanes b) { return *this = *this / b; }
  friend Lanes operator-(Lanes a) { return -a.packed; }
  friend Lanes operator+(Lanes a, Lanes b) { return a.packed + b.packed; }
  friend Lanes operator-(Lanes a, Lanes b) { return a.packed - b.packed; }
  friend Lanes operator*(Lanes a, Lanes b) { return a.packed * b.packed; }
  friend Lanes operator/(Lanes a, Lanes b) { return a.packed / b.packed; }
};

namespace detail {

/// function(lane) in each lane: for what no model needs in a hurry.
template <class Function>
Lanes lane_by_lane(Lanes x, const Function& function) {
  for (std::size_t l = 0; l < Lanes::width; ++l) x.packed[l] = function(x.packed[l]);
  return x;
}

/// sin and cos of x - quadrant pi/2 on [-pi/4, pi/4].
struct Wave {
  Lanes::Packed sine;
  Lanes::Packed cosine;
  Lanes::Bits quadrant;
};

/// Argument reduction in three parts of pi/2 (the first two have 33 bits, so that products with the quadrant are
/// exact), then the polynomials of fdlibm's k_sin.c and k_cos.c. For |x| < wave_limit the relative error is below 0.8
/// ulp. Both are always computed: inlined, sin and cos of one argument share everything.
inline constexpr double wave_limit = 32768.0;

inline Wave wave(Lanes::Packed x) {
  constexpr double to_integer = 0x1.8p52;  // the sum's low bits are the rounded number
  const Lanes::Packed turned = x * 0x1.45f306dc9c883p-1 + to_integer;
  const Lanes::Packed n = turned - to_integer;
  const Lanes::Packed coarse = x - n * 0x1.921fb544p+0;
  const Lanes::Packed fine = n * 0x1.0b4611a6p-34;
  const Lanes::Packed reduced = coarse - fine;
  const Lanes::Packed rest = ((coarse - reduced) - fine) - n * 0x1.3198a2e037073p-69;
  const Lanes::Packed y = reduced + rest;
  const Lanes::Packed low = (reduced - y) + rest;

  const Lanes::Packed z = y * y;
  const Lanes::Packed w = z * z;
  const Lanes::Packed v = z * y;
  const Lanes::Packed s = 8.33333333332248946124e-03 +
                          z * (-1.98412698298579493134e-04 + z * 2.75573137070700676789e-06) +
                          z * w * (-2.50507602534068634195e-08 + z * 1.58969099521155010221e-10);
  const Lanes::Packed sine = y - ((z * (0.5 * low - v * s) - low) + v * 1.66666666666666324348e-01);

  const Lanes::Packed c =
      z * (4.16666666666666019037e-02 + z * (-1.38888888888741095749e-03 + z * 2.48015872894767294178e-05)) +
      w * w * (-2.75573143513906633035e-07 + z * (2.08757232129817482790e-09 + z * -1.13596475577881948265e-11));
  const Lanes::Packed half = 0.5 * z;
  const Lanes::Packed head = 1.0 - half;
  const Lanes::Packed cosine = head + (((1.0 - head) - half) + (z * c - y * low));
  return {sine, cosine, reinterpret_cast<Lanes::Bits>(turned)};
}

/// `value` with its sign flipped in the lanes whose `quadrant` has the bit 2.
inline Lanes::Packed signed_by(Lanes::Bits quadrant, Lanes::Packed value) {
  return reinterpret_cast<Lanes::Packed>(reinterpret_cast<Lanes::Bits>(value) ^ ((quadrant & 2) << 62));
}

/// False where x is beyond `wave_limit` or NaN, in any lane.
inline bool within_wave_limit(Lanes::Packed x) {
  const Lanes::Bits inside = (x < wave_limit) & (x > -wave_limit);
  std::int64_t all = -1;
  for (std::size_t l = 0; l < Lanes::width; ++l) all &= inside[l];
  return all != 0;
}

/// Replaces the lanes of `value` whose argument is beyond `wave_limit` by function(x).
template <class Function>
[[gnu::noinline]] Lanes beyond_wave_limit(Lanes x, Lanes value, const Function& function) {
  for (std::size_t l = 0; l < Lanes::width; ++l)
    if (!(std::abs(x.packed[l]) < wave_limit)) value.packed[l] = function(x.packed[l]);
  return value;
}

}  // namespace detail

inline Lanes sin(Lanes x) {
  const detail::Wave wave = detail::wave(x.packed);
  const Lanes value = detail::signed_by(wave.quadrant, (wave.quadrant & 1) != 0 ? wave.cosine : wave.sine);
  if (detail::within_wave_limit(x.packed)) [[likely]]
    return value;
  return detail::beyond_wave_limit(x, value, [](double a) { return std::sin(a); });
}

inline Lanes cos(Lanes x) {
  const detail::Wave wave = detail::wave(x.packed);
  const Lanes value = detail::signed_by(wave.quadrant + 1, (wave.quadrant & 1) != 0 ? wave.sine : wave.cosine);
  if (detail::within_wave_limit(x.packed)) [[likely]]
    return value;
  return detail::beyond_wave_limit(x, value, [](double a) { return std::cos(a); });
}

#define ORBWEAVER_LANE_BY_LANE(function)                                       \
  inline Lanes function(Lanes x) {                                             \
    return detail::lane_by_lane(x, [](double a) { return std::function(a); }); \
  }
ORBWEAVER_LANE_BY_LANE(sqrt)
ORBWEAVER_LANE_BY_LANE(exp)
ORBWEAVER_LANE_BY_LANE(log)
ORBWEAVER_LANE_BY_LANE(tan)
ORBWEAVER_LANE_BY_LANE(asin)
ORBWEAVER_LANE_BY_LANE(acos)
ORBWEAVER_LANE_BY_LANE(atan)
ORBWEAVER_LANE_BY_LANE(sinh)
ORBWEAVER_LANE_BY_LANE(cosh)
ORBWEAVER_LANE_BY_LANE(tanh)
ORBWEAVER_LANE_BY_LANE(erf)
#undef ORBWEAVER_LANE_BY_LANE

inline Lanes pow(Lanes x, double exponent) {
  return detail::lane_by_lane(x, [exponent](double a) { return std::pow(a, exponent); });
}

}  // namespace orbweaver::ad
