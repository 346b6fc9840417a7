#include "locate_task.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "arrival.hpp"
#include "birth_itself.hpp"
#include "crossing_outcome.hpp"
#include "executor.hpp"
#include "hidden_event.hpp"
#include "interrupted.hpp"
#include "orbweaver/archive/schema/records.hpp"
#include "orbweaver/bifurcation/crossing.hpp"
#include "orbweaver/bifurcation/directions.hpp"
#include "orbweaver/bifurcation/family_jump.hpp"
#include "orbweaver/bifurcation/kernel.hpp"
#include "orbweaver/bifurcation/parted_crossings.hpp"
#include "orbweaver/bifurcation/slopes.hpp"
#include "orbweaver/continuation/orbit.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/loop/symmetry/subspace.hpp"
#include "orbweaver/loss/unknowns.hpp"
#include "stability_columns.hpp"
#include "tasks/branch/followed_branch.hpp"
#include "units.hpp"

namespace orbweaver::survey {

namespace {

using archive::CrossingKind;
using bifurcation::Event;

/// Pairs of multipliers count as in the sector within this or the margin of their error bounds. A location leaves 1e-9
/// (docs/mathematics.md, "Location"); one pair is counted in any case, so this matters to multiple crossings only.
constexpr double in_sector = 1e-6;
/// Rounding of a period at the limit, relative to it: such a family still begins on the limit.
constexpr double at_limit = 1e-9;
/// The slope of the energy at a fold that is located as a zero of the index, in parts of the slopes beside it: two
/// locations to 1e-10 on a stretch of 1e-6 or more.
constexpr double turning_slope = 1e-3;

/// Of a kernel vector that the family's symmetries leave as it is, they keep all but what it is wrong by, 1e-6.
constexpr double in_symmetric_space = 0.99;

class Location {
 public:
  Location(const scene::Scene& scene, const std::shared_ptr<const systems::System>& system, const LocateWork& work,
           queue::TaskContext& context, core::Team* team)
      : _scene(scene), _system(system), _work(work), _context(context), _team(team), _event(work.event) {
    _outcome.key = work.key;
    _outcome.lineage = work.lineage;
  }

  queue::TaskOutcome run() {
    bifurcation::NotLocated why;
    continuation::Options options = branch_options(_scene, _team);
    const loop::Isotropy isotropy = loop::with_declared_matrices(_work.isotropy, _system->structure());
    continuation::FamilyCurve fast(_system, isotropy, options);
    add_known(fast);
    auto crossing = bifurcation::locate(*_system, fast, _event, _work.from, _work.to, why);
    // A zero that was found and is no event is none another way either.
    const bool is_settled = _event.tangency || is_zero(why);
    if (crossing) return located(*crossing, fast);
    if (why.reason == bifurcation::NotLocated::Reason::unclear_fold && is_birth_itself(_work, fast, why.position))
      return at_birth(why.position, fast);
    if (is_settled) return without_crossing(why, fast);
    // Newton's method on whole loops is slower, and finds orbits that the fast way misses. Its positions between known
    // orbits are a little different ones.
    options.corrector.method = corrector::Method::newton_krylov;
    continuation::FamilyCurve any(_system, isotropy, options);
    add_known(any);
    const auto [from, to] = between_known(_work, any);
    const bifurcation::NotLocated at_first = why;
    bifurcation::Event event = _event;
    // The first orbit of a family that is born is at 0.
    event.from_birth = event.from_birth || (from < 0.0 && !_work.lineage.crossing.empty());
    try {
      crossing = bifurcation::locate(*_system, any, event, from, to, why);
    } catch (const core::InputError&) {  // it does not apply, as to driven orbits that a reversor fixes
      return without_crossing(at_first, fast);
    }
    if (crossing) return located(*crossing, any);
    // Where a family turns sharply its index passes 2, and no orbit converges beside its chord: the turn tells where.
    if (is_in_sector(_event) && _event.function.sector.q == 1 && can_fold()) {
      bifurcation::NotLocated no_turn;
      const Event fold{fold_event(fold_kind()), {}, false};
      const auto [before, behind] = between_known(_work, fast);
      crossing = bifurcation::locate(*_system, fast, fold, before, behind, no_turn);
      if (crossing && crossing->point.position >= _work.from && crossing->point.position <= _work.to) {
        _event = fold;
        return located(*crossing, fast);
      }
    }
    return without_crossing(why, any);
  }

 private:
  /// So that flushes need not wait for the end; a location that is stopped begins again.
  void report() const {
    if (!_context.report({})) throw Interrupted();
  }

