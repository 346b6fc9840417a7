#include "compare/family_match.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <tuple>

namespace orbweaver::report {

namespace {

/// Orbits of each family of a pair that are held against the other's curve to see whether it is the same: enough for a
/// share.
constexpr std::size_t samples = 12;
/// The curves of different families cross, or leave one another slowly; those of one agree but for what only one has
/// reached.
constexpr double same_share = 0.5;
/// Crossings of one kind and sector on one family are further apart, relative in period and in energy, than this beyond
/// the errors of their places.
constexpr double near_crossing = 1e-3;

struct Candidate {
  int a;
  int b;
  double share;   ///< of the orbits that lie on the other's curve
  double excess;  ///< mean of theirs
};

struct Share {
  std::size_t asked = 0;
  std::size_t found = 0;
  double excess = 0.0;
};

// Orbits beyond the ends of the other family say nothing; those are the ones at the ends whose period and energy lie
// outside.
bool is_in_range(const InvariantCurve& curve, const Invariants& x) {
  for (const Invariant i : {Invariant::period, Invariant::level}) {
    double from = x.value(i), to = x.value(i);
    bool first = true;
    for (const Invariants& point : curve.points()) {
      from = first ? point.value(i) : std::fmin(from, point.value(i));
      to = first ? point.value(i) : std::fmax(to, point.value(i));
      first = false;
    }
    if (x.value(i) < from - x.floor_of(i) || x.value(i) > to + x.floor_of(i)) return false;
  }
  return true;
}

Share share_of(const TreeFamily& family, const TreeFamily& other) {
  Share share;
  const std::size_t count = std::min(samples, family.orbits());
  for (std::size_t n = 0; n < count; ++n) {
    const Invariants& x = family.curve.points()[(2 * n + 1) * family.orbits() / (2 * count)];
    const CurveFit fit = other.curve.fit_anywhere(x);
    if (!fit.fits() && !is_in_range(other.curve, x)) continue;
    ++share.asked;
    if (!fit.fits()) continue;
    ++share.found;
    share.excess += fit.excess;
  }
  return share;
}

class Matcher {
 public:
  Matcher(const AtlasTree& a, const AtlasTree& b, const LoopCheck& loops) : _a(a), _b(b), _loops(loops) {
    _match.family_of_a.assign(a.families.size(), -1);
    _match.family_of_b.assign(b.families.size(), -1);
    _match.crossing_of_a.assign(a.crossings.size(), -1);
    _match.crossing_of_b.assign(b.crossings.size(), -1);
    _match.is_born_elsewhere.assign(a.families.size(), false);
  }

  TreeMatch run() {
    match_by_orbits(_a.roots, _b.roots);
    match_rest(_a.roots, _b.roots, [](const TreeFamily& x, const TreeFamily& y) { return x.name == y.name; });
    follow();
    match_moved();
    return std::move(_match);
  }

 private:
  [[nodiscard]] bool is_free(int a, int b) const {
    return _match.family_of_a[index(a)] < 0 && _match.family_of_b[index(b)] < 0;
  }

  void take(int a, int b) {
    _match.family_of_a[index(a)] = b;
    _match.family_of_b[index(b)] = a;
    _open.push_back(a);
  }

  // All pairs that may be the same family, the best first.
  [[nodiscard]] std::vector<Candidate> candidates(const std::vector<int>& as, const std::vector<int>& bs) const {
    std::vector<Candidate> out;
    for (const int a : as)
      for (const int b : bs) {
        if (!is_free(a, b)) continue;
        const Share one = share_of(_a.families[index(a)], _b.families[index(b)]);
        const Share other = share_of(_b.families[index(b)], _a.families[index(a)]);
        const double asked = static_cast<double>(one.asked + other.asked);
        const double found = static_cast<double>(one.found + other.found);
        if (found > 0.0 && found >= same_share * asked)
          out.push_back({a, b, found / asked, (one.excess + other.excess) / found});
      }
    std::sort(out.begin(), out.end(), [](const Candidate& x, const Candidate& y) {
      return std::tuple(-x.share, x.excess, x.a, x.b) < std::tuple(-y.share, y.excess, y.a, y.b);
    });
    return out;
  }

  std::vector<std::pair<int, int>> match_by_orbits(const std::vector<int>& as, const std::vector<int>& bs) {
    std::vector<Candidate> pairs = candidates(as, bs);
    const auto is_one_of_several = [&](const Candidate& pair) {
      return std::any_of(pairs.begin(), pairs.end(),
                         [&](const Candidate& other) { return (other.a == pair.a) != (other.b == pair.b); });
    };
    std::vector<Candidate> kept;
    for (const Candidate& pair : pairs)
      if (!is_one_of_several(pair) || _loops.are_same(_a, _a.families[index(pair.a)], _b, _b.families[index(pair.b)]))
        kept.push_back(pair);
    // Mirror images are the same by their orbits and by their loops.
    std::stable_partition(kept.begin(), kept.end(), [&](const Candidate& pair) {
      return _a.families[index(pair.a)].name == _b.families[index(pair.b)].name;
    });
    std::vector<std::pair<int, int>> taken;
    for (const Candidate& pair : kept) {
      if (!is_free(pair.a, pair.b)) continue;
      take(pair.a, pair.b);
      taken.emplace_back(pair.a, pair.b);
    }
    return taken;
  }

