#pragma once

#include <span>
#include <vector>

#include "orbweaver/core/serialization.hpp"
#include "orbweaver/loop/curve/time_map.hpp"

namespace orbweaver::loop {

struct Loop;
/// Throws MisuseError unless sizes agree, cutoff >= 1, the period is positive and finite, every mode and parameter is
/// finite and the time map consists of finite numbers with kappa > 0.
void validate(const Loop& loop);
/// The same for a loop that has been read; none at all, as Loop{} is, will do.
void validate_received(const Loop& loop);

/// A closed curve in phase space with a period: z(s) = n s + a_0 + sum_k a_k cos ks + b_k sin ks, t = T phi(s)
/// (paper, section II D, where s = 2 pi t / T; winding numbers n added for angles that turn over).
struct Loop {
  int dimension = 0;
  int cutoff = 0;             ///< K, the highest harmonic
  double period = 0.0;        ///< T
  std::vector<double> modes;  ///< (2K + 1) x dimension, rows a_0, a_1, b_1, a_2, b_2, ...
  std::vector<double>
      winding;       ///< n of each coordinate (size dimension, whole numbers; 0 but for angles that turn over)
  TimeMap time_map;  ///< phi: how s runs with time
  /// Values of the parameters that move along the families of its system (systems::FamilyScalars), in their order;
  /// empty where none does.
  std::vector<double> parameters;

  [[nodiscard]] double& cosine(int k, int i) { return modes[index(k == 0 ? 0 : 2 * k - 1, i)]; }
  [[nodiscard]] double cosine(int k, int i) const { return modes[index(k == 0 ? 0 : 2 * k - 1, i)]; }
  [[nodiscard]] double& sine(int k, int i) { return modes[index(2 * k, i)]; }
  [[nodiscard]] double sine(int k, int i) const { return modes[index(2 * k, i)]; }

  static constexpr int wire_version = 2;
  template <class Archive>
  void serialize(Archive& archive, unsigned /*version*/) {
    core::serialize_members(archive, dimension, cutoff, period, modes, winding, time_map, parameters);
    if constexpr (Archive::is_loading::value) validate_received(*this);
  }

 private:
  [[nodiscard]] std::size_t index(int row, int i) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(dimension) + static_cast<std::size_t>(i);
  }
};

/// The constant loop at `point` with period `period` and room for `cutoff` harmonics.
/// Throws MisuseError for an empty point, cutoff < 1 or a period that is not positive and finite.
[[nodiscard]] Loop constant_loop(std::span<const double> point, double period, int cutoff);

/// z(t) at one time (any real t; size dimension). The one place where a loop is evaluated at a time.
[[nodiscard]] std::vector<double> state_at(const Loop& loop, double time);

/// The same loop with `cutoff` harmonics: padded with zeros or truncated.
[[nodiscard]] Loop with_cutoff(const Loop& loop, int cutoff);

/// The same loop under another time map, with `cutoff` harmonics: evaluated at the times of the new nodes and
/// transformed. What does not fit into `cutoff` harmonics is cut off (see `tail` of the result). Cost O(nodes x
/// cutoff).
[[nodiscard]] Loop with_time_map(const Loop& loop, const TimeMap& map, int cutoff);

/// Harmonics below this are negligible where a loop is expanded under another time map: two digits below the usual
/// tolerance on the residual, in which harmonic k weighs 2 pi k/T times. A loop's own tail may be larger.
inline constexpr double negligible_harmonic = 1e-12;

/// Harmonics in time, in parts of a loop's own: near a body orbits take ten times those that they have under a map that
/// follows the distance.
inline constexpr int most_in_time = 32;

/// The same loop with s even in time, with as many harmonics as that needs (up to `most_in_time`): the tail stays
/// below twice its own or `negligible`, whichever is larger.
[[nodiscard]] Loop evenly_in_time(const Loop& loop, double negligible = negligible_harmonic);

/// The same orbit gone around `times` times as one loop: harmonic k becomes harmonic times k, the period is multiplied.
/// Throws MisuseError for times < 1 or a time map that is not the identity.
[[nodiscard]] Loop repeated(const Loop& loop, int times);

/// The sum of loops of one system and time map with weights that add up to 1: modes, periods and parameters. The
/// winding is that of the first.
[[nodiscard]] Loop weighted_sum(const std::vector<const Loop*>& loops, const std::vector<double>& weights);

/// The same curve with s counted from `turns` of s (not of time) later: z(s + 2 pi turns), the time map moved along.
[[nodiscard]] Loop parameter_shifted(const Loop& loop, double turns);

/// The same orbit started `fraction` of a period later. The time map stays where it is invariant under that shift (as
/// under half a period for kappa), and moves along with the curve otherwise.
[[nodiscard]] Loop time_shifted(const Loop& loop, double fraction);

/// The largest modulus among the last thirty-second of the harmonics (at least four, two below K = 8; loops with
/// S@1/2 have only the odd ones), relative to nothing: what the truncation
/// at `cutoff` leaves out is of this size.
[[nodiscard]] double tail(const Loop& loop);

/// The cutoffs K that are used: 2K + 1 is odd with prime factors 3, 5 and 7 only, each about 1.3 times the one before.
/// `at_least` returns the smallest allowed K >= k; `next` / `previous` the neighbours of an allowed K.
[[nodiscard]] int allowed_cutoff_at_least(int k);
[[nodiscard]] int next_cutoff(int k);
[[nodiscard]] int previous_cutoff(int k);

}  // namespace orbweaver::loop
