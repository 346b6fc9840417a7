#include <map>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "orbweaver/core/error.hpp"
#include "orbweaver/scene/differences.hpp"

namespace differences_test {
namespace {

namespace scene = orbweaver::scene;
using scene::Change;
using testing::IsEmpty;
using testing::SizeIs;

const std::string base = "system: {name: double_pendulum}\nstarts: {}\n";

scene::Scene with(const std::vector<std::string>& overrides) { return scene::parse(base, "base.yaml", overrides); }

// What a key is unless it is given, another value of it, and what the change from the first to the second means.
struct Case {
  std::string standard;
  std::string other;
  Change change = Change::other;
};

// A new key of a scene needs a line here, and a place in differences.cpp.
const std::map<std::string, Case> cases{
    {"name", {"double_pendulum", "another", Change::free}},
    {"system.name", {"double_pendulum", "henon_heiles"}},
    {"system.parameters.m1", {"1", "2"}},
    {"system.parameters.m2", {"1.0", "2"}},
    {"system.parameters.l1", {"1", "0.5"}},
    {"system.parameters.l2", {"1", "0.5"}},
    {"system.parameters.g", {"1", "9.81"}},
    {"system.effects", {"[]", ""}},  // brings parameters: tested below
    {"system.scales.time", {"auto", "2"}},
    {"system.scales.th1", {"auto", ""}},  // 1, as of every angle
    {"system.scales.th2", {"auto", ""}},
    {"system.scales.w1", {"auto", "0.5"}},
    {"system.scales.w2", {"auto", "0.5"}},
    {"system.scales.energy", {"auto", "0.25"}},
    {"starts.fixed_points.grid", {"[[90]]", "[[91]]"}},
    {"starts.fixed_points.names", {"{}", "{[0, 180]: [Down-Up]}"}},
    {"starts.fixed_points.letters", {"{}", ""}},  // none without names
    {"starts.sweep.period", {"auto", "[1, 13]"}},
    {"starts.sweep.step", {"auto", "0.02"}},
    {"starts.states", {"[]", "[{state: [15, 0, 0.5, 0], period: 6.3, name: Eight}]"}},
    {"starts.orbits", {"[]", "[{archive: a.h5, family: A, near: {period: 9}, name: B}]"}},
    {"starts.loops", {"[]", "[{file: a.csv, period: 6.3, name: B}]"}},
    {"starts.recurrences.state", {"", ""}},  // only together: starts_section_test.cpp
    {"starts.recurrences.time", {"", ""}},
    {"starts.recurrences.period", {"", ""}},
    {"starts.recurrences.tolerance", {"", ""}},
    {"starts.recurrences.most", {"", ""}},
    {"continuation.step", {"adaptive", "0.5deg"}},
    {"continuation.start", {"0.5deg", "0.4deg"}},
    {"continuation.tolerance", {"1e-10", "1e-12"}},
    {"continuation.cutoff", {"[8, 4096]", "[8, 2048]"}},
    {"continuation.corrector", {"automatic", "brgn"}},
    {"continuation.free", {"", ""}},  // brings a scale, and the other two their meaning: tested below
    {"continuation.hold", {"", ""}},
    {"limits.parameter", {"", ""}},
    {"survey.depth", {"0", "1", Change::widened}},
    {"survey.subharmonics", {"4", "5"}},
    {"survey.spectrum", {"events", "all"}},
    {"survey.team_size", {"1", "2", Change::free}},
    {"compute.stability", {"true", "false"}},
    {"compute.certificate", {"automatic", "full"}},
    {"limits.period", {"30.0", "31", Change::widened}},
    {"limits.energy", {"[-.inf, .inf]", "[-10, .inf]", Change::narrowed}},
    {"limits.guards", {"", ""}},  // none in a system without guards: tested below
    {"limits.families", {"1000", "999", Change::narrowed}},
    {"limits.steps", {"5000", "5001", Change::widened}},
    {"limits.time", {".inf", "60", Change::free}},
    {"limits.task_time", {".inf", "60", Change::free}},
    {"events.periods", {"[]", "[10]"}},
    {"events.energies", {"[]", "[0.5]"}},
    {"loci", {"[]", "[{of: [period-doubling], free: [m2], range: [0.5, 2]}]"}},
    {"section.coordinate", {"", ""}},  // no section without one: tested below
    {"section.value", {"", ""}},
    {"output.flush_seconds", {"5", "6", Change::free}},
    {"output.flush_orbits", {"5000", "1", Change::free}},
};

// The keys that may stand under `path`, as the scene itself names them when it refuses another.
std::vector<std::string> keys_under(const std::string& path) {
  const std::string prefix = path.empty() ? "" : path + ".";
  try {
    static_cast<void>(with({prefix + "qqqqqqqqqqqqqqqqqqqq=1"}));
  } catch (const orbweaver::core::InputError& error) {
    const std::string text = error.what();
    std::string lead = "unknown key, expected ";
    const std::size_t begin = text.find(lead);
    if (begin == std::string::npos) return {};
    if (const std::string several = lead + "one of "; text.find(several) == begin) lead = several;
    std::string names = text.substr(begin + lead.size(), text.find(", got") - begin - lead.size());
    if (const std::size_t last = names.find(" or "); last != std::string::npos) names.replace(last, 4, ", ");
    std::vector<std::string> keys;
    for (std::size_t at = 0; at != std::string::npos;) {
      const std::size_t comma = names.find(", ", at);
      keys.push_back(prefix + names.substr(at, comma == std::string::npos ? comma : comma - at));
      at = comma == std::string::npos ? comma : comma + 2;
    }
    return keys;
  }
  return {};
}

void collect_keys(const std::string& path, std::vector<std::string>& leaves) {
  const std::vector<std::string> keys = keys_under(path);
  if (keys.empty()) leaves.push_back(path);
  for (const std::string& key : keys) collect_keys(key, leaves);
}

TEST(Differences, EveryKeyOfASceneIsClassified) {
  std::vector<std::string> leaves;
  collect_keys("", leaves);
  for (const char* key : {"system.active", "system.model_file"}) std::erase(leaves, key);  // of other models
  std::vector<std::string> tested;
  for (const auto& [key, ignored] : cases) tested.push_back(key);
  EXPECT_THAT(leaves, testing::UnorderedElementsAreArray(tested));
}

TEST(Differences, EachKeyIsFoundAloneAndNamed) {
  for (const auto& [key, values] : cases) {
    if (values.other.empty()) continue;
    SCOPED_TRACE(key);
    const scene::Scene standard = with({key + "=" + values.standard});
    const scene::Scene changed = with({key + "=" + values.other});
    std::vector<scene::Difference> found = differences(standard, changed);
    if (key == "system.name") {  // brings other parameters and coordinates, and another standard name
      std::erase_if(found, [](const auto& d) {
        return d.key.starts_with("system.parameters.") || d.key.starts_with("system.scales.") || d.key == "name";
      });
    }
    ASSERT_THAT(found, SizeIs(1));
    EXPECT_EQ(found[0].key, key);
    EXPECT_EQ(found[0].change, values.change);
    EXPECT_NE(found[0].before, found[0].now);
    if (key.starts_with("starts.fixed_points")) continue;  // completed to all coordinates
    EXPECT_EQ(found[0].now, values.other);
  }
}

TEST(Differences, OfFamiliesInAParameterAreFound) {
  const auto keys = [](const std::vector<std::string>& before, const std::vector<std::string>& now) {
    std::vector<std::string> found;
    for (const auto& difference : differences(with(before), with(now))) {
      found.push_back(difference.key);
      if (difference.key == "limits.parameter")
        EXPECT_EQ(difference.limit, scene::LimitKey::parameter);
      else
        EXPECT_EQ(difference.change, Change::other) << difference.key;
    }
    return found;
  };
  const std::string free = "continuation.free=m2";
  EXPECT_THAT(keys({}, {free}), testing::UnorderedElementsAre("continuation.free", "continuation.hold",
                                                              "limits.parameter", "system.scales.m2"));
  EXPECT_THAT(keys({free}, {free, "continuation.hold=period"}), testing::ElementsAre("continuation.hold"));
  EXPECT_THAT(keys({free}, {free, "limits.parameter=[0.5, 2]"}), testing::ElementsAre("limits.parameter"));
  EXPECT_THAT(keys({free, "limits.parameter=[0.5, 2]"}, {free, "limits.parameter=[0.5, 3]"}),
              testing::ElementsAre("limits.parameter"));
}

TEST(Differences, EffectsBringTheirParameters) {
  const auto keys = [](const std::vector<std::string>& before, const std::vector<std::string>& now) {
    std::vector<std::string> found;
    for (const auto& difference : differences(with(before), with(now))) found.push_back(difference.key);
    return found;
  };
  EXPECT_THAT(keys({}, {"system.effects=[rod_inertia]"}),
              testing::UnorderedElementsAre("system.effects", "system.parameters.rod1", "system.parameters.rod2"));
  EXPECT_THAT(keys({"system.effects=[rod_inertia]"}, {"system.effects=[rod_inertia]", "system.parameters={rod1: 2}"}),
              testing::ElementsAre("system.parameters.rod1"));
}

TEST(Differences, DefaultsAreFilledIn) {
  for (const auto& [key, values] : cases) {
    if (values.standard.empty() || key == "starts.fixed_points.grid") continue;
    SCOPED_TRACE(key);
    EXPECT_THAT(differences(with({}), with({key + "=" + values.standard})), IsEmpty());
  }
}

Change change(const std::string& before, const std::string& now) {
  const std::vector<scene::Difference> found = differences(with({before}), with({now}));
  EXPECT_THAT(found, SizeIs(1)) << before << " " << now;
  return found.empty() ? Change::free : found[0].change;
}

TEST(Differences, LimitsAreWiderOnlyIfNoEndMovesInward) {
  EXPECT_EQ(change("limits.period=30", "limits.period=.inf"), Change::widened);
  EXPECT_EQ(change("limits.period=.inf", "limits.period=30"), Change::narrowed);
  EXPECT_EQ(change("limits.steps=8", "limits.steps=7"), Change::narrowed);
  EXPECT_EQ(change("limits.families=8", "limits.families=9"), Change::widened);
  EXPECT_EQ(change("survey.depth=3", "survey.depth=1"), Change::narrowed);
  EXPECT_EQ(change("limits.energy=[-2, 2]", "limits.energy=[-2, 3]"), Change::widened);
  EXPECT_EQ(change("limits.energy=[-2, 2]", "limits.energy=[-3, 2]"), Change::widened);
  EXPECT_EQ(change("limits.energy=[-2, 2]", "limits.energy=[-1, 3]"), Change::narrowed);
  EXPECT_EQ(change("limits.energy=[-2, 2]", "limits.energy=[-3, 1]"), Change::narrowed);
  EXPECT_EQ(change("limits.time=20", "limits.time=10"), Change::free);
}

TEST(Differences, GuardsAreLimitsOfTheirOwn) {
  const auto of = [](const std::string& guards) {
    return scene::parse("system: {name: pcr3bp}\nstarts: {}\n", "base.yaml", {"limits.guards=" + guards});
  };
  const auto found = [&](const std::string& before, const std::string& now) {
    return differences(of(before), of(now));
  };
  EXPECT_THAT(found("{}", "{}"), IsEmpty());
  EXPECT_THAT(found("{r2: 0.0045}", "{r2: 4.5e-3}"), IsEmpty());
  const auto lower = found("{r1: 0.1, r2: 0.0045}", "{r1: 0.1, r2: 0.001}");
  ASSERT_EQ(lower.size(), 1U);
  EXPECT_EQ(lower[0].key, "limits.guards.r2");
  EXPECT_EQ(lower[0].limit, scene::LimitKey::guards);
  EXPECT_EQ(lower[0].before + " " + lower[0].now, "0.0045 0.001");
  EXPECT_EQ(lower[0].change, Change::widened);
  EXPECT_EQ(found("{r2: 0.001}", "{r2: 0.0045}").at(0).change, Change::narrowed);
  EXPECT_EQ(found("{r2: 0.001}", "{}").at(0).change, Change::widened);
  EXPECT_EQ(found("{}", "{r2: 0.001}").at(0).change, Change::narrowed);
}

TEST(Differences, TheParameterIsALimit) {
  const auto of = [](const std::string& range) {
    return scene::parse("system: {name: lorenz}\nstarts: {}\ncontinuation: {free: rho}\n", "base.yaml",
                        {"limits.parameter=" + range});
  };
  const auto found = differences(of("[1, 30]"), of("[0, 30]"));
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].limit, scene::LimitKey::parameter);
  EXPECT_EQ(found[0].change, Change::widened);
  EXPECT_EQ(differences(of("[1, 30]"), of("[0, 29]")).at(0).change, Change::narrowed);
}

