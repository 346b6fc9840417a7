#pragma once

#include <filesystem>
#include <limits>
#include <map>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "orbweaver/scene/loop_samples.hpp"
#include "orbweaver/systems/system.hpp"
#include "orbweaver/systems/text/model_text.hpp"

namespace orbweaver::scene {

struct SystemChoice {
  std::string name;
  std::shared_ptr<const systems::ModelText> model;  ///< null for one that a program has recorded
  std::map<std::string, double> parameters;
  std::vector<std::string> effects;
  /// Scales that the scene gives, by name: time, a coordinate, a conserved quantity. The others are found (`auto`).
  std::map<std::string, double> scales;
  systems::FamilyScalars moving;  ///< what moves along its families (continuation.free, continuation.hold)
};

/// The system with its parameters, effects and kind of families, in their units.
[[nodiscard]] std::shared_ptr<const systems::System> bound_system(const SystemChoice& choice);
/// What may be asked of it.
[[nodiscard]] const systems::ModelInfo& info_of(const SystemChoice& choice);

/// Where the search for equilibria starts, and what the user calls the families found there.
struct FixedPoints {
  /// One list of values a coordinate, angles in radians; missing coordinates start at 0.
  std::vector<std::vector<double>> grid;
  struct Names {
    std::vector<double> point;       ///< the leading coordinates of the equilibrium, angles in radians
    std::vector<std::string> names;  ///< its families, longest normal-mode period first
  };
  std::vector<Names> names;
  std::map<std::string, std::string> letters;  ///< family name -> letter for its branches
};

/// An orbit that is known: its state at t = 0 and its period, near enough for Newton's method.
struct StateStart {
  std::vector<double> state;  ///< angles in radians
  double period = 0.0;
  std::string name;  ///< empty: by what its family is
};

/// A file that a scene names. Its place is told from the scene's folder; a stored scene has its hash alone.
struct StartFile {
  std::string path;            ///< as the scene says
  std::filesystem::path file;  ///< empty in a stored scene
  std::string hash;            ///< core::file_hash; empty where neither the file nor a hash is given
};

/// An orbit of another archive of the same system, as a guess where its parameters are others.
struct OrbitStart {
  enum class Near { period, energy, step };
  StartFile archive;
  std::string family;  ///< its name there
  Near near = Near::period;
  double value = 0.0;  ///< in the units of that archive
  std::string name;    ///< empty: by what its family is
};
/// "period", ...: as in a scene.
[[nodiscard]] std::string name_of(OrbitStart::Near near);

/// A loop of which samples are known.
struct LoopStart {
  StartFile file;
  double period = 0.0;
  std::string name;     ///< empty: by what its family is
  LoopSamples samples;  ///< none in a stored scene
};

/// Orbits that a trajectory comes near.
struct Recurrences {
  std::vector<double> state;  ///< at its begin, angles in radians
  double time = 0.0;          ///< its length
  double period_from = 0.0;   ///< of the orbits
  double period_to = 0.0;
  double tolerance = 0.1;  ///< greatest distance of what counts as a return, in the survey's scales
  int most = 1000;         ///< orbits kept, those with the shortest periods
};

/// At which periods small oscillations are looked for, and how finely the picture of their eigenvalue is drawn.
struct Sweep {
  struct Range {
    double from = 0.0;
    double to = 0.0;
  };
  static constexpr double most_steps = 1e6;  ///< of a range; a finer step is refused, or lengthened with `period: auto`
  static constexpr double standard_step = 0.01;  ///< the paper's
  std::optional<Range> period;  ///< none (`auto`): at each equilibrium a range that covers its oscillations
  std::optional<double> step;   ///< none (`auto`): the standard step, or a thousandth of an automatic range
};

struct Continuation {
  /// |dz(s = 0)|, in radians where the system has angles, elsewhere in the units of the coordinate with the largest
  /// scale; none = adaptive
  std::optional<double> fixed_step;
  /// |dz(s = 0)| of the first orbit, in the same units; the default is the paper's half degree, as a number, in the
  /// survey's scales
  double start_amplitude = 0.5 / 180.0 * std::numbers::pi;
  bool start_is_given = false;
  double tolerance = 1e-10;
  int cutoff_from = 8;
  int cutoff_to = 4096;
  std::string corrector =
      "automatic";  ///< automatic | newton-krylov | brgn | nls | ntr | lmvm | rprop | rprop-extrapolated
};

enum class Spectrum { all, events };

/// How much is asked of the certificate of each orbit (docs/mathematics.md, "Certificates").
enum class Certificate {
  automatic,  ///< `closure`, within the branch that finds the orbit
  none,
  closure,  ///< as the last one, by tasks of the queue when all branches have ended
  full,
};

/// What is computed of each orbit; what is off costs nothing, and has NaN in the archive.
struct Compute {
  bool stability = true;  ///< multipliers, and with them every crossing but folds; branches need it
  Certificate certificate = Certificate::automatic;
};

struct Survey {
  int depth = 0;         ///< generations of branches below the base families
  int subharmonics = 4;  ///< branches that close after up to this many periods
  Spectrum spectrum = Spectrum::events;
  int team_size = 1;
};

struct Limits {
  double period = 30.0;
  double energy_from = -std::numeric_limits<double>::infinity();
  double energy_to = std::numeric_limits<double>::infinity();
  double parameter_from = -std::numeric_limits<double>::infinity();  ///< of the parameter that moves
  double parameter_to = std::numeric_limits<double>::infinity();
  std::map<std::string, double> guards;  ///< least values of the system's guards, by name; one left out has no limit
  int families = 1000;
  int steps = 5000;
  double time = std::numeric_limits<double>::infinity();       ///< of the whole survey, seconds of wall clock
  double task_time = std::numeric_limits<double>::infinity();  ///< of one task; longer ones are put aside
};

struct Events {
  std::vector<double> periods;
  std::vector<double> energies;
};

struct Section {
  std::string coordinate;  ///< empty: no section
  double value = 0.0;      ///< radians where the coordinate is an angle (degrees in the YAML)
};

/// Curves in two parameters of what is located along families (docs/mathematics.md, "Loci"); T or the energy is the
/// first where no parameter moves.
struct Loci {
  enum class Of { fold_period, fold_energy, fold_parameter, period_doubling, branch_point, torus };
  std::vector<Of> of;
  std::string free;                                        ///< the second parameter
  double from = -std::numeric_limits<double>::infinity();  ///< of the second parameter, in its unit
  double to = std::numeric_limits<double>::infinity();
};
[[nodiscard]] constexpr Loci::Of last_of(Loci::Of) { return Loci::Of::torus; }
/// "fold-period", ...: as in a scene and in the archive.
[[nodiscard]] std::string name_of(Loci::Of of);

struct Output {
  double flush_seconds = 5.0;
  int flush_orbits = 5000;
};

/// A checked scene: what to simulate and how far. Every value is in range and every name is known.
struct Scene {
  std::string name;
  SystemChoice system;
  FixedPoints fixed_points;
  Sweep sweep;
  std::vector<StateStart> states;
  std::vector<OrbitStart> orbits;
  std::vector<LoopStart> loops;
  std::optional<Recurrences> recurrences;
  Continuation continuation;
  Survey survey;
  Compute compute;
  Limits limits;
  Events events;
  Section section;
  std::vector<Loci> loci;
  Output output;
  std::string text;   ///< the YAML with overrides applied, as the archive stores it
  std::string model;  ///< the text of its model (docs/models.md), as well; empty for one that a program has recorded
};

/// Reads, overrides and checks a scene. `overrides`: "limits.period=30", applied in order before the check.
/// Throws core::InputError on the first thing wrong: file:line, key, what was expected, what came, what to do.
[[nodiscard]] Scene load(const std::filesystem::path& file, const std::vector<std::string>& overrides = {});

/// The same for a text; `origin` stands in messages where a file name would. `model`: the text of its model where that
/// is stored beside it (Scene::model).
[[nodiscard]] Scene parse(const std::string& text, const std::string& origin,
                          const std::vector<std::string>& overrides = {}, const std::string& model = "");

/// What the text of a scene says of a key that holds a value ("section.coordinate"), as it is written; "" where it does
/// not. Nothing else of it is read or checked.
[[nodiscard]] std::string written_value(const std::string& text, const std::string& key);

}  // namespace orbweaver::scene
