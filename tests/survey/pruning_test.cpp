#include "tree/pruning.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <optional>
#include <random>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include <fmt/format.h>

#include "tasks/payload/keys.hpp"

namespace pruning_test {
namespace {

using namespace orbweaver::survey;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

using Keys = std::set<std::string>;

/// A branch that ends and has passed the first orbits of base families, or a place where a branch may have arrived.
struct Event {
  std::string branch;
  Lineage lineage;
  std::optional<Meeting> meeting;
  std::vector<std::string> passed;
};

std::string crossing_of(const std::string& key) { return key.substr(0, key.rfind('/')); }

Event ends(const std::string& key) {
  const bool two_sided = key.back() == '+' || key.back() == '-';
  const bool is_given = key.starts_with("0002.");  // two sides of one base family
  Event event{key, {}, {}, {}};
  event.lineage.family =
      two_sided && (is_given || key.find('/') != std::string::npos) ? key.substr(0, key.size() - 1) : key;
  event.lineage.crossing = crossing_of(key);
  event.lineage.depth = depth_of(key);
  event.lineage.side = key.back() == '-' ? -1 : 1;
  return event;
}

Event meets(const std::string& key, const std::string& start, double away) {
  Event event{key, {}, {}, {}};
  event.meeting = Meeting{crossing_of(start), side_of(ends(start).lineage), away};
  return event;
}

/// The rule as it is said, from nothing, with everything compared with everything.
class Plainly {
 public:
  explicit Plainly(const std::vector<Event>& events) {
    for (const Event& event : events) {
      if (event.meeting)
        _meetings[event.branch].push_back(*event.meeting);
      else
        _branches.emplace_back(event.lineage.depth, event.branch, side_of(event.lineage));
      _passed[event.branch].insert(event.passed.begin(), event.passed.end());
    }
    std::sort(_branches.begin(), _branches.end());
    for (auto& [key, meetings] : _meetings)
      std::sort(meetings.begin(), meetings.end(), [](const Meeting& a, const Meeting& b) {
        return std::tie(a.away, a.crossing) < std::tie(b.away, b.crossing);
      });
    for (rounds = 1;; ++rounds) {
      const Keys ruled = round();
      Keys next;
      for (const std::string& key : ruled)
        if (rounds <= Pruning::free_rounds || dropped.contains(key)) next.insert(key);
      for (const std::string& key : ruled)
        if (!next.contains(key)) disputed.insert(key);
      if (next == dropped) break;
      dropped = next;
      disputed.clear();
    }
  }

  [[nodiscard]] std::optional<Side> arrival(const std::string& key) const {
    const auto found = _meetings.find(key);
    if (found == _meetings.end()) return std::nullopt;
    for (const Meeting& meeting : found->second)
      if (!lies_on_one_of(meeting.crossing, dropped)) return meeting.along;
    return std::nullopt;
  }
  [[nodiscard]] bool would_be_dropped(const Event& event) const {
    if (lies_on_one_of(event.branch, dropped)) return true;
    return std::any_of(_branches.begin(), _branches.end(), [&](const auto& other) {
      const auto& [depth, key, side] = other;
      return std::tie(depth, key) < std::tie(event.lineage.depth, event.branch) && !dropped.contains(key) &&
             (arrival(key) == side_of(event.lineage) || _passed.at(key).contains(event.lineage.family));
    });
  }

  Keys dropped;
  Keys disputed;
  int rounds = 0;

 private:
  static bool lies_on_one_of(const std::string& key, const Keys& branches) {
    for (std::size_t slash = key.find('/'); slash != std::string::npos; slash = key.find('/', slash + 1))
      if (branches.contains(key.substr(0, slash))) return true;
    return false;
  }
  [[nodiscard]] Keys round() const {
    const std::size_t count = _branches.size();
    std::vector<std::optional<Side>> at(count);
    for (std::size_t n = 0; n < count; ++n) at[n] = arrival(std::get<1>(_branches[n]));
    Keys out;
    for (std::size_t n = 0; n < count; ++n) {
      const auto& [depth, key, side] = _branches[n];
      bool drop = lies_on_one_of(key, out);
      for (std::size_t m = 0; m < n; ++m) {
        const std::string& earlier = std::get<1>(_branches[m]);
        drop = drop || ((at[m] == side || _passed.at(earlier).contains(side.family)) && !out.contains(earlier));
      }
      if (drop) out.insert(key);
    }
    const Keys by_earlier = out;
    for (std::size_t n = 0; n < count; ++n) {
      const auto& [depth, key, side] = _branches[n];
      bool drop = lies_on_one_of(key, out);
      for (std::size_t m = n + 1; m < count; ++m) {
        const auto& [other_depth, other, other_side] = _branches[m];
        drop = drop || (at[m] == side && !by_earlier.contains(other) && !lies_on_one_of(other, {key}) &&
                        at[n] != std::optional(other_side));
      }
      if (drop) out.insert(key);
    }
    return out;
  }