TEST(Differences, LimitsAreNamed) {
  using scene::LimitKey;
  const std::map<std::string, std::optional<LimitKey>> limits{{"limits.period", LimitKey::period},
                                                              {"limits.energy", LimitKey::energy},
                                                              {"limits.steps", LimitKey::steps},
                                                              {"survey.depth", LimitKey::depth},
                                                              {"limits.families", LimitKey::families}};
  for (const auto& [key, values] : cases) {
    if (values.other.empty()) continue;
    const auto limit = limits.find(key);
    const auto found = differences(with({key + "=" + values.standard}), with({key + "=" + values.other}));
    ASSERT_FALSE(found.empty()) << key;
    EXPECT_EQ(found[0].limit, limit == limits.end() ? std::nullopt : limit->second) << key;
  }
}

TEST(Differences, SayBothValuesAsAUserWouldWriteThem) {
  const auto found = differences(with({"limits.energy=[-1.50, 2]", "continuation.step=0.7deg", "limits.time=90.5"}),
                                 with({"limits.energy=[-.inf, 2.25]", "continuation.step=0.02rad"}));
  ASSERT_THAT(found, SizeIs(3));
  EXPECT_EQ(found[0].key, "continuation.step");
  EXPECT_EQ(found[0].before, "0.7deg");
  EXPECT_EQ(found[1].before, "[-1.5, 2]");
  EXPECT_EQ(found[1].now, "[-.inf, 2.25]");
  EXPECT_EQ(found[2].now, ".inf");
}

