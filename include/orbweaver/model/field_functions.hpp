#pragma once

#include "orbweaver/model/recorded.hpp"

/// What the field of a plugin may do beside what its scalars have, and what it may not: that is refused with its reason
/// where it is compiled. Orbits are followed by derivatives, which must be there everywhere.
namespace orbweaver::model {

template <class T>
inline constexpr bool is_state_scalar = false;
template <>
inline constexpr bool is_state_scalar<Recorded> = true;

template <class... Arguments>
concept WithState = (is_state_scalar<Arguments> || ...);
template <class...>
inline constexpr bool is_smooth = false;

// A function of the state that is refused; what it returns lets the compiler go on to the next.
#define ORBWEAVER_NOT_SMOOTH(function, reason)                            \
  template <class A, class... Rest>                                       \
  requires WithState<A, Rest...> A function(const A& a, const Rest&...) { \
    static_assert(is_smooth<A>, reason " (docs/your_own_system.md)");     \
    return a;                                                             \
  }
#define ORBWEAVER_NO_BRANCH(comparison)                                                                       \
  template <class A, class B>                                                                                 \
  requires WithState<A, B>                                                                                    \
  bool operator comparison(const A&, const B&) {                                                              \
    static_assert(                                                                                            \
        is_smooth<A>,                                                                                         \
        "a field has no branches that depend on the state (if, ?:, std::max, std::min, std::clamp): it "      \
        "must have derivatives everywhere. Instead of a jump take a steep smooth step, 0.5 * (1.0 + "         \
        "tanh(x / e)) with a small e; instead of max(a, b), 0.5 * (a + b + sqrt((a - b) * (a - b) + e * e)) " \
        "(docs/your_own_system.md)");                                                                         \
    return false;                                                                                             \
  }

ORBWEAVER_NOT_SMOOTH(abs, "abs has no derivative at 0: take sqrt(x * x + e * e) with a small e")
ORBWEAVER_NOT_SMOOTH(fabs, "fabs has no derivative at 0: take sqrt(x * x + e * e) with a small e")
ORBWEAVER_NOT_SMOOTH(
    max,
    "max has no derivative where both are equal: take 0.5 * (a + b + sqrt((a - b) * (a - b) + e * e)) with a small e")
ORBWEAVER_NOT_SMOOTH(
    fmax,
    "fmax has no derivative where both are equal: take 0.5 * (a + b + sqrt((a - b) * (a - b) + e * e)) with a small e")
ORBWEAVER_NOT_SMOOTH(
    min,
    "min has no derivative where both are equal: take 0.5 * (a + b - sqrt((a - b) * (a - b) + e * e)) with a small e")
ORBWEAVER_NOT_SMOOTH(
    fmin,
    "fmin has no derivative where both are equal: take 0.5 * (a + b - sqrt((a - b) * (a - b) + e * e)) with a small e")
ORBWEAVER_NOT_SMOOTH(
    floor, "floor jumps: take a periodic function of the state, or steep smooth steps, tanh(x / e) with a small e")
ORBWEAVER_NOT_SMOOTH(
    ceil, "ceil jumps: take a periodic function of the state, or steep smooth steps, tanh(x / e) with a small e")
ORBWEAVER_NOT_SMOOTH(
    round, "round jumps: take a periodic function of the state, or steep smooth steps, tanh(x / e) with a small e")
ORBWEAVER_NOT_SMOOTH(
    fmod, "fmod jumps: declare the coordinate an angle (structure.angles), and take a periodic function of it")
ORBWEAVER_NOT_SMOOTH(copysign, "copysign jumps at 0: take tanh(x / e) with a small e")
ORBWEAVER_NOT_SMOOTH(
    atan2,
    "atan2 jumps by a turn: take 2.0 * atan(y / (sqrt(x * x + y * y) + x)) away from that ray, or sines and cosines")
ORBWEAVER_NO_BRANCH(<)
ORBWEAVER_NO_BRANCH(>)
ORBWEAVER_NO_BRANCH(<=)
ORBWEAVER_NO_BRANCH(>=)
ORBWEAVER_NO_BRANCH(==)
ORBWEAVER_NO_BRANCH(!=)

#undef ORBWEAVER_NOT_SMOOTH
#undef ORBWEAVER_NO_BRANCH

}  // namespace orbweaver::model