  void add_known(continuation::FamilyCurve& family) const {
    family.before_each([this] { report(); });
    for (const continuation::FamilyCurve::Known& known : _work.known) family.add(known, _work.known.size());
  }

  queue::TaskOutcome located(const bifurcation::Crossing& crossing, continuation::FamilyCurve& family) {
    if (is_birth_itself(_work, family, crossing.point.position)) return at_birth(crossing.point.position, family);
    describe(crossing, family);
    if (is_in_sector(_event)) try {
        leave(crossing, family);
      } catch (const bifurcation::UndecidedError& error) {
        _outcome.undecided = true;
        _outcome.remark = error.what();
      } catch (const core::NumericalError& error) {  // the crossing itself is located, and stays
        fail(crossing, error.what());
      }
    if (_event.tangency && _outcome.kernel_dimension < 0 && !_failure) untold(crossing);
    if (!_failure) add_loci(crossing);
    queue::TaskOutcome done;
    done.failed = _failure.has_value();
    done.reason = _failure.value_or("");
    done.children = std::move(_starts);
    done.payload = pack(_outcome);
    return done;
  }

  /// The loci that the scene asks for.
  void add_loci(const bifurcation::Crossing& crossing) {
    if (!_outcome.kind) return;
    for (std::size_t n = 0; n < _scene.loci.size(); ++n) {
      const std::vector<scene::Loci::Of>& of = _scene.loci[n].of;
      const std::string_view kind = archive::name_of(*_outcome.kind);
      if (std::none_of(of.begin(), of.end(), [&](scene::Loci::Of o) { return scene::name_of(o) == kind; })) continue;
      if (*_outcome.kind == CrossingKind::branch_point && !_breaks_symmetry) {
        _outcome.remark += fmt::format("{}no symmetry enforces the branch point: its locus has codimension two",
                                       _outcome.remark.empty() ? "" : "; ");
        continue;
      }
      LocusWork locus;
      locus.crossing = _work.key;
      locus.depth = _work.lineage.depth;
      locus.entry = static_cast<int>(n);
      locus.kind = *_outcome.kind;
      locus.event = _event;
      if (archive::is_fold(*_outcome.kind)) locus.event = {fold_event(*_outcome.kind), {}, false};
      locus.fundamental_order = _outcome.fundamental_order;
      locus.isotropy = _work.isotropy;
      locus.orbit = crossing.point.loop;
      locus.tangent = crossing.point.tangent;
      _starts.push_back(task_of(locus));
    }
  }

  [[nodiscard]] static Event::Kind fold_event(CrossingKind kind) {
    if (kind == CrossingKind::fold_period) return Event::Kind::fold_period;
    return kind == CrossingKind::fold_energy ? Event::Kind::fold_energy : Event::Kind::fold_parameter;
  }

  /// Whether a zero or a turn was found, which is no event or may be none.
  [[nodiscard]] static bool is_zero(const bifurcation::NotLocated& why) {
    return why.reason == bifurcation::NotLocated::Reason::no_event ||
           why.reason == bifurcation::NotLocated::Reason::unclear_event ||
           why.reason == bifurcation::NotLocated::Reason::unclear_fold;
  }

  queue::TaskOutcome at_birth(double position, const continuation::FamilyCurve& family) {
    return without_crossing({.reason = bifurcation::NotLocated::Reason::no_event, .position = position}, family);
  }

  queue::TaskOutcome without_crossing(bifurcation::NotLocated why, const continuation::FamilyCurve& family) {
    queue::TaskOutcome done;
    why.period *= Units(*_system).time;
    // Where no sign changes, and where functions vanish for other reasons, there may be nothing.
    const bool is_shown = !_event.tangency && !_event.is_double;
    done.failed = is_shown && !is_zero(why);
    _outcome.remark = to_text(why);
    const bool is_told = why.reason == bifurcation::NotLocated::Reason::no_event;
    _outcome.undecided = _event.passed || (!is_told && (!is_shown || is_zero(why)));
    if (done.failed)
      if (const std::string hidden = hidden_by_rounding(*_system, _work, family, why.reason, _team); !hidden.empty()) {
        done.failed = false;
        _outcome.undecided = true;
        _outcome.remark += "; " + hidden;
      }
    if (done.failed)
      done.reason = fmt::format("the event between arclength {:.6g} and {:.6g} was not located: {}",
                                family.arclength_at(_work.from), family.arclength_at(_work.to), _outcome.remark);
    done.payload = pack(_outcome);
    return done;
  }