TEST(Differences, SayLengthsWithoutAUnitWhereThereAreNoAngles) {
  const std::string text = "system: {name: henon_heiles}\nstarts: {}\n";
  const auto found = differences(scene::parse(text, "one"),
                                 scene::parse(text, "two", {"continuation.step=0.5", "continuation.start=1e-3"}));
  ASSERT_THAT(found, SizeIs(2));
  EXPECT_EQ(found[0].now, "0.5");
  EXPECT_EQ(found[1].before, "auto");  // a number of the survey's scales
  EXPECT_EQ(found[1].now, "0.001");
}

TEST(Differences, NotationUnitsAndOrderOfKeysDoNotCount) {
  const std::string one = R"(# the one
name: double-pendulum
system: {name: double_pendulum, parameters: {g: 9.81, m1: 1.0}}
starts:
  fixed_points: {grid: [[0, 180.0], [-9e1]], names: {[0, 180]: [Down-Up], [180]: [Up-Down]}, letters: {Down-Up: D}}
continuation: {step: 90deg}
section: {coordinate: th1, value: 45}
)";
  const std::string same = R"(section: {value: 4.5e+1, coordinate: "th1"}
continuation: {step: 1.5707963267948966rad, start: 0.50deg, tolerance: 0.0000000001}
starts:
  fixed_points:
    letters: {Down-Up: D}
    names: {[180]: [Up-Down], [0, 180.0, 0]: ["Down-Up"]}
    grid: [[0.0, 180], [-90], [0]]
