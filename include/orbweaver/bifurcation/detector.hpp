#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <vector>

#include "orbweaver/bifurcation/test_functions.hpp"
#include "orbweaver/core/serialization.hpp"

namespace orbweaver::bifurcation {

/// An orbit of a family with its test functions.
struct TestPoint {
  double position;                    ///< along the family (arclength), increasing
  std::vector<Reading> readings;      ///< one a test function, in the caller's order
  std::vector<ZerosPassed> passed{};  ///< of each function (`zeros_passed`); empty: of none that is known
  double turns = std::numeric_limits<double>::quiet_NaN();  ///< spectrum::Stability::turns, of an elliptic orbit only
  int halvings = 0;  ///< the way to it from the point before is halved so often in any case

  static constexpr int wire_version = 4;
  template <class Archive>
  void serialize(Archive& archive, unsigned /*version*/) {
    core::serialize_members(archive, position, readings, passed, turns, halvings);
  }
};

/// Between `from` and `to` a function changes sign, or (`tangency`) only touches zero.
struct Bracket {
  std::size_t function;  ///< index of the reading
  double from;
  double to;
  bool tangency;
  bool passed = false;     ///< a tangency that is one: counts say that a zero is passed there
  bool is_double = false;  ///< counts say that two zeros are passed, which no sign shows: no tangency
  bool lost = false;       ///< a tangency that may be one: where the minimum was looked for there was no orbit
};

/// Between `from` and `to` a function has more zeros than were bracketed, by so many.
struct MissedZeros {
  std::size_t function;
  double from;
  double to;
  int count;

  static constexpr int wire_version = 1;
  template <class Archive>
  void serialize(Archive& archive, unsigned /*version*/) {
    core::serialize_members(archive, function, from, to, count);
  }
};

struct DetectorOptions {
  /// A step is halved where a reading differs by more from what evenly spaced ones extrapolate, times the function's
  /// largest modulus so far (but 0.1 at least). Zeros in pairs within a step are missed above, steps wasted below; not
  /// measured.
  double extrapolation_error = 0.1;
  /// The same in half the logarithm of an index that is large (the hyperbolic area tangent of the reading, which hardly
  /// moves there): it may go from 118 to -10 and back to 52 within a step. Readings at their bounds tell nothing so.
  double logarithm_error = 0.3;
  /// The same in turns, where they are known: the angle of a multiplier may change evenly while its functions go up and
  /// down. As much as the above is where a function is steepest.
  double turning_error = 0.02;
  /// Where points are so many turns apart, at least: below, functions tell more of what is new along the family.
  double turning_step = 0.1;
  int halvings = 3;  ///< of one step, at most, where readings ask for it
  /// A minimum of |value| below this, or below its error bound, touches zero. Located to 1e-6 of a bracket, a true
  /// touch is far below; what is taken for one wrongly costs a location that finds nothing.
  double tangency_tolerance = 1e-6;
  double tangency_error = 1e-4;  ///< a reading with a larger error bound cannot show that; not measured
  int probes = 40;               ///< for one minimum, at most
};

/// Everything a detector keeps: plain values, for checkpoints.
struct DetectorState {
  struct Node {
    double position = 0.0;
    Reading reading{};
    ZerosPassed passed{};  ///< of TestPoint::passed

    static constexpr int wire_version = 3;
    template <class Archive>
    void serialize(Archive& archive, unsigned /*version*/) {
      core::serialize_members(archive, position, reading, passed);
    }
  };
  struct Watch {
    std::vector<Node> signed_nodes;                                 ///< the last two readings with a sign
    std::optional<Node> undecided;                                  ///< the smallest since without one
    double scale = 0.0;                                             ///< the largest modulus so far
    double examined_to = -std::numeric_limits<double>::infinity();  ///< minima up to here have been looked at

    static constexpr int wire_version = 1;
    template <class Archive>
    void serialize(Archive& archive, unsigned /*version*/) {
      core::serialize_members(archive, signed_nodes, undecided, scale, examined_to);
    }
  };
  std::vector<TestPoint> points;  ///< the last two, probed ones included
  std::vector<Watch> watches;     ///< one a test function
  std::vector<MissedZeros> missed;

  static constexpr int wire_version = 2;
  template <class Archive>
  void serialize(Archive& archive, unsigned /*version*/) {
    core::serialize_members(archive, points, watches, missed);
  }
};

/// Finds the zeros of test functions along a family from its points one after the other. Where a step is too coarse for
/// that (a reading is not what its neighbours let expect), it asks for points in between.
///
/// Where the points say how many zeros have been passed, as many are bracketed, whether signs show them or not; or they
/// are `missed`.
///
/// A function's sign is compared with its last one: points without a sign are passed over, so noise below the error
/// bound is no event, nor is a family's start, where a function is about zero before it has had a sign.
class Detector {
 public:
  /// The point at a position between known ones, not before the last but two; none if there is no orbit to be had.
  using Probe = std::function<std::optional<TestPoint>(double position)>;

  explicit Detector(DetectorOptions options = {}) : _options(options) {}
  Detector(DetectorState state, DetectorOptions options) : _options(options), _state(std::move(state)) {}

  /// Takes the family's next point. Returns what is new, by position: brackets of one function share at most an end.
  /// Throws MisuseError unless positions increase and all points (the probe's too) have as many readings.
  [[nodiscard]] std::vector<Bracket> advance(const TestPoint& next, const Probe& probe);
  /// What can still be found before the last point, once the family has ended.
  [[nodiscard]] std::vector<Bracket> finish(const Probe& probe);

  [[nodiscard]] const DetectorState& state() const { return _state; }
  /// All so far.
  [[nodiscard]] const std::vector<MissedZeros>& missed() const { return _state.missed; }

 private:
  using Node = DetectorState::Node;
  using Watch = DetectorState::Watch;

  [[nodiscard]] bool badly_extrapolated(const std::vector<TestPoint>& grid, std::size_t n) const;
  [[nodiscard]] bool turns_evenly(const std::vector<TestPoint>& grid, std::size_t n) const;
  [[nodiscard]] std::vector<TestPoint> subdivided(const TestPoint& next, const Probe& probe) const;
  void take(std::size_t function, const Node& node, const Probe& probe, std::vector<Bracket>& found);
  void count(std::size_t function, const Node& left, const Node& right, const Probe& probe,
             std::vector<Bracket>& found);
  void part(std::size_t function, const Node& left, const Node& right, int halvings, const Probe& probe,
            std::vector<Bracket>& found) const;
  void look_for_minimum(std::size_t function, const Node& a, const Node& b, const Node& c, const Probe& probe,
                        std::vector<Bracket>& found);
  int examine(std::size_t function, const Node& left, const Node& right, const Probe& probe,
              std::vector<Bracket>& found);
  [[nodiscard]] std::optional<TestPoint> probed(const Probe& probe, double position) const;

  DetectorOptions _options;
  DetectorState _state;
};

}  // namespace orbweaver::bifurcation