  void describe(const bifurcation::Crossing& crossing, const continuation::FamilyCurve& family) {
    survey::describe(*_system, _event, crossing, family.isotropy(), _outcome);
    const double position = crossing.point.position;
    _outcome.arclength = signed_arclength(_work.lineage, _work.before_first, family.arclength_at(position));
    _outcome.within = (_work.to - _work.from) * family.arclength_unit_at(position);
  }

  void leave(const bifurcation::Crossing& crossing, continuation::FamilyCurve& family) {
    const loop::Isotropy& isotropy = family.isotropy();
    const bifurcation::Sector& sector = _event.function.sector;
    if (_event.tangency && sector.q <= 2 && part(crossing, family)) return;
    if (_outcome.multiplicity * _outcome.period > _scene.limits.period * (1.0 + at_limit)) {
      _outcome.remark = "orbits born here lie beyond the period limit";
      _outcome.limited_by = period_limited;
      return;
    }
    const bool starts = _work.lineage.depth < _scene.survey.depth;
    if (!starts) _outcome.limited_by = depth_limited;
    report();
    bifurcation::KernelOptions settings;
    settings.even_in_time = starts;
    settings.most_harmonics = _scene.continuation.cutoff_to;
    settings.team = _team;
    const int expected = expected_dimension(_system->structure(), crossing.stability, sector, _event.tangency);
    bifurcation::Kernel kernel;
    try {
      kernel = bifurcation::kernel_of(*_system, crossing.point, isotropy, sector, expected, settings);
    } catch (const bifurcation::UndecidedError&) {
      throw;
    } catch (const core::NumericalError&) {  // at a fold nothing but the family itself is flat
      if (sector.q != 1 || !turns_at(crossing, family)) throw;
      return as_fold(kernel);
    }
    _outcome.kernel_dimension = kernel.dimension();
    _outcome.kernel_singular_value = kernel.largest();
    _outcome.next_singular_value = kernel.next();
    if (kernel.dimension() == 0 && !_event.tangency) return without_kernel(crossing, kernel, family);
    // A fold alone passes 2: where the index touches it there, a family of more symmetry crosses.
    if (sector.q == 1 && !_event.tangency && kernel.dimension() == 1 && turns_at(crossing, family))
      return as_fold(kernel);
    if ((_event.tangency || _event.is_double) && kernel.dimension() < expected)
      return touching(crossing, kernel, expected);
    _breaks_symmetry = sector.q > 1 || breaks_symmetry(kernel, isotropy);
    if (!starts) return;
    if (moves() && !_system->structure().symplectic && kernel.dimension() > 1) {
      _outcome.undecided = true;
      _outcome.remark = fmt::format(
          "{} directions are flat: along which of their combinations families leave is looked "
          "for in Hamiltonian systems only",
          kernel.dimension());
      return;
    }
    report();
    int number = 0;
    bifurcation::DirectionOptions options;
    options.family = kernel.family;
    const bifurcation::Directions directions =
        bifurcation::directions(*_system, kernel.base, isotropy, kernel.vectors, options);
    if (!directions.doubt.empty()) {
      _outcome.undecided = true;
      _outcome.remark = directions.doubt;
    }
    for (const bifurcation::Direction& direction : directions.found) {
      LeavingRecord leaving;
      leaving.key = fmt::format("{}/{}", _work.key, number++);
      leaving.isotropy = direction.isotropy;
      leaving.both_sides = direction.both_sides;
      leaving.base = sketch_of(direction.base);
      leaving.direction = loop::with_cutoff(direction.tangent, leaving.base.cutoff, leaving.base.dimension);
      if (!direction.opposite.empty())
        leaving.opposite = loop::with_cutoff(direction.opposite, leaving.base.cutoff, leaving.base.dimension);
      leaving.hidden = direction.is_hidden;
      if (direction.is_hidden)
        _outcome.remark = "families leave so nearly in all directions that rounding hides them close by";
      else
        add_starts(direction, leaving);
      _outcome.leaving.push_back(std::move(leaving));
    }
  }

  /// Where what passes for a touching zero is two crossings side by side, each is located by a task of its own.
  [[nodiscard]] bool part(const bifurcation::Crossing& crossing, continuation::FamilyCurve& family) {
    const auto two = bifurcation::parted_crossings(*_system, family, _event.function.sector, crossing.point.position,
                                                   _work.from, _work.to);
    if (!two) return false;
    for (const bifurcation::Parted& one : *two) {
      LocateWork work = _work;
      work.key += &one == two->data() ? "a" : "b";
      work.event.tangency = work.event.passed = false;
      work.event.is_parted = true;
      work.from = one.from;
      work.to = one.to;
      _starts.push_back(task_of(work));
    }
    _outcome.kind.reset();
    _outcome.remark = "two crossings lie side by side there, each located by itself";
    return true;
  }