  std::vector<std::tuple<int, std::string, Side>> _branches;
  std::map<std::string, std::vector<Meeting>> _meetings;
  std::map<std::string, std::set<std::string>> _passed;
};

class Grown {
 public:
  void add(const Event& event) {
    const std::vector<std::string> changed = event.meeting
                                                 ? pruning.add_meetings({{event.branch, *event.meeting}})
                                                 : pruning.add_branch(event.branch, event.lineage, {}, event.passed);
    if (!event.meeting) _ended.insert(event.branch);
    for (const std::string& key : changed)
      if (!_told.insert(key).second) _told.erase(key);
  }
  [[nodiscard]] Keys dropped() const {
    Keys out;
    for (const std::string& key : _ended)
      if (pruning.is_dropped(key)) out.insert(key);
    return out;
  }
  /// By what the additions returned.
  [[nodiscard]] const Keys& told() const { return _told; }
  Pruning pruning;

 private:
  Keys _ended;
  Keys _told;
};

void expect_as_plainly(const Grown& grown, const std::vector<Event>& events) {
  const Plainly plain(events);
  ASSERT_EQ(grown.dropped(), plain.dropped);
  const std::vector<std::string> disputed = grown.pruning.disputed();
  ASSERT_EQ(Keys(disputed.begin(), disputed.end()), plain.disputed);
  for (const Event& event : events) {
    if (event.meeting) continue;
    const Meeting* arrival = grown.pruning.arrival(event.branch);
    ASSERT_EQ(arrival ? std::optional(arrival->along) : std::nullopt, plain.arrival(event.branch)) << event.branch;
    ASSERT_EQ(grown.pruning.would_be_dropped(event.branch, event.lineage), plain.would_be_dropped(event))
        << event.branch;
  }
}

/// A tree whose branches arrive at random at the starts of others, often of several: far more confused than those of
/// surveys.
std::vector<Event> random_tree(std::mt19937& random, std::size_t size) {
  const auto below = [&](std::size_t n) { return random() % n; };
  std::vector<std::string> keys{"0000.0000", "0000.0001+", "0000.0001-", "0001.0000", "0002.0000+", "0002.0000-"};
  while (keys.size() < size) {
    const std::string& parent = keys[below(keys.size())];
    const std::string family = fmt::format("{}/{:03}.q2.j1/{}", parent, below(3), below(2));
    const bool two_sided = below(3) == 0;
    for (const char* side : {"+", "-"}) {
      const std::string key = two_sided ? family + side : family;
      if (std::find(keys.begin(), keys.end(), key) == keys.end()) keys.push_back(key);
      if (!two_sided) break;
    }
  }
  std::vector<std::string> ended;  // the others' tasks have not, or never will
  for (const std::string& key : keys)
    if (below(8) != 0) ended.push_back(key);
  std::vector<Event> events;
  for (const std::string& key : ended) {
    events.push_back(ends(key));
    for (const char* given : {"0001.0000", "0002.0000"})
      if (depth_of(key) == 0 && ends(key).lineage.family < given && below(6) == 0)
        events.back().passed.emplace_back(given);
  }
  for (const std::string& key : ended)
    for (std::size_t n = below(4); n > 1; --n) {
      const std::string& start = keys[below(keys.size())];
      if (depth_of(start) == 0) continue;
      const Event meeting = meets(key, start, 0.1 * static_cast<double>(below(4)));
      const auto is_known = [&](const Event& event) {
        return event.branch == key && event.meeting && event.meeting->crossing == meeting.meeting->crossing;
      };
      if (std::none_of(events.begin(), events.end(), is_known)) events.push_back(meeting);
    }
  return events;
}

/// In a random order, but a branch before its meetings.
void shuffle(std::vector<Event>& events, std::mt19937& random) {
  std::shuffle(events.begin(), events.end(), random);
  for (std::size_t n = 0; n < events.size(); ++n) {
    if (events[n].meeting) continue;
    const auto before = std::find_if(events.begin(), events.begin() + static_cast<std::ptrdiff_t>(n),
                                     [&](const Event& e) { return e.branch == events[n].branch; });
    std::iter_swap(before, events.begin() + static_cast<std::ptrdiff_t>(n));
  }
}

TEST(Pruning, IsTheSameInEveryOrderAndAfterEveryAddition) {
  std::mt19937 random(20);
  int most_rounds = 0;
  int with_disputed = 0;
  std::size_t dropped = 0;
  for (int tree = 0; tree < 300; ++tree) {
    std::vector<Event> events = random_tree(random, 4 + random() % 36);
    for (int order = 0; order < 3; ++order) {
      shuffle(events, random);
      Grown grown;
      for (std::size_t n = 0; n < events.size(); ++n) {
        grown.add(events[n]);
        if (order > 0 && n + 1 < events.size()) continue;
        SCOPED_TRACE(fmt::format("tree {}, after {} of {} additions in order {}", tree, n + 1, events.size(), order));
        ASSERT_NO_FATAL_FAILURE(expect_as_plainly(grown, {events.begin(), events.begin() + static_cast<long>(n) + 1}));
        ASSERT_EQ(grown.told(), grown.dropped());
      }
    }
    const Plainly plain(events);
    most_rounds = std::max(most_rounds, plain.rounds);
    with_disputed += plain.disputed.empty() ? 0 : 1;
    dropped += plain.dropped.size();
  }
  // What the trees have shown.
  EXPECT_GT(most_rounds, Pruning::free_rounds);
  EXPECT_GT(with_disputed, 0);
  EXPECT_GT(dropped, 300U);
}

// The second family passes the start of the third, but lies on the first; what it passes is dropped if the first passes
// it as well.
TEST(Pruning, DropsFamiliesWhoseFirstOrbitAnEarlierOneHasPassed) {
  Pruning pruning;
  const auto end = [&](const std::string& key, const std::vector<std::string>& passed) {
    return pruning.add_branch(key, ends(key).lineage, {}, passed);
  };
  end("0002.0000+", {});
  EXPECT_FALSE(pruning.is_dropped("0002.0000+"));
  EXPECT_FALSE(pruning.would_be_dropped("0002.0000-", ends("0002.0000-").lineage));
  EXPECT_THAT(end("0001.0000", {"0002.0000"}), ElementsAre("0002.0000+"));
  EXPECT_TRUE(pruning.would_be_dropped("0002.0000-", ends("0002.0000-").lineage));
  EXPECT_THAT(end("0000.0000", {"0001.0000"}), testing::UnorderedElementsAre("0001.0000", "0002.0000+"));
  EXPECT_TRUE(pruning.is_dropped("0001.0000"));
  EXPECT_FALSE(pruning.is_dropped("0002.0000+")) << "a curve that is recorded twice is better than one that is lost";
  end("0000.0001+", {"0002.0000"});
  EXPECT_TRUE(pruning.is_dropped("0002.0000+"));
}

// A arrives at P's start and, a little farther off, at B's; P lies elsewhere, but its start is where B arrives. If P
// stays, A meets on P's child; if it does not, A meets B, so B does not stay, and P does.
TEST(Pruning, KeepsAndTellsWhatContradictsItself) {
  const std::string a = "0000.0000/000.q2.j1/0";
  const std::string b = "0000.0000/001.q2.j1/0";
  const std::string p = "0000.0000/002.q2.j1/0";
  const std::string on_p = p + "/000.q2.j1/0";
  Pruning pruning;
  const auto end = [&](const std::string& key, const std::vector<Meeting>& meetings) {
    pruning.add_branch(key, ends(key).lineage, meetings);
  };
  end("0000.0000", {});
  end(a, {*meets(a, on_p, 0.1).meeting, *meets(a, b, 0.2).meeting});
  end(b, {});
  end(p, {});
  EXPECT_THAT(pruning.disputed(), IsEmpty());
  pruning.add_meetings({{b, *meets(b, p, 0.1).meeting}});
  EXPECT_FALSE(pruning.is_dropped(b));
  EXPECT_FALSE(pruning.is_dropped(p));
  EXPECT_THAT(pruning.disputed(), ElementsAre(p));
}

}  // namespace
}  // namespace pruning_test