  // What is alike in everything but its orbits is compared as the same family, so that it is said what differs.
  template <class Alike>
  void match_rest(const std::vector<int>& as, const std::vector<int>& bs, const Alike& alike) {
    for (const int a : as)
      for (const int b : bs)
        if (is_free(a, b) && alike(_a.families[index(a)], _b.families[index(b)])) take(a, b);
  }

  void match_children(int crossing_a, int crossing_b) {
    const std::vector<int>& as = _a.crossings[index(crossing_a)].children;
    const std::vector<int>& bs = _b.crossings[index(crossing_b)].children;
    match_by_orbits(as, bs);
    match_rest(as, bs, [](const TreeFamily& x, const TreeFamily& y) {
      return x.multiplicity == y.multiplicity && x.isotropy == y.isotropy && x.name == y.name;
    });
    match_rest(as, bs, [](const TreeFamily& x, const TreeFamily& y) {
      return x.multiplicity == y.multiplicity && x.isotropy == y.isotropy;
    });
  }

  [[nodiscard]] static bool is_alike(const TreeCrossing& x, const TreeCrossing& y) {
    return x.kind == y.kind && x.multiplicity == y.multiplicity && x.sector_j == y.sector_j && x.sector_q == y.sector_q;
  }

  void match_crossings(const TreeFamily& a, const TreeFamily& b) {
    std::vector<int> by_period = b.crossings;
    const auto period_of = [&](int row) { return _b.crossings[index(row)].period; };
    std::sort(by_period.begin(), by_period.end(), [&](int x, int y) { return period_of(x) < period_of(y); });
    double widest = 0.0;
    for (const int row : by_period) widest = std::fmax(widest, _b.crossings[index(row)].place_error_period);
    std::vector<std::tuple<double, int, int>> pairs;
    for (const int row : a.crossings) {
      const TreeCrossing& x = _a.crossings[index(row)];
      const double reach = near_crossing * x.period + x.place_error_period + widest;
      auto other = std::lower_bound(by_period.begin(), by_period.end(), x.period - reach,
                                    [&](int candidate, double from) { return period_of(candidate) < from; });
      for (; other != by_period.end() && period_of(*other) <= x.period + reach; ++other) {
        const TreeCrossing& y = _b.crossings[index(*other)];
        if (is_alike(x, y) && apart_beyond_errors(x, y) <= near_crossing) pairs.emplace_back(apart(x, y), row, *other);
      }
    }
    std::sort(pairs.begin(), pairs.end());
    for (const auto& [away, x, y] : pairs) {
      if (_match.crossing_of_a[index(x)] >= 0 || _match.crossing_of_b[index(y)] >= 0) continue;
      _match.crossing_of_a[index(x)] = y;
      _match.crossing_of_b[index(y)] = x;
    }
  }

  // From every family that was matched on to those that were born on it.
  void follow() {
    while (!_open.empty()) {
      const TreeFamily& a = _a.families[index(_open.front())];
      const TreeFamily& b = _b.families[index(_match.family_of_a[index(_open.front())])];
      _open.pop_front();
      match_crossings(a, b);
      for (const int crossing : a.crossings)
        if (const int other = _match.crossing_of_a[index(crossing)]; other >= 0) match_children(crossing, other);
    }
  }

  void match_moved() {
    while (true) {
      std::vector<int> as;
      std::vector<int> bs;
      for (std::size_t n = 0; n < _a.families.size(); ++n)
        if (_match.family_of_a[n] < 0) as.push_back(static_cast<int>(n));
      for (std::size_t n = 0; n < _b.families.size(); ++n)
        if (_match.family_of_b[n] < 0) bs.push_back(static_cast<int>(n));
      const auto taken = match_by_orbits(as, bs);
      for (const auto& [a, b] : taken) _match.is_born_elsewhere[index(a)] = true;
      if (taken.empty()) return;
      follow();
    }
  }

  const AtlasTree& _a;
  const AtlasTree& _b;
  const LoopCheck& _loops;
  TreeMatch _match;
  std::deque<int> _open;  // families of A whose crossings are still to be matched
};

}  // namespace

TreeMatch match_trees(const AtlasTree& a, const AtlasTree& b, const LoopCheck& loops) {
  return Matcher(a, b, loops).run();
}

}  // namespace orbweaver::report