  /// Whether the kernel leaves the space of loops with the family's symmetries.
  [[nodiscard]] static bool breaks_symmetry(const bifurcation::Kernel& kernel, const loop::Isotropy& isotropy) {
    const loop::Subspace subspace(kernel.base.dimension, kernel.base.cutoff, isotropy);
    const loss::Unknowns unknowns{subspace, {}};
    return std::any_of(kernel.vectors.begin(), kernel.vectors.end(), [&](const loop::Tangent& v) {
      double square = 0.0;
      for (const double x : unknowns.coordinates_of({v.modes, {}})) square += x * x;
      return std::sqrt(square) < in_symmetric_space * v.norm();
    });
  }

  /// Where rounding does not tell the crossing from those of other sectors, its kernel may be any of theirs.
  void fail(const bifurcation::Crossing& crossing, const std::string& why) {
    const double off =
        std::abs(bifurcation::index_deviation(_system->structure(), crossing.stability, _event.function.sector).value);
    if (!(off > values_on_circle)) {
      _failure = why;
    } else {
      _outcome.undecided = true;
      _outcome.remark = fmt::format("between neighbouring positions the index changes by {:.2g}: {}", off, why);
    }
  }

  /// An index comes near its sector's value and turns back, and less is flat than where a pair of multipliers passes
  /// there and stays on the circle: rounding does not tell one crossing from two beside one another, or from none.
  void touching(const bifurcation::Crossing& crossing, const bifurcation::Kernel& kernel, int expected) {
    const bifurcation::Sector& sector = _event.function.sector;
    const double away = bifurcation::index_deviation(_system->structure(), crossing.stability, sector).value;
    const double error = stability_error(crossing.stability);
    const Units units(*_system);
    _outcome.kind.reset();
    _outcome.undecided = _event.passed || kernel.dimension() > 0 || std::abs(away) <= error;
    _outcome.remark = fmt::format(
        "at T = {:.9g}{} an index turns {:.2g} from {:.6g} (error bound {:.2g}), {} of {} directions being "
        "flat (smallest singular value {:.2g}): rounding hides whether families cross there",
        _outcome.period * units.time, units.level_text(_outcome.level() * units.level()), away,
        sector.value(_system->structure().symplectic), error, kernel.dimension(), expected,
        kernel.singular_values.empty() ? archive::not_computed : kernel.singular_values[0]);
  }

  /// An index comes near its sector's value and turns back, and whether anything is flat there is not known: without a
  /// kernel that is no crossing, unless the index is that value to rounding.
  void untold(const bifurcation::Crossing& crossing) {
    const bifurcation::Sector& sector = _event.function.sector;
    const double away = bifurcation::index_deviation(_system->structure(), crossing.stability, sector).value;
    const double error = stability_error(crossing.stability);
    if (!_outcome.undecided && !(std::abs(away) > bifurcation::error_margin * error)) return;
    const Units units(*_system);
    _outcome.kind.reset();
    _outcome.remark = fmt::format(
        "at T = {:.9g}{} an index turns {:.2g} from {:.6g} (error bound {:.2g}), and no kernel says whether "
        "families cross there: {}",
        _outcome.period * units.time, units.level_text(_outcome.level() * units.level()), away,
        sector.value(_system->structure().symplectic), error, _outcome.remark);
  }

  void without_kernel(const bifurcation::Crossing& crossing, const bifurcation::Kernel& kernel,
                      continuation::FamilyCurve& family) {
    _outcome.remark = fmt::format("no flat direction besides the family's own (smallest singular value {:.2g})",
                                  kernel.singular_values.empty() ? archive::not_computed : kernel.singular_values[0]);
    if (_event.function.sector.q == 1 && turns(family))
      _outcome.kind = fold_kind();
    else
      fail(crossing, _outcome.remark);
  }

  /// An index passes 2 where the energy turns, and nothing leaves: what is nearly flat is so for another reason, such
  /// as a small amplitude.
  void as_fold(const bifurcation::Kernel& kernel) {
    _outcome.kind = fold_kind();
    _outcome.kernel_dimension = 0;
    _outcome.kernel_singular_value = archive::not_computed;
    _outcome.next_singular_value = kernel.largest();
    _outcome.remark = fmt::format("the {} turns there", moves() ? "parameter" : "energy");
    if (!kernel.vectors.empty()) _outcome.remark += fmt::format(" (smallest singular value {:.2g})", kernel.largest());
  }

