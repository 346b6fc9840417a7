#include "orbweaver/scene/known_keys.hpp"

#include <array>
#include <cctype>
#include <stdexcept>

#include <fmt/format.h>

namespace orbweaver::scene {

namespace {

constexpr std::string_view must_be_given = "required";
constexpr std::string_view unit_of_states = "deg for angles, else the coordinate's own";
constexpr std::string_view unit_of_lengths =
    "deg or rad, behind the number; without angles those of the coordinate with the largest scale (`check`)";

constexpr std::array table_of_keys{
    KnownKey{"name", "text", "the system's name", "", "what the archive calls the survey"},

    KnownKey{"system", "a map", must_be_given, "", "the equations of motion"},
    KnownKey{"system.name", "one of the program's systems", "none: there are equations", "",
             "which system, or the name of a model that has equations here (docs/models.md); `orbweaver systems` lists "
             "them"},
    KnownKey{"system.parameters", "a map", "`{}`", "as `orbweaver systems` says",
             "values by name, of the system and of its effects; those left out have their standard value"},
    KnownKey{"system.effects", "a list", "`[]`", "",
             "what is added to the ideal system, such as `damping`; `orbweaver systems` lists them"},
    KnownKey{
        "system.scales", "a map", "`auto`", "that of what it scales",
        "units in which times, coordinates, conserved quantities and the parameter that moves are measured wherever "
        "something is decided: by name, or `auto`, all or any of them found from the equilibria. Angles have 1"},

    KnownKey{"starts", "a map", must_be_given, "", "from what families are followed (docs/starts.md)"},
    KnownKey{"starts.fixed_points", "a map", "none", "", "equilibria, where small oscillations begin families"},
    KnownKey{"starts.fixed_points.grid", "a list", "none: no equilibria are looked for", unit_of_states,
             "a list of values a coordinate, in the system's order; Newton's method starts from every combination. "
             "Trailing coordinates that are left out start at 0"},
    KnownKey{"starts.fixed_points.names", "a map", "`{}`", unit_of_states,
             "names of families: the key is the equilibrium, given as in the grid (`[0, 180]`), the value a list of "
             "names, longest period first; a place where no equilibrium lies is refused"},
    KnownKey{"starts.fixed_points.letters", "a map", "`{}`", "",
             "1 to 4 letters for a family of `names`, with which the names of its branches begin"},
    KnownKey{"starts.sweep", "a map", "none", "", "which small oscillations, and the picture of their eigenvalue"},
    KnownKey{"starts.sweep.period", "a list of two numbers > 0, from and to, or auto", "`auto`", "time",
             "oscillations with periods in this range begin families; `auto`: all"},
    KnownKey{"starts.sweep.step", "a number > 0, or auto", "`auto`: 0.01, of an automatic range a thousandth", "time",
             "how finely the smallest eigenvalue is drawn over the range"},
    KnownKey{"starts.states", "a list", "`[]`", "", "orbits that are known by a state and a period"},
    KnownKey{"starts.states[].state", "a list", must_be_given, unit_of_states, "all coordinates at t = 0"},
    KnownKey{"starts.states[].period", "a number > 0", must_be_given, "time", "its period"},
    KnownKey{"starts.states[].name", "text", "what the first orbit is", "", "the name of the family"},
    KnownKey{"starts.orbits", "a list", "`[]`", "", "orbits of another archive"},
    KnownKey{"starts.orbits[].archive", "text", must_be_given, "",
             "its file or its survey's folder, told from the scene's folder"},
    KnownKey{"starts.orbits[].family", "text", must_be_given, "", "the name of the family there"},
    KnownKey{"starts.orbits[].near", "a map", must_be_given, "",
             "one of the next three: the orbit whose value is nearest"},
    KnownKey{"starts.orbits[].near.period", "a number > 0", "none", "time", "by its period"},
    KnownKey{"starts.orbits[].near.energy", "a finite number", "none", "energy", "by its energy"},
    KnownKey{"starts.orbits[].near.step", "a finite number", "none", "", "by its number along the family"},
    KnownKey{"starts.orbits[].name", "text", "what the first orbit is", "", "the name of the family"},
    KnownKey{"starts.orbits[].hash", "text", "the file's", "",
             "the file's hash (SHA-1); stands in the scene that an archive holds"},
    KnownKey{"starts.loops", "a list", "`[]`", "", "orbits of which samples are known"},
    KnownKey{"starts.loops[].file", "text", must_be_given, "",
             "a table in CSV, `t` and all coordinates, told from the scene's folder"},
    KnownKey{"starts.loops[].period", "a number > 0", must_be_given, "time", "its period"},
    KnownKey{"starts.loops[].name", "text", "what the first orbit is", "", "the name of the family"},
    KnownKey{"starts.loops[].hash", "text", "the file's", "",
             "the file's hash (SHA-1); stands in the scene that an archive holds"},
    KnownKey{"starts.recurrences", "a map", "none", "", "orbits that a trajectory comes near"},
    KnownKey{"starts.recurrences.state", "a list", must_be_given, unit_of_states,
             "where the trajectory begins, all coordinates"},
    KnownKey{"starts.recurrences.time", "a number > 0", must_be_given, "time", "its length"},
    KnownKey{"starts.recurrences.period", "a list of two numbers > 0, from and to", must_be_given, "time",
             "of the orbits that are looked for, at most `time`"},
    KnownKey{"starts.recurrences.tolerance", "a number > 0 and <= 1", "`0.1`", "the survey's scales",
             "how near the trajectory must return"},
    KnownKey{"starts.recurrences.most", "an integer >= 1", "`1000`", "",
             "orbits kept, those with the shortest periods"},

    KnownKey{"continuation", "a map", "none", "", "how one family is followed"},
    KnownKey{"continuation.step",
             "`adaptive` or an angle with its unit, > 0 and at most 90deg; without angles `adaptive` or a number > 0",
             "`adaptive`", unit_of_lengths, "or a fixed step, the distance in phase space at s = 0"},
    KnownKey{"continuation.start", "an angle with its unit, > 0 and at most 90deg; without angles a number > 0",
             "`0.5deg`; without angles 0.0087 of the scales", unit_of_lengths,
             "distance of the first orbit from its equilibrium, at s = 0"},
    KnownKey{"continuation.tolerance", "a number from 1e-14 to 0.001", "`1e-10`", "",
             "an orbit is accepted when sqrt(loss) < tolerance * min(1, rms |dz/dt|), or rounding allows no less"},
    KnownKey{"continuation.cutoff", "a list of two integers from 1 to 1000000, from and to", "`[8, 4096]`", "",
             "least and greatest number of harmonics"},
    KnownKey{"continuation.corrector",
             "one of automatic, collocation, newton-krylov, brgn, nls, ntr, lmvm, rprop or rprop-extrapolated",
             "`automatic`", "", "what solves for an orbit; `automatic` chooses by size"},
    KnownKey{"continuation.free", "one of the system's parameters", "none", "",
             "the parameter that moves along families; required where nothing is conserved"},
    KnownKey{"continuation.hold", "one of energy or period", "`energy`", "",
             "with `free` in a conservative system: what is held"},

    KnownKey{"survey", "a map", "none", "", "how far branches are followed"},
    KnownKey{"survey.depth", "an integer from 0 to 16", "`0`", "",
             "generations of branches: 0 has base families only, 1 their branches too"},
    KnownKey{"survey.subharmonics", "an integer from 1 to 16", "`4`", "",
             "branches that close after up to this many periods"},
    KnownKey{"survey.spectrum", "one of all or events", "`events`", "",
             "where the smallest eigenvalue off the branch is computed: at `events` only, or for `all` orbits"},
    KnownKey{"survey.team_size", "an integer from 1 to 1000000", "`1`", "",
             "ranks that share one task; more than 1 is for systems of high dimension"},

    KnownKey{"compute", "a map", "none", "", "what is computed of each orbit"},
    KnownKey{"compute.stability", "one of true or false", "`true`", "",
             "multipliers, and with them every crossing but folds; false with `survey.depth: 0` only"},
    KnownKey{"compute.certificate", "one of automatic, none, closure or full", "`automatic`", "",
             "an independent check of every orbit: none, closure, or full (its distance to the true orbit and its "
             "multipliers too), as tasks at the end; automatic: closure, as each orbit is found"},

    KnownKey{"limits", "a map", "none", "", "where a family ends if nothing else ends it first"},
    KnownKey{"limits.period", "a number > 0 or infinite", "`30`", "time", "the longest period"},
    KnownKey{"limits.energy", "a list of two numbers, from and to, which may be infinite", "`[-.inf, .inf]`", "energy",
             "the least and the greatest energy, where one is conserved"},
    KnownKey{"limits.parameter", "a list of two numbers, from and to, which may be infinite", "what the model allows",
             "the parameter's", "with `continuation.free`: the least and the greatest value of that parameter"},
    KnownKey{"limits.guards", "a map", "no limits", "each its own",
             "the least values that the system's guards (`orbweaver systems`) may take on an orbit, by name"},
    KnownKey{"limits.families", "an integer >= 1", "`1000`", "", "families in all"},
    KnownKey{"limits.steps", "an integer >= 1", "`5000`", "", "orbits a family"},
    KnownKey{"limits.time", "a number > 0 or infinite", "`.inf`", "s",
             "for the whole survey; what runs then is cut short, and the exit status is 4"},
    KnownKey{"limits.task_time", "a number > 0 or infinite", "`.inf`", "s",
             "for one task; a longer one is put aside for `--resume`, and the exit status is 4"},

    KnownKey{"events", "a map", "none", "", "orbits to be located exactly, besides crossings"},
    KnownKey{"events.periods", "a list", "`[]`", "time", "where a family has one of these periods"},
    KnownKey{"events.energies", "a list", "`[]`", "energy",
             "where a family has one of these energies, where one is conserved"},

    KnownKey{"section", "a map", "no section", "", "a Poincare section"},
    KnownKey{"section.coordinate", "one of the system's coordinates", must_be_given, "",
             "which coordinate passes the value"},
    KnownKey{"section.value", "a finite number", "`0`", unit_of_states, "the value"},

    KnownKey{"loci", "a list", "`[]`", "", "curves in two parameters of what is located along families"},
    KnownKey{"loci[].of", "a list", must_be_given, "",
             "of what: fold-period, fold-energy, fold-parameter, period-doubling, branch-point, torus"},
    KnownKey{"loci[].free", "a list", must_be_given, "", "the second parameter, one name"},
    KnownKey{"loci[].range", "a list of two numbers, from and to", "what the model allows", "the parameter's",
             "its limits, which have the scene's value between them"},

    KnownKey{"output", "a map", "none", "", "how often all ranks write their orbits together, whichever comes first"},
    KnownKey{"output.flush_seconds", "a number > 0", "`5`", "s", "after this time"},
    KnownKey{"output.flush_orbits", "an integer >= 1", "`5000`", "", "after this many orbits"},
};

/// "loci[]" of "loci[2]".
std::string without_indices(std::string_view path) {
  std::string text;
  bool is_index = false;
  for (const char c : path) {
    is_index = c == '[' || (is_index && std::isdigit(static_cast<unsigned char>(c)) != 0);
    if (!is_index || c == '[') text += c;
  }
  return text;
}

}  // namespace

std::string_view KnownKey::section() const {
  const std::size_t dot = path.rfind('.');
  return dot == std::string_view::npos ? std::string_view{} : path.substr(0, dot);
}

std::string_view KnownKey::name() const { return path.substr(path.rfind('.') + 1); }

std::span<const KnownKey> known_keys() { return table_of_keys; }

std::vector<std::string> names_of_keys(std::string_view section) {
  const std::string wanted = without_indices(section);
  std::vector<std::string> names;
  for (const KnownKey& key : table_of_keys)
    if (key.section() == wanted) names.emplace_back(key.name());
  if (names.empty()) throw std::logic_error(fmt::format("no known key is in `{}`", wanted));
  return names;
}

}  // namespace orbweaver::scene