system: {parameters: {m1: 1, g: 9.810}, name: double_pendulum}
name: double-pendulum
)";
  EXPECT_THAT(differences(scene::parse(one, "one"), scene::parse(same, "same")), IsEmpty());
  const auto found = differences(scene::parse(one, "one"), scene::parse(one, "one", {"section.value=46"}));
  ASSERT_THAT(found, SizeIs(1));
  EXPECT_EQ(found[0].before, "45");
  EXPECT_EQ(found[0].now, "46");
  EXPECT_EQ(found[0].change, Change::other);
}

TEST(Differences, ASectionThatOnlyOneSceneHasIsAnotherScene) {
  const auto found = differences(with({}), with({"section={coordinate: w1, value: 2}"}));
  ASSERT_THAT(found, SizeIs(2));
  EXPECT_EQ(found[0].key, "section.coordinate");
  EXPECT_EQ(found[0].now, "w1");
  EXPECT_EQ(found[1].key, "section.value");
  EXPECT_EQ(found[1].change, Change::other);
}

// As a later version might read, whose keys this one does not know.
TEST(Differences, AnUnknownKeyIsAnotherSceneUnlessItIsKnownToBeFree) {
  const auto found = [](const std::string& before, const std::string& now) {
    scene::Scene a = with({});
    scene::Scene b = with({});
    a.text = base + before;
    b.text = base + now;
    return differences(a, b);
  };
  const auto other = found("limits: {period: 30, colour: 7}\n", "limits: {period: 30, colour: 8}\n");
  ASSERT_THAT(other, SizeIs(1));
  EXPECT_EQ(other[0].key, "limits.colour");
  EXPECT_EQ(other[0].before, "7");
  EXPECT_EQ(other[0].now, "8");
  EXPECT_EQ(other[0].change, Change::other);
  EXPECT_THAT(found("limits: {colour: 7}\n", "limits: {colour: 7.0}\n"), IsEmpty());
  EXPECT_THAT(found("", "weather: {rain: {drops: [1, 2]}}\n"), SizeIs(1));
  EXPECT_EQ(found("weather: {rain: {drops: [1, 2]}}\n", "")[0].key, "weather.rain.drops");
  EXPECT_EQ(found("output: {compression: 7}\n", "")[0].change, Change::free);
}

TEST(Differences, ASceneComesBackFromItsTextAsItWas) {
  const scene::Scene once = with({"limits.period=12.5", "starts.fixed_points.grid=[[0, 180], [0, 0.1]]",
                                  "starts.fixed_points.names={[0, 180]: [Down-Up]}", "continuation.step=0.3deg"});
  const scene::Scene again = scene::parse(once.text, "the checkpoint");
  EXPECT_THAT(differences(once, again), IsEmpty());
  EXPECT_EQ(again.text, once.text);
}

}  // namespace
}  // namespace differences_test