  [[nodiscard]] bool moves() const { return !_system->family_scalars().free.empty(); }

  [[nodiscard]] bool can_fold() const { return moves() || _system->structure().conservative(); }

  [[nodiscard]] CrossingKind fold_kind() const {
    return moves() ? CrossingKind::fold_parameter : CrossingKind::fold_energy;
  }

  /// Of the energy, or of the parameter that moves: where it turns an index of 2 is no birth.
  [[nodiscard]] double slope_at(const continuation::CurvePoint& point) const {
    return bifurcation::level_slope(*_system, point);
  }

  /// Slopes where the event was bracketed.
  [[nodiscard]] std::optional<std::pair<double, double>> slopes_beside(continuation::FamilyCurve& family) const {
    const auto before = family.at(_work.from, true);
    const auto after = family.at(_work.to, true);
    if (!before || !after) return std::nullopt;
    return std::pair{slope_at(*before), slope_at(*after)};
  }

  [[nodiscard]] bool turns(continuation::FamilyCurve& family) const {
    const auto slopes = slopes_beside(family);
    return slopes && slopes->first * slopes->second < 0.0;
  }

  /// At the crossing itself, not only between the orbits beside it; on families whose index passes 2 at folds alone
  /// one that lies between them is the crossing.
  [[nodiscard]] bool turns_at(const bifurcation::Crossing& crossing, continuation::FamilyCurve& family) const {
    const auto slopes = slopes_beside(family);
    if (!slopes || !(slopes->first * slopes->second < 0.0)) return false;
    return bifurcation::passes_two_only_at_folds(_system->structure(), family.isotropy()) ||
           std::abs(slope_at(crossing.point)) <
               turning_slope * std::min(std::abs(slopes->first), std::abs(slopes->second));
  }

  void add_starts(const bifurcation::Direction& direction, const LeavingRecord& leaving) {
    for (const int side : {1, -1}) {
      if (side < 0 && !leaving.both_sides) continue;
      StartWork start;
      BranchWork& branch = start.branch;
      branch.key = branch_key(leaving, side);
      branch.name = fmt::format("{}>{}@{:.4g}{}", _work.name, _outcome.multiplicity,
                                _outcome.period * _system->scales().time, leaving.key.substr(_work.key.size()));
      branch.lineage = {leaving.key, _work.key, _work.lineage.depth + 1, _outcome.multiplicity, side};
      branch.base = direction.base;
      branch.direction = direction.way(side);
      branch.isotropy = leaving.isotropy;
      branch.amplitude = direction.amplitude > 0.0
                             ? direction.amplitude * loop::change_at_start(direction.base, branch.direction)
                             : 0.0;
      _starts.push_back(task_of(start));
    }
  }

  const scene::Scene& _scene;
  const std::shared_ptr<const systems::System>& _system;
  const LocateWork& _work;
  queue::TaskContext& _context;
  core::Team* _team;
  Event _event;
  LocateOutcome _outcome;
  std::vector<queue::Task> _starts;
  std::optional<std::string> _failure;
  bool _breaks_symmetry = false;  // what leaves
};

}  // namespace

int expected_dimension(const systems::Structure& system, const spectrum::Stability& stability,
                       const bifurcation::Sector& sector, bool touches) {
  int pairs = 0;
  const std::size_t count = stability.fundamental.size() - (system.conservative() && !system.symplectic ? 1 : 0);
  for (std::size_t n = 0; n < count; ++n) {
    const double away = std::abs(stability.fundamental[n] - sector.value(system.symplectic));
    // Where a parameter folds the bounds of all multipliers grow: orbits of its value are not isolated there.
    const double bound = system.symplectic ? bifurcation::error_margin * stability.fundamental_error[n] : 0.0;
    if (away < std::max(in_sector, bound)) ++pairs;
  }
  // A pair that touches 1 or -1 has both of its multipliers there; without pairs each is one direction.
  return std::max(1, pairs) * (sector.q <= 2 && !(touches && system.symplectic) ? 1 : 2);
}

queue::TaskOutcome locate(const scene::Scene& scene, const std::shared_ptr<const systems::System>& system,
                          const LocateWork& work, queue::TaskContext& context, core::Team* team) {
  try {
    return Location(scene, system, work, context, team).run();
  } catch (const Interrupted&) {
    return {};
  }
}

}  // namespace orbweaver::survey
